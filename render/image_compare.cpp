#include "render/image_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {

namespace {

using Plane = std::vector<double>;  ///< one number per pixel, row by row

void requireSameSize(const Image& a, const Image& b)
{
    const auto size = [](const Image& i) { return std::to_string(i.width) + " x " + std::to_string(i.height); };
    if (a.width != b.width || a.height != b.height) throw std::invalid_argument("pictures differ in size: " + size(a) + " and " + size(b));
}

double luminance(const std::uint8_t* pixel) { return 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2]; }

/// Difference of two pixels in the channel where it is largest, in steps of 255.
int largestStep(const std::uint8_t* a, const std::uint8_t* b)
{
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

Plane luminancePlane(const Image& image)
{
    Plane plane(image.pixels.size() / 3);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = luminance(&image.pixels[3 * i]);
    return plane;
}

constexpr int kReach = 5;  ///< reach of the window to either side [pixels]
using Window = std::array<double, 2 * kReach + 1>;

Window gaussian()
{
    constexpr double kSigma = 1.5;
    Window weights{};
    for (int k = -kReach; k <= kReach; ++k) weights[k + kReach] = std::exp(-0.5 * k * k / (kSigma * kSigma));
    return weights;
}

/// One over the weight of the window's part that lies on a line of pixels, for every place of the line.
std::vector<double> windowScales(const Window& weights, int length)
{
    std::vector<double> scales(static_cast<std::size_t>(length));
    for (int i = 0; i < length; ++i) {
        double total = 0.0;
        for (int k = std::max(-kReach, -i); k <= std::min(kReach, length - 1 - i); ++k) total += weights[k + kReach];
        scales[i] = 1.0 / total;
    }
    return scales;
}

/// Weighted mean of every window, first along rows, then along columns; all inner loops run along rows.
Plane windowMean(const Plane& plane, int width, int height)
{
    const Window weights = gaussian();
    const std::vector<double> scaleX = windowScales(weights, width), scaleY = windowScales(weights, height);
    const std::size_t row = static_cast<std::size_t>(width);
    Plane across(plane.size(), 0.0), mean(plane.size(), 0.0);
    for (int y = 0; y < height; ++y) {
        const double* from = &plane[y * row];
        double* to = &across[y * row];
        for (int k = -kReach; k <= kReach; ++k)
            for (int x = std::max(0, -k); x < std::min(width, width - k); ++x) to[x] += weights[k + kReach] * from[x + k];
        for (int x = 0; x < width; ++x) to[x] *= scaleX[x];
    }
    for (int y = 0; y < height; ++y) {
        double* to = &mean[y * row];
        for (int k = std::max(-kReach, -y); k <= std::min(kReach, height - 1 - y); ++k) {
            const double* from = &across[(y + k) * row];
            for (int x = 0; x < width; ++x) to[x] += weights[k + kReach] * from[x];
        }
        for (int x = 0; x < width; ++x) to[x] *= scaleY[y];
    }
    return mean;
}

Plane product(const Plane& a, const Plane& b)
{
    Plane result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
    return result;
}

}  // namespace

Similarity structuralSimilarity(const Image& imageA, const Image& imageB)
{
    requireSameSize(imageA, imageB);
    if (imageA == imageB) return {1.0, 1.0, 0, 0};
    constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    const int width = imageA.width, height = imageA.height;
    const Plane a = luminancePlane(imageA), b = luminancePlane(imageB);
    const Plane meanA = windowMean(a, width, height), meanB = windowMean(b, width, height);
    const Plane meanAA = windowMean(product(a, a), width, height);
    const Plane meanBB = windowMean(product(b, b), width, height);
    const Plane meanAB = windowMean(product(a, b), width, height);

    Similarity result{0.0, 1.0, 0, 0};
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double varianceA = meanAA[i] - meanA[i] * meanA[i], varianceB = meanBB[i] - meanB[i] * meanB[i];
        const double covariance = meanAB[i] - meanA[i] * meanB[i];
        const double ssim = (2.0 * meanA[i] * meanB[i] + c1) * (2.0 * covariance + c2) /
                            ((meanA[i] * meanA[i] + meanB[i] * meanB[i] + c1) * (varianceA + varianceB + c2));
        result.mean += ssim / static_cast<double>(a.size());
        if (ssim >= result.lowest) continue;
        result.lowest = ssim;
        result.x = static_cast<int>(i) % width;
        result.y = static_cast<int>(i) / width;
    }
    return result;
}

ColorDifference colorDifference(const Image& a, const Image& b)
{
    requireSameSize(a, b);
    ColorDifference result;
    std::size_t visible = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const int step = largestStep(a.at(x, y), b.at(x, y));
            if (step > kVisibleStep) ++visible;
            if (step > result.largest) result = {0.0, step, x, y};
        }
    result.share = static_cast<double>(visible) / std::max(1.0, static_cast<double>(a.width) * a.height);
    return result;
}

ImageDifference compareImages(const Image& a, const Image& b) { return {structuralSimilarity(a, b), colorDifference(a, b)}; }

bool isWithin(const ImageDifference& difference, const ImageTolerance& tolerance)
{
    return difference.similarity.mean >= tolerance.meanSsim && difference.similarity.lowest >= tolerance.lowestSsim &&
           difference.color.share <= tolerance.pixels && difference.color.largest <= tolerance.largest;
}

Image differenceImage(const Image& actual, const Image& expected)
{
    requireSameSize(actual, expected);
    Image result(expected.width, expected.height);
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x) {
            const std::uint8_t *a = actual.at(x, y), *b = expected.at(x, y);
            const int largest = largestStep(a, b);
            const auto grey = static_cast<std::uint8_t>(200.0 + 55.0 * luminance(b) / 255.0);
            fill(result, {x, y, 1, 1}, {grey, grey, grey});
            constexpr float kFaintest = 0.25f;  // so that a difference of one step is still seen
            if (largest > 0) blend(result, x, y, {200, 0, 0}, kFaintest + (1.0f - kFaintest) * std::min(1.0f, static_cast<float>(largest) / 64.0f));
        }
    return result;
}

}  // namespace render

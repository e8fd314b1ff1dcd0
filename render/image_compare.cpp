#include "render/image_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {

namespace {

using Plane = std::vector<double>;                 ///< one number per pixel, row by row

void requireSameSize(const Image& a, const Image& b)
{
    const auto size = [](const Image& i) { return std::to_string(i.width) + " x " + std::to_string(i.height); };
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("pictures differ in size: " + size(a) + " and " + size(b));
}

double luminance(const std::uint8_t* pixel)
{
    return 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
}

Plane luminancePlane(const Image& image)
{
    Plane plane(image.pixels.size() / 3);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = luminance(&image.pixels[3 * i]);
    return plane;
}

constexpr int kReach = 5;

std::array<double, 2 * kReach + 1> gaussian()
{
    constexpr double kSigma = 1.5;
    std::array<double, 2 * kReach + 1> weights{};
    for (int k = -kReach; k <= kReach; ++k) weights[k + kReach] = std::exp(-0.5 * k * k / (kSigma * kSigma));
    return weights;
}

/// Weighted mean along one axis: `count` lines of `length` numbers, `step` apart, starting `lineStep` apart.
Plane meanAlong(const Plane& plane, int count, int length, std::size_t lineStep, std::size_t step)
{
    const auto weights = gaussian();
    Plane mean(plane.size());
    for (int line = 0; line < count; ++line)
        for (int i = 0; i < length; ++i) {
            double sum = 0.0, total = 0.0;
            for (int k = std::max(-kReach, -i); k <= std::min(kReach, length - 1 - i); ++k) {
                sum += weights[k + kReach] * plane[line * lineStep + (i + k) * step];
                total += weights[k + kReach];
            }
            mean[line * lineStep + i * step] = sum / total;
        }
    return mean;
}

Plane windowMean(const Plane& plane, int width, int height)
{
    const std::size_t row = static_cast<std::size_t>(width);
    return meanAlong(meanAlong(plane, height, width, row, 1), width, height, 1, row);
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
    constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    const int width = imageA.width, height = imageA.height;
    const Plane a = luminancePlane(imageA), b = luminancePlane(imageB);
    const Plane meanA = windowMean(a, width, height), meanB = windowMean(b, width, height);
    const Plane meanAA = windowMean(product(a, a), width, height);
    const Plane meanBB = windowMean(product(b, b), width, height);
    const Plane meanAB = windowMean(product(a, b), width, height);

    Similarity result{0.0, 1.0};
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double varianceA = meanAA[i] - meanA[i] * meanA[i], varianceB = meanBB[i] - meanB[i] * meanB[i];
        const double covariance = meanAB[i] - meanA[i] * meanB[i];
        const double ssim = (2.0 * meanA[i] * meanB[i] + c1) * (2.0 * covariance + c2) /
                            ((meanA[i] * meanA[i] + meanB[i] * meanB[i] + c1) * (varianceA + varianceB + c2));
        result.mean += ssim / static_cast<double>(a.size());
        result.lowest = std::min(result.lowest, ssim);
    }
    return result;
}

double meanColorDifference(const Image& a, const Image& b)
{
    requireSameSize(a, b);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
    return sum / static_cast<double>(std::max<std::size_t>(1, a.pixels.size()));
}

Image differenceImage(const Image& actual, const Image& expected)
{
    requireSameSize(actual, expected);
    Image result(expected.width, expected.height);
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x) {
            const std::uint8_t *a = actual.at(x, y), *b = expected.at(x, y);
            const int largest = std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
            const auto grey = static_cast<std::uint8_t>(200.0 + 55.0 * luminance(b) / 255.0);
            fill(result, {x, y, 1, 1}, {grey, grey, grey});
            constexpr float kFaintest = 0.25f;     // so that a difference of one step is still seen
            if (largest > 0)
                blend(result, x, y, {200, 0, 0}, kFaintest + (1.0f - kFaintest) * std::min(1.0f, static_cast<float>(largest) / 64.0f));
        }
    return result;
}

}  // namespace render

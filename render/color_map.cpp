#include "render/color_map.h"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

using Eigen::Vector3f;

Vector3f clampToUnit(const Vector3f& color)
{
    return color.cwiseMax(0.0f).cwiseMin(1.0f);
}

Vector3f jet(int i)
{
    const float u = static_cast<float>(i + 1) / 64.0f;
    return {std::min(u - 1.5f, 4.5f - u), std::min(u - 0.5f, 3.5f - u), std::min(u + 0.5f, 2.5f - u)};
}

/// Horner in t; coefficients from the constant up.
template <std::size_t n>
Vector3f polynomial(const std::array<Vector3f, n>& coefficients, float t)
{
    Vector3f sum = Vector3f::Zero();
    for (std::size_t k = n; k-- > 0;) sum = sum * t + coefficients[k];
    return sum;
}

/// A. Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization", Google AI Blog 2019.
Vector3f turbo(float t)
{
    static const std::array<Vector3f, 6> kTurbo = {{{0.13572138f, 0.09140261f, 0.10667330f},
                                                    {4.61539260f, 2.19418839f, 12.64194608f},
                                                    {-42.66032258f, 4.84296658f, -60.58204836f},
                                                    {132.13108234f, -14.18503333f, 110.36276771f},
                                                    {-152.94239396f, 4.27729857f, -89.90310912f},
                                                    {59.28637943f, 2.82956604f, 27.34824973f}}};
    return polynomial(kTurbo, t);
}

/// M. Zucker, polynomial fits to matplotlib colour maps, 2019 (public domain).
Vector3f viridis(float t)
{
    static const std::array<Vector3f, 7> kViridis = {{{0.27772733f, 0.00540734f, 0.33409981f},
                                                      {0.10509304f, 1.40461353f, 1.38459016f},
                                                      {-0.33086183f, 0.21484756f, 0.09509516f},
                                                      {-4.63423050f, -5.79910097f, -19.33244096f},
                                                      {6.22826994f, 14.17993337f, 56.69055260f},
                                                      {4.77638500f, -13.74514538f, -65.35303263f},
                                                      {-5.43545586f, 4.64585261f, 26.31243525f}}};
    return polynomial(kViridis, t);
}

}  // namespace

ColorTable colorTable(ColorMap map)
{
    ColorTable table;
    for (int i = 0; i < kColorMapSize; ++i) {
        const float t = static_cast<float>(i) / (kColorMapSize - 1);
        table[i] = clampToUnit(map == ColorMap::Jet ? jet(i) : map == ColorMap::Turbo ? turbo(t) : viridis(t));
    }
    return table;
}

Vector3f colorAt(const ColorTable& table, float t)
{
    const float x = std::clamp(t, 0.0f, 1.0f) * (kColorMapSize - 1);
    const int i = std::min(static_cast<int>(x), kColorMapSize - 2);
    const float fraction = x - static_cast<float>(i);
    return (1.0f - fraction) * table[i] + fraction * table[i + 1];
}

Rgb toRgb(const Vector3f& color)
{
    const auto byte = [](float c) { return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(c, 0.0f, 1.0f))); };
    return {byte(color.x()), byte(color.y()), byte(color.z())};
}

}  // namespace render

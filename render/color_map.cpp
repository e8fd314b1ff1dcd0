#include "render/color_map.h"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

using Eigen::Vector3f;

Vector3f clampToUnit(const Vector3f& color) { return color.cwiseMax(0.0f).cwiseMin(1.0f); }

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

/// Catmull-Rom cubics through equally spaced keys, t in 0 … 1 from the first to the last.
template <std::size_t n>
Vector3f throughKeys(const std::array<Vector3f, n>& keys, float t)
{
    const float x = t * (n - 1);
    const int i = std::min(static_cast<int>(x), static_cast<int>(n) - 2), last = static_cast<int>(n) - 1;
    const float u = x - static_cast<float>(i);
    const Vector3f &a = keys[i], &b = keys[i + 1];
    const Vector3f before = i > 0 ? keys[i - 1] : Vector3f(2.0f * a - b);
    const Vector3f after = i + 2 <= last ? keys[i + 2] : Vector3f(2.0f * b - a);
    const Vector3f slopeA = 0.5f * (b - before), slopeB = 0.5f * (after - a);
    return a + u * (slopeA + u * (3.0f * (b - a) - 2.0f * slopeA - slopeB + u * (slopeA + slopeB - 2.0f * (b - a))));
}

/// Every 15th colour of the published map: A. Mikhailov, "Turbo, An Improved Rainbow Colormap for Visualization",
/// Google AI Blog 2019. The cubics meet the others to 0.01.
Vector3f turbo(float t)
{
    static const std::array<Vector3f, 18> kTurbo = {{{0.18995f, 0.07176f, 0.23217f},
                                                     {0.24830f, 0.24143f, 0.61286f},
                                                     {0.27509f, 0.40072f, 0.86692f},
                                                     {0.26878f, 0.54995f, 0.99303f},
                                                     {0.18625f, 0.69775f, 0.95498f},
                                                     {0.10026f, 0.82955f, 0.81389f},
                                                     {0.13526f, 0.92197f, 0.66556f},
                                                     {0.32006f, 0.97974f, 0.47654f},
                                                     {0.54658f, 0.99907f, 0.29581f},
                                                     {0.71577f, 0.96875f, 0.20815f},
                                                     {0.85868f, 0.88655f, 0.21230f},
                                                     {0.96049f, 0.77181f, 0.22811f},
                                                     {0.99654f, 0.63193f, 0.18738f},
                                                     {0.97545f, 0.45740f, 0.11305f},
                                                     {0.91024f, 0.29599f, 0.04814f},
                                                     {0.80799f, 0.17753f, 0.01660f},
                                                     {0.66449f, 0.08436f, 0.00424f},
                                                     {0.47960f, 0.01583f, 0.01055f}}};
    return throughKeys(kTurbo, t);
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

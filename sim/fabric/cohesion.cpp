#include "sim/fabric/cohesion.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace sim {

double bridgeForce(const LiquidSettings& liquid, double fraction, double saturation)
{
    constexpr double kLargestAngle = 1.35;  // rad
    const double cosine = fraction * std::cos(liquid.contactAngle) + (1.0 - fraction) * (2.0 * saturation - 1.0);
    const double angle = std::clamp(std::acos(std::clamp(cosine, -1.0, 1.0)), 0.0, kLargestAngle);
    return saturation * liquid.surfaceTension * kPi * (kPi - 2.0 * angle) / std::cos(angle);
}

Cohesion::Cohesion(const Fabric& fabric, const LiquidSettings& liquid, const CohesionSettings& settings)
    : fabric_(fabric),
      liquid_(liquid),
      settings_(settings),
      capacity_(poreCapacity(fabric, liquid.density)),
      length_(fabric.vertexCount(), 0.0),
      isOnCloth_(fabric.vertexCount(), 0),
      perLength_(fabric.vertexCount(), 0.0)
{
    for (std::size_t e = 0; e < fabric.edges.size(); ++e)
        for (int v : fabric.edges.vertices[e]) length_[v] += 0.5 * fabric.edges.restLength[e];
    for (std::size_t f = 0; f < fabric.faces.size(); ++f) {
        const Vec3i& v = fabric.faces.vertices[f];
        const double area = 0.5 * (fabric.rest[v[1]] - fabric.rest[v[0]]).cross(fabric.rest[v[2]] - fabric.rest[v[0]]).norm();
        for (int corner : v) {
            length_[corner] += area / (3.0 * fabric.faces.thickness[f]);
            isOnCloth_[corner] = 1;
        }
    }
}

void Cohesion::setAbsorbed(std::span<const double> absorbed)
{
    parallelFor(absorbed.size(), 1024, [&](std::size_t v) {
        const double saturation = capacity_[v] > 0.0 ? std::clamp(absorbed[v] / capacity_[v], 0.0, 1.0) : 0.0;
        const double fraction = fabric_.materials[fabric_.vertexMaterial[v]].volumeFraction;
        perLength_[v] = saturation > 0.0 ? settings_.strength * bridgeForce(liquid_, fraction, saturation) : 0.0;
    });
    isWet_ = parallelMax(perLength_.size(), [&](std::size_t v) { return perLength_[v]; }) > 0.0;
}

double Cohesion::onFace(int vertex, const std::array<int, 3>& face, const std::array<double, 3>& shares) const
{
    double other = 0.0;
    if (!isOnCloth_[vertex])
        for (int c = 0; c < 3; ++c) other += shares[c] * perLength_[face[c]];
    return 0.5 * length_[vertex] * (perLength_[vertex] + other);
}

}  // namespace sim

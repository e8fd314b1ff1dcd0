#pragma once

#include "sim/fabric/fabric.h"
#include "sim/settings.h"

#include <span>
#include <vector>

namespace sim {

/// Length at which a liquid bridge breaks, beyond the distance at which the two begin to press on each other, in radii of the fabric [-].
inline constexpr double kBridgeLength = 0.25;

/// Force of a liquid bridge along a thread, per length [dyn/cm]: s γ π (π − 2ϑ) / cos ϑ with the contact angle of a porous surface
/// cos ϑ = φ cos ϑ0 + (1 − φ)(2 s − 1), from 0 to 1.35 rad.
/// Source: Fei et al. 2018, "A Multi-Scale Model for Simulating Liquid-Fabric Interactions", where it does not go by s, but is there where
/// what is between two elements is half full.
/// @param fraction    φ, of the fabric that fibres fill [-]
/// @param saturation  s, of its pores [0..1]
double bridgeForce(const LiquidSettings& liquid, double fraction, double saturation);

/// Liquid bridges that hold wet fabric on fabric and on solids: between two that are nearer than kBridgeLength, the same force whatever
/// their length, so that what parts them must pull with that force, and pays its product with the length. They come about between steps.
/// Cloth counts as threads side by side that are as wide as it is thick: finer meshes hold no more.
class Cohesion {
 public:
    Cohesion(const Fabric& fabric, const LiquidSettings& liquid, const CohesionSettings& settings);

    /// Sets the liquid that the fabric holds, on which the forces depend.
    /// @param absorbed  of each vertex [g]
    void setAbsorbed(std::span<const double> absorbed);
    bool isOnFabric() const { return settings_.fabric && isWet_; }
    bool isOnObstacles() const { return settings_.obstacle && isWet_; }

    /// What holds a vertex, with all that it stands for, on a solid [dyn].
    double onObstacle(int vertex) const { return length_[vertex] * perLength_[vertex]; }
    /// A vertex's part in what holds it on a face: the vertices of the face hold on to its cloth, too, but not to its yarns [dyn].
    /// @param shares  of the three corners in the nearest point of the face [-]
    double onFace(int vertex, const std::array<int, 3>& face, const std::array<double, 3>& shares) const;
    /// A yarn edge's part in what holds it on another [dyn].
    double onYarn(int edge) const
    {
        const Vec2i& v = fabric_.edges.vertices[edge];
        return 0.25 * fabric_.edges.restLength[edge] * (perLength_[v[0]] + perLength_[v[1]]);
    }

 private:
    const Fabric& fabric_;
    LiquidSettings liquid_;
    CohesionSettings settings_;
    std::vector<double> capacity_;   ///< mass that the pores of each vertex hold [g]
    std::vector<double> length_;     ///< length of threads that each vertex stands for [cm]
    std::vector<char> isOnCloth_;    ///< whether each vertex is on cloth
    std::vector<double> perLength_;  ///< force at each vertex [dyn/cm]
    bool isWet_ = false;
};

}  // namespace sim

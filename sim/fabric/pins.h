#pragma once

#include "sim/fabric/fabric.h"

#include <optional>
#include <span>
#include <vector>

namespace sim {

/// Where the pins' motions have each pinned vertex at time t [s], in the order of fabric.pins [cm].
std::vector<Vec3> pinTargets(const Fabric& fabric, double t);

/// The twist angle that a held edge has at time t, when its material frame follows the rotation of its pin; of the
/// angles that differ by full turns the one nearest to the present [rad].
/// @param restReference  first axes of the reference frames at rest, of each yarn edge
double heldAngle(const Fabric& fabric, std::span<const Vec3> restReference, double t, const FabricState& state, int edge);

/// By how much the pin of a held edge turns about it from t0 to t1 [rad], as the edge is in this state. The angle itself changes also as the edge
/// tilts, where the pin gives nothing.
double pinTurn(const Fabric& fabric, std::span<const Vec3> restReference, double t0, double t1, const FabricState& state, int edge);

/// Pinned vertex nearest to each vertex, by the number of edges between; −1 where no edges lead to one.
std::vector<int> nearestPins(const Fabric& fabric);

/// The pin that a held edge's frame follows, by its number among Fabric::Pins: that of the first of its vertices with one.
std::optional<std::size_t> pinOfEdge(const Fabric& fabric, int edge);

}  // namespace sim

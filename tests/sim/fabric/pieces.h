#pragma once

#include "sim/fabric/fabric.h"
#include "sim/fabric/pieces/generators.h"

#include <random>

namespace sim::testing {

/// Something like wool, in CGS; the packing factor is 0.16.
inline FabricMaterial wool()
{
    FabricMaterial m;
    m.young = 6.6e7;
    m.density = 1.32;
    m.volumeFraction = 0.4;
    return m;
}

inline FabricPiece pieceOf(const FabricGeometry& geometry, const FabricMaterial& material, std::array<double, 2> radius)
{
    FabricPiece piece;
    piece.name = "piece";
    piece.material = material;
    piece.radius = radius;
    piece.points = geometry.points;
    piece.strands = geometry.strands;
    piece.faces = geometry.faces;
    return piece;
}

inline Fabric fabricOf(const FabricPiece& piece) { return assembleFabric({&piece, 1}); }

/// A vector of numbers in [−1, 1].
class Noise {
 public:
    explicit Noise(unsigned seed) : generator_(seed) {}
    double operator()() { return uniform_(generator_); }
    Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }

 private:
    std::mt19937 generator_;
    std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

}  // namespace sim::testing

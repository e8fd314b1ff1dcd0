#include "sim/liquid/face_velocity.h"

#include "sim/core/parallel.h"
#include "sim/core/simd.h"

namespace sim {

void computeFaceVelocities(const BlockGrid& grid, const Vec3& gravity, double dt, bool keepsAdvected, LiquidGrid& liquid)
{
    parallelFor(grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            const double* mass = liquid.faces.sums.block(b, FaceFields::kMass + a);
            const double* momentum = liquid.faces.sums.block(b, FaceFields::kMomentum + a);
            double* velocity = liquid.faces.velocity.block(b, a);
            std::uint64_t* wet = liquid.wet.block(b, a);
            std::fill_n(wet, BlockBits<3>::kWords, 0);
            for (int row = 0; row < kBlockCells; row += kLanes) {
                const Pack m = loadPack(mass + row);
                const PackMask carries = m > 0.0;
                const Pack u = select(carries, loadPack(momentum + row) / m, broadcast(0.0));
                wet[row >> 6] |= static_cast<std::uint64_t>(maskBits(carries)) << (row & 63);
                if (keepsAdvected) std::memcpy(liquid.advected.block(b, a) + row, &u, sizeof u);
                const Pack moved = select(carries, u + dt * gravity[a], u);
                std::memcpy(velocity + row, &moved, sizeof moved);
            }
        }
    });
}

}  // namespace sim

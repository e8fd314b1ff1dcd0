#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/types.h"

#include <array>
#include <cstdint>

namespace sim {

/// Particles that carry momentum to the grid and back, liquid or vertices of fabric: one array per quantity, kept in the order of the last sort
/// (particle_order.h).
///
/// A particle's velocity is a polynomial around it, one per component (transfer/README.md, Modes): modes[axis][r] are its
/// monomial coefficients in the canonical order of velocity_modes.h, in units of the cell: lengths in dx, so that every mode is a velocity
/// [cm/s] whatever its degree. There is no other record of the velocity.
struct Particles {
    std::size_t count = 0;
    int modeCount = 1;  ///< modes stored per component: 1, 4, 8, 11 or 27 (storedModes in velocity_modes.h)

    std::array<AlignedArray<double>, kAxes> x;      ///< position [cm]
    AlignedArray<double> mass;                      ///< [g]
    AlignedArray<std::uint32_t> id;                 ///< number of each particle, which a sort does not change
    std::array<AlignedArray<double>, kAxes> modes;  ///< mode r of particle p at r * modeStride + p [cm/s]
    std::size_t modeStride = 0;

    const double* mode(int axis, int r) const { return modes[axis].data() + r * modeStride; }
    double* mode(int axis, int r) { return modes[axis].data() + r * modeStride; }
    Vec3 position(std::size_t p) const { return {x[0][p], x[1][p], x[2][p]}; }

    /// The particle's velocity: the weighted mean of its polynomial (transfer/README.md, Modes) [cm/s].
    Vec3 velocity(std::size_t p) const;

    /// Change the number of particles; the first min(count, n) keep everything. New ones have no mass and zero modes.
    void resize(std::size_t n);

    /// Store `n` modes per component, as storedModes names them. Every particle keeps its velocity; modes that were not stored are zero.
    void changeModes(int n);

    /// Make particle `to` what particle `from` is.
    void copy(std::size_t from, std::size_t to);

    /// Append one particle that moves rigidly with velocity v.
    void add(const Vec3& position, double particleMass, std::uint32_t particleId, const Vec3& v);
};

}  // namespace sim

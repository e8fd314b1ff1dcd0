#pragma once

namespace sim {

/// Energies of the fabric (fabric/README.md, Energy from nothing) [erg].
struct FabricEnergies {
    double kinetic = 0.0, potential = 0.0;
    double stretching = 0.0, bending = 0.0, twisting = 0.0;  ///< energies of yarns
    double membrane = 0.0, shellBending = 0.0;               ///< energies of cloth
    double contact = 0.0;                                    ///< FabricState::stored
    double elastic() const { return stretching + bending + twisting + membrane + shellBending; }
    double internal() const { return elastic() + contact; }
    double total() const { return kinetic + potential + internal(); }
};

}  // namespace sim

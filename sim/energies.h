#pragma once

#include "sim/fabric/fabric_energies.h"
#include "sim/liquid/energy.h"

namespace sim {

/// Energies of the liquid and the fabric [erg].
struct Energies : LiquidEnergies {
    FabricEnergies fabric;
    double total() const { return LiquidEnergies::total() + fabric.total(); }
};

}  // namespace sim

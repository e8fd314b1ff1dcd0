#pragma once

#include <array>
#include <string_view>

namespace sim {

/// Where energy goes in a step (sim/README.md, Energy): stages by the energy before and after them, forces by their work along the move that
/// was made. What they do not explain is the error of the solves.
enum class EnergyChange {
    Sources,         ///< liquid that was emitted, or left the domain, and the work of pressing it in
    Capture,         ///< velocities mix where fabric takes up liquid
    ToGrid,          ///< liquid from particles to faces
    Gravity,         ///< its work on the faces, and what the particles fell for it
    Viscosity,       ///< of the liquid, on the faces
    SurfaceTension,  ///< its work on the faces: the surface's energy is not in the sum
    Pressure,        ///< on both phases, and what the projection takes from liquid alone
    Strain,          ///< the strain correction, beyond what stretching has given for it (LiquidEnergies::strain)
    Suction,
    Drag,       ///< between liquid and fabric
    Implicit,   ///< backward Euler: ½ m Δv² of the fabric and of liquid under drag, and what elastic forces did beyond their energy
    Damping,    ///< of the fabric's material
    Contact,    ///< of fabric with itself, beyond the energy that it holds (FabricState::stored). Solver grid: with friction
    Friction,   ///< of fabric on fabric
    Obstacles,  ///< on fabric, with friction, and on what contact with them holds
    Solids,     ///< moving ones on the liquid: by its pressure on them, by its viscosity, by what follows them at walls, by contact
    Pins,
    FabricToGrid,        ///< solver grid: from vertices to faces …
    FabricToVertices,    ///< … and back, with the fading of velocities
    Walls,               ///< on the liquid's faces
    ToParticles,         ///< liquid from faces to particles
    PositionCorrection,  ///< particles moved by relaxation, for their volume, and out of obstacles
    Drip,
    Wicking,
    Count
};
inline constexpr int kEnergyChanges = static_cast<int>(EnergyChange::Count);
inline constexpr std::array<std::string_view, kEnergyChanges> kEnergyChangeNames = {
    "sources",
    "capture",
    "to_grid",
    "gravity",
    "viscosity",
    "surface_tension",
    "pressure",
    "strain",
    "suction",
    "drag",
    "implicit",
    "damping",
    "contact",
    "friction",
    "obstacles",
    "solids",
    "pins",
    "fabric_to_grid",
    "fabric_to_vertices",
    "walls",
    "to_particles",
    "position_correction",
    "drip",
    "wicking",
};

/// Energy that each gave, or took if negative [erg].
struct EnergyChanges {
    std::array<double, kEnergyChanges> of{};

    double& operator[](EnergyChange change) { return of[static_cast<int>(change)]; }
    double operator[](EnergyChange change) const { return of[static_cast<int>(change)]; }
    EnergyChanges& operator+=(const EnergyChanges& other)
    {
        for (int i = 0; i < kEnergyChanges; ++i) of[i] += other.of[i];
        return *this;
    }
};

}  // namespace sim

#pragma once

#include <array>
#include <string_view>

namespace sim {

// Where energy goes, in the order of a step, with the names that tables give it.
#define SIM_ENERGY_CHANGES(CHANGE)                                                                                                               \
    CHANGE(Sources, "sources")                /* liquid that was emitted, or left the domain, and the work of pressing it in */                  \
    CHANGE(Capture, "capture")                /* velocities mix where fabric takes up liquid */                                                  \
    CHANGE(ToGrid, "to_grid")                 /* liquid from particles to faces */                                                               \
    CHANGE(Gravity, "gravity")                /* the weight's work on the faces, and the particles' change of potential energy */                \
    CHANGE(Viscosity, "viscosity")            /* viscosity of the liquid, on the faces */                                                        \
    CHANGE(SurfaceTension, "surface_tension") /* work on the faces: the surface's energy is not in the sum */                                    \
    CHANGE(Pressure, "pressure")              /* work on both phases, and what the projection takes from liquid alone */                         \
    CHANGE(Strain, "strain")                  /* the strain correction, beyond what stretching has given for it (LiquidEnergies::strain) */      \
    CHANGE(Suction, "suction")                                                                                                                   \
    CHANGE(Drag, "drag")           /* drag between liquid and fabric */                                                                          \
    CHANGE(Implicit, "implicit")   /* backward Euler: ½ m Δv² of fabric and dragged liquid, and work of elastic forces beyond their energy */ \
    CHANGE(Damping, "damping")     /* damping of the fabric's material */                                                                        \
    CHANGE(Contact, "contact")     /* contact among fabric, beyond FabricState::stored; solver grid: with friction */                            \
    CHANGE(Friction, "friction")   /* friction of fabric on fabric */                                                                            \
    CHANGE(Obstacles, "obstacles") /* work on fabric, with friction, and on what contact with them holds */                                      \
    CHANGE(Solids, "solids")       /* work of moving solids on the liquid, by pressure, viscosity, walls and contact */                          \
    CHANGE(Pins, "pins")                                                                                                                         \
    CHANGE(FabricToGrid, "fabric_to_grid")            /* fabric from vertices to faces, solver grid */                                           \
    CHANGE(FabricToVertices, "fabric_to_vertices")    /* fabric from faces to vertices, with the fading of velocities, solver grid */            \
    CHANGE(Walls, "walls")                            /* velocities of the liquid's faces behind walls */                                        \
    CHANGE(ToParticles, "to_particles")               /* liquid from faces to particles */                                                       \
    CHANGE(PositionCorrection, "position_correction") /* particles moved by relaxation, for their volume, and out of obstacles */                \
    CHANGE(Drip, "drip")                                                                                                                         \
    CHANGE(Wicking, "wicking")

/// Where energy goes in a step (sim/README.md, Energy): stages by the energy before and after them, forces by their work along the move that
/// was made. What they do not explain is the error of the solves.
enum class EnergyChange {
#define SIM_ENERGY_CHANGE_ENUMERATOR(change, name) change,
    SIM_ENERGY_CHANGES(SIM_ENERGY_CHANGE_ENUMERATOR)
#undef SIM_ENERGY_CHANGE_ENUMERATOR
        Count
};
inline constexpr int kEnergyChanges = static_cast<int>(EnergyChange::Count);
inline constexpr std::array<std::string_view, kEnergyChanges> kEnergyChangeNames = {
#define SIM_ENERGY_CHANGE_NAME(change, name) name,
    SIM_ENERGY_CHANGES(SIM_ENERGY_CHANGE_NAME)
#undef SIM_ENERGY_CHANGE_NAME
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

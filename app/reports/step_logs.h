#pragma once

#include "app/readings/force_log.h"
#include "sim/state.h"

#include <string>
#include <string_view>

// Lines of the logs that grow with a run: steps.jsonl and energy.csv.

namespace app {

/// Line of steps.jsonl: what a step reports, as JSON.
std::string stepLine(const sim::State& state, const sim::StepReport& report, const ForceNames& names, const sim::Forces& forces);

inline constexpr std::string_view kEnergyHeader =
    "time_s,kinetic_erg,modal_erg,potential_erg,total_erg,particles,liquid_mass_g,total_per_particle_erg,"
    "fabric_kinetic_erg,fabric_potential_erg,fabric_elastic_erg,fabric_contact_erg,published_erg";

/// Row of energy.csv, under its head.
/// @param liquidMass  mass of all particles [g]
/// @param gravity     [cm/s^2]
std::string energyRow(const sim::State& state, const sim::Energies& energies, double liquidMass, const sim::Vec3& gravity);

}  // namespace app

#include "sim/renamed.h"

namespace sim {

namespace {

constexpr Renamed kKeys[] = {
    {"transfer.keep", "transfer.damping", true},
    {"transfer.keep_dt", "transfer.damping_dt"},
    {"coupling.capture.compat_factor", "coupling.capture.published_rate_factor"},
    {"output.probes.hoops", "output.probes.control_surfaces"},
};

constexpr Renamed kFields[] = {
    // report.json
    {"seconds_per_step/stages/keep", "seconds_per_step/stages/backup"},
    {"seconds_per_step/stages/taken_back", "seconds_per_step/stages/rejected"},
    {"fabric/halvings", "fabric/substep_splits"},
    {"fabric/shortened", "fabric/truncated_substeps"},
    {"fabric/least_taken_fraction", "fabric/least_accepted_fraction"},
    {"taken_back", "rejected_steps"},
    {"energy_ledger/changes/places", "energy_ledger/changes/position_correction"},
    {"energy_ledger/unbooked", "energy_ledger/residual"},
    // steps.jsonl; some are those of report.json
    {"seconds/keep", "seconds/backup"},
    {"seconds/taken_back", "seconds/rejected"},
    {"withheld_iterations", "hydrostatic_iterations"},
    {"ledger/momentum_to_pins", "ledger/pin_impulse"},
    {"ledger/momentum/to_solids", "ledger/momentum/solid_impulse"},
    {"ledger/momentum/borne", "ledger/momentum/support_residual"},
    {"fabric/taken_fraction", "fabric/accepted_fraction"},
    {"fabric/list_builds", "fabric/candidate_list_builds"},
    {"fabric/scalings", "fabric/global_scalings"},
    // energy_ledger.csv
    {"places_erg", "position_correction_erg"},
    {"unbooked_erg", "residual_erg"},
    // checkpoints
    {"logs/seconds/keep", "logs/seconds/backup"},
    {"logs/seconds/taken_back", "logs/seconds/rejected"},
    {"logs/fabric_halvings", "logs/fabric_substep_splits"},
    {"logs/fabric_shortened", "logs/fabric_truncated_substeps"},
    {"logs/least_taken_fraction", "logs/least_accepted_fraction"},
    {"logs/taken_back", "logs/rejected_steps"},
    {"logs/ledger/largest_unbooked", "logs/ledger/largest_residual"},
};

constexpr Renamed kOptions[] = {
    {"--knob", "--parameter"},
};

/// @param from, to  the names that a row has of both
std::string translated(std::string_view field, std::string_view Renamed::*from, std::string_view Renamed::*to)
{
    for (const Renamed& row : kFields) {
        const std::string_view name = row.*from;
        if (!field.starts_with(name)) continue;
        const std::string_view rest = field.substr(name.size());
        if (rest.empty() || rest[0] == '/' || rest[0] == '[') return std::string(row.*to).append(rest);
    }
    return std::string(field);
}

}  // namespace

std::span<const Renamed> renamedKeys() { return kKeys; }
std::span<const Renamed> renamedFields() { return kFields; }
std::span<const Renamed> renamedOptions() { return kOptions; }

std::string currentName(std::string_view field) { return translated(field, &Renamed::before, &Renamed::now); }
std::string formerName(std::string_view field) { return translated(field, &Renamed::now, &Renamed::before); }

}  // namespace sim

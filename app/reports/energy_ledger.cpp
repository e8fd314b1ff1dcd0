#include "app/reports/energy_ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <string>

namespace app {

EnergyLedger::EnergyLedger(const std::filesystem::path& file) : file_(file)
{
    std::string header = "time_s,total_erg,kinetic_erg";
    for (std::string_view name : sim::kEnergyChangeNames) header += fmt::format(",{}_erg", name);
    file_.add(header + ",residual_erg");
}

EnergyLedger::EnergyLedger(const std::filesystem::path& file, std::uintmax_t bytes, const Summary& summary) : file_(file, bytes), summary_(summary) {}

void EnergyLedger::add(double time, const sim::Energies& energies)
{
    const auto& changes = summary_.changes.of;
    const double kinetic = energies.kinetic + energies.modal + energies.fabric.kinetic;
    const double residual = energies.total() - summary_.first - std::accumulate(changes.begin(), changes.end(), 0.0);
    summary_.largestKinetic = std::max(summary_.largestKinetic, kinetic);
    summary_.largestResidual = std::max(summary_.largestResidual, std::abs(residual));
    std::string line = fmt::format("{:.9g},{:.12g},{:.9g}", time, energies.total(), kinetic);
    for (double change : changes) fmt::format_to(std::back_inserter(line), ",{:.9g}", change);
    file_.add(fmt::format("{},{:.6g}", line, residual));
}

void EnergyLedger::initial(double time, const sim::Energies& energies)
{
    summary_.first = energies.total();
    add(time, energies);
}

void EnergyLedger::step(double time, const sim::StepReport& report)
{
    for (int i = 0; i < sim::kEnergyChanges; ++i) summary_.changes.of[i] += report.energyChanges->of[i];
    if (!report.isReflected) add(time, report.energies);
}

}  // namespace app

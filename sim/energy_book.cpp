#include "sim/energy_book.h"

#include "sim/core/parallel.h"
#include "sim/liquid/energy.h"

namespace sim {

EnergyBook::EnergyBook(const State& state, const Settings& settings, const Workspace& work, StepReport& report)
    : state_(state), settings_(settings), work_(work), changes_(report.energyChanges)
{
    if (!work.booksEnergy) return;
    changes_.emplace();
    last_ = look();
    lag_ = potentialLag(state_, settings_);
}

double EnergyBook::particlesKinetic() const
{
    const Energies e = liquidEnergies(state_.liquid, state_.grid, settings_.gravity, isSorted_ ? &work_.order : nullptr);
    return e.kinetic + e.modal;
}

double EnergyBook::facesKinetic() const
{
    return parallelSum(mass_.size(), [&](std::size_t i) { return 0.5 * mass_.block(0)[i] * std::pow(work_.grid.faces.velocity.block(0)[i], 2); });
}

EnergyBook::Energy EnergyBook::look() const
{
    Energy e;
    e.liquidKinetic = isOnFaces_ ? facesKinetic() : particlesKinetic();
    e.potential = weightSums(state_.liquid, settings_.gravity).potential;
    if (work_.fabric) e.fabric = work_.fabric->energies(state_.fabric, settings_.gravity).total();
    if (work_.gridFabric) e.fabric = work_.gridFabric->energies(state_.fabric, settings_.gravity).total();
    return e;
}

void EnergyBook::onFaces(EnergyChange change)
{
    if (!changes_) return;
    fallen_ = work_.grid.faces.velocity;
    after(change);
}

void EnergyBook::surfaceTension(bool isMixed)
{
    if (!changes_) return;
    pulled_ = work_.grid.faces.velocity;
    parallelFor(pulled_.size(), 4096, [&](std::size_t i) { pulled_.block(0)[i] -= fallen_.block(0)[i]; });
    if (isMixed) work_.coupling->mixture.clearShared(pulled_);
}

double EnergyBook::workOfSurfaceTension() const
{
    if (pulled_.size() == 0) return 0.0;
    const BlockArray<double, 3>& now = work_.grid.faces.velocity;
    return parallelSum(mass_.size(), [&](std::size_t i) {
        return mass_.block(0)[i] * pulled_.block(0)[i] * now.block(0)[i];
    });
}

void EnergyBook::after(EnergyChange change)
{
    if (!changes_) return;
    const Energy now = look();
    book(change, now.sum() - last_.sum());
    last_ = now;
}

void EnergyBook::sorted()
{
    isSorted_ = true;
    after(EnergyChange::Sources);
}

void EnergyBook::toGrid()
{
    if (!changes_) return;
    const auto& sums = work_.grid.faces.sums;
    mass_.resize(state_.grid.count());
    double kinetic = 0.0;
    for (int b = 0; b < state_.grid.count(); ++b)
        for (int a = 0; a < kAxes; ++a) {
            const double *m = sums.block(b, FaceFields::kMass + a), *p = sums.block(b, FaceFields::kMomentum + a);
            std::copy_n(m, kBlockCells, mass_.block(b, a));
            for (int c = 0; c < kBlockCells; ++c)
                if (m[c] > 0.0) kinetic += 0.5 * p[c] * p[c] / m[c];
        }
    isOnFaces_ = true;
    book(EnergyChange::ToGrid, kinetic - last_.liquidKinetic);
    last_.liquidKinetic = kinetic;
}

void EnergyBook::pressedIn(double work)
{
    if (!changes_) return;
    pressedIn_ = work;
    book(EnergyChange::Sources, work);
}

void EnergyBook::solved(bool isMixed, const FabricReport& fabric)
{
    if (!changes_) return;
    const Energy now = look();
    double alone = now.liquidKinetic - last_.liquidKinetic;  // of faces that only liquid is on
    if (fabric.energyChanges) *changes_ += *fabric.energyChanges;
    if (isMixed) {
        const Mixture& mixture = work_.coupling->mixture;
        *changes_ += mixture.energyChanges(work_.grid, fallen_);
        alone -= mixture.kinetic(work_.grid.faces.velocity) - mixture.kinetic(fallen_);
    }
    const double tension = workOfSurfaceTension();
    book(EnergyChange::SurfaceTension, tension);
    book(EnergyChange::Pressure, alone - tension - pressedIn_);
    last_ = now;
}

void EnergyBook::toParticles(double dt)
{
    if (!changes_) return;
    isOnFaces_ = isSorted_ = false;
    const Energy now = look();
    const LiquidParticles& liquid = state_.liquid;
    const double fallen = -dt * parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p] * settings_.gravity.dot(liquid.velocity(p)); });
    book(EnergyChange::ToParticles, now.liquidKinetic - last_.liquidKinetic);
    book(EnergyChange::Gravity, fallen);
    book(EnergyChange::Places, now.potential - last_.potential - fallen);
    last_ = now;
}

void EnergyBook::finished()
{
    if (changes_) book(EnergyChange::Gravity, potentialLag(state_, settings_) - lag_);
}

}  // namespace sim

#include "sim/energy_budget.h"

#include "sim/core/parallel.h"
#include "sim/liquid/energy.h"
#include "sim/liquid/inflow.h"
#include "sim/time_step.h"

namespace sim {

EnergyBudget::EnergyBudget(const State& state, const Settings& settings, const Workspace& work, StepReport& report)
    : state_(state), settings_(settings), work_(work), report_(report), changes_(report.energyChanges)
{
    if (!work.booksEnergy) return;
    changes_.emplace();
    last_ = currentEnergy();
    if (work.correctsStrain) strain_ = strainEnergy(state.liquid, state.grid);
    lag_ = staggeredPotentialOffset(state_, settings_);
}

double EnergyBudget::particlesKinetic() const
{
    const LiquidEnergies e = liquidEnergies(state_.liquid, state_.grid, settings_.gravity, isSorted_ ? &work_.order : nullptr);
    return e.kinetic + e.modal;
}

double EnergyBudget::facesKinetic() const
{
    return parallelSum(mass_.size(), [&](std::size_t i) { return 0.5 * mass_.block(0)[i] * std::pow(work_.grid.faces.velocity.block(0)[i], 2); });
}

EnergyBudget::Energy EnergyBudget::currentEnergy() const
{
    Energy e;
    e.liquidKinetic = isOnFaces_ ? facesKinetic() : particlesKinetic();
    e.potential = weightSums(state_.liquid, settings_.gravity).potential;
    if (work_.fabric) e.fabric = work_.fabric->energies(state_.fabric, settings_.gravity).total();
    if (work_.coupling) e.fabricMoment = fabricMoment();
    return e;
}

Vec3 EnergyBudget::fabricMoment() const
{
    const std::vector<double>& dry = work_.coupling->fabric.mass;
    Vec3 moment;
    for (int a = 0; a < kAxes; ++a)
        moment[a] = parallelSum(dry.size(), [&](std::size_t v) { return (dry[v] + state_.fabric.absorbed[v]) * state_.fabric.x[v][a]; });
    return moment;
}

void EnergyBudget::onFaces(EnergyChange change)
{
    if (!changes_) return;
    fallen_ = work_.grid.faces.velocity;
    after(change);
}

void EnergyBudget::viscosity(double bySolids, double byOpenings)
{
    if (!changes_) return;
    book(EnergyChange::Solids, bySolids);
    book(EnergyChange::Sources, byOpenings);
    book(EnergyChange::Viscosity, -bySolids - byOpenings);
    onFaces(EnergyChange::Viscosity);
}

void EnergyBudget::remember()
{
    if (changes_) remembered_ = work_.grid.faces.velocity;
}

void EnergyBudget::levelled()
{
    if (!changes_) return;
    const BlockArray<double, 3>& now = work_.grid.faces.velocity;
    const double gained = parallelSum(mass_.size(), [&](std::size_t i) {
        const double u = now.block(0)[i], before = remembered_.block(0)[i];
        return 0.5 * mass_.block(0)[i] * (u - before) * (u + before);
    });
    parallelFor(fallen_.size(), 4096, [&](std::size_t i) { fallen_.block(0)[i] += now.block(0)[i] - remembered_.block(0)[i]; });
    book(EnergyChange::Gravity, gained);
    last_.liquidKinetic += gained;
}

void EnergyBudget::surfaceTension(const std::optional<Mixture::SharedFaces>& shared)
{
    if (!changes_) return;
    pulled_ = work_.grid.faces.velocity;
    parallelFor(pulled_.size(), 4096, [&](std::size_t i) { pulled_.block(0)[i] -= remembered_.block(0)[i]; });
    if (!shared) return;
    pulledMixture_ = pulled_;
    work_.coupling->mixture.clearShared(*shared, pulled_);
}

double EnergyBudget::workOfSurfaceTension() const
{
    if (pulled_.size() == 0) return 0.0;
    const BlockArray<double, 3>& now = work_.grid.faces.velocity;
    return parallelSum(mass_.size(), [&](std::size_t i) { return mass_.block(0)[i] * pulled_.block(0)[i] * now.block(0)[i]; });
}

void EnergyBudget::after(EnergyChange change)
{
    if (!changes_) return;
    const Energy now = currentEnergy();
    book(change, now.sum() - last_.sum());
    last_ = now;
}

void EnergyBudget::taken(EnergyChange change, std::span<const Vec3> pinImpulse)
{
    if (!changes_) return;
    const double held = parallelSum(pinImpulse.size(), [&](std::size_t v) { return -pinImpulse[v].dot(state_.fabric.v[v]); });
    book(EnergyChange::Pins, held);
    book(change, -held);
    const Energy now = currentEnergy();
    const double lifted = std::max(0.0, now.potential - last_.potential - settings_.gravity.dot(now.fabricMoment - last_.fabricMoment));
    book(EnergyChange::Suction, lifted);
    book(change, -lifted);
    after(change);
}

void EnergyBudget::sorted()
{
    isSorted_ = true;
    after(EnergyChange::Sources);
    if (!changes_) return;
    const double lag = staggeredPotentialOffset(state_, settings_);  // of what has come and gone, too
    book(EnergyChange::Sources, lag - lag_);
    lag_ = lag;
}

void EnergyBudget::toGrid()
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

void EnergyBudget::strainCorrected()
{
    if (!changes_) return;
    const BlockArray<double, 3>& now = work_.grid.faces.velocity;
    strained_ = parallelSum(state_.grid.count(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        double gained = 0.0;
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                if (!work_.strain.acts.test(b, c, a)) continue;
                const double u = now.block(b, a)[c], before = remembered_.block(b, a)[c];
                gained += 0.5 * mass_.block(b, a)[c] * (u - before) * (u + before);
            }
        return gained;
    });
    book(EnergyChange::Strain, strained_);
}

void EnergyBudget::pressedIn(double work)
{
    if (!changes_) return;
    pressedIn_ += work;
    book(EnergyChange::Sources, work);
}

void EnergyBudget::heldByOpenings(double work)
{
    if (!changes_) return;
    book(EnergyChange::Sources, work);
    book(EnergyChange::Gravity, -work);
}

double EnergyBudget::workAgainst(const BlockArray<double>& pressure, double dt) const
{
    if (!work_.obstacles.anyMoving()) return 0.0;
    const BlockGrid& grid = state_.grid;
    const ObstacleField& field = work_.obstacleField;
    const double area = grid.dx * grid.dx;
    return parallelSum(grid.count(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        double work = 0.0;
        if (!field.nearSolid(b)) return work;
        for (int c = 0; c < kBlockCells; ++c) {
            if (!work_.grid.inside.test(b, c)) continue;
            for (int a = 0; a < kAxes; ++a)
                for (int side = 0; side < 2; ++side) {
                    Vec3i at(c & 7, c >> 3 & 7, c >> 6);
                    at[a] += side;
                    const CellRef face = cellNear(grid, b, at.x(), at.y(), at.z());
                    work += (side == 0 ? 1.0 : -1.0) * field.swept(face.block, a)[face.cell] * dt * area * pressure.block(b)[c];
                }
        }
        return work;
    });
}

double EnergyBudget::workOnFollowers(const BlockArray<double, 3>& read, const Vec3& fall, double flipRatio) const
{
    if (!work_.obstacles.anyMoving()) return 0.0;
    const ObstacleField& field = work_.obstacleField;
    return parallelSum(state_.grid.count(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        double work = 0.0;
        if (!field.nearSolid(b)) return work;
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                const double mass = mass_.block(b, a)[c], wall = field.wallVelocity(b, a)[c];
                if (!(mass > 0.0) || wall == 0.0 || field.open(b, a)[c] > 0.0) continue;
                const double change = read.block(b, a)[c] - fallen_.block(b, a)[c];
                work += mass * ((1.0 - flipRatio) * change - flipRatio * fall[a]) * wall;
            }
        return work;
    });
}

void EnergyBudget::walls(const BlockArray<double, 3>& read, const Vec3& fall, double flipRatio)
{
    if (!changes_) return;
    const WallFaces::WallDriven& driven = work_.wallFaces.driven;
    const double work = workOnFollowers(read, fall, flipRatio) + (1.0 - flipRatio) * driven.work, lifted = -fall.dot(driven.heavy);
    book(EnergyChange::Solids, work + lifted);
    book(EnergyChange::Walls, -work);
    book(EnergyChange::Gravity, -lifted);  // what the walls hold of the liquid's weight does not act on the faces
    // Open faces keep their energy: that particles read some with those beside them (SlantedWalls) is a part of the way to the particles.
    const double onClosed = gainOfClosed();
    book(EnergyChange::Walls, onClosed);
    last_.liquidKinetic += onClosed;
}

double EnergyBudget::gainOfClosed() const
{
    const std::vector<int>& blocks = work_.obstacleField.blocksNearSolid();
    return parallelSum(blocks.size(), [&](std::size_t n) {
        const int b = blocks[n];
        double gained = 0.0;
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                if (work_.obstacleField.open(b, a)[c] > 0.0) continue;
                const double now = work_.grid.faces.velocity.block(b, a)[c], before = fallen_.block(b, a)[c];
                gained += 0.5 * mass_.block(b, a)[c] * (now - before) * (now + before);
            }
        return gained;
    });
}

void EnergyBudget::bookSolidsWork()
{
    if (!changes_ || !work_.obstacles.anyMoving()) return;
    const MomentumBudget::ImposedMomentum& borne = work_.momentum.imposedMomentum();
    double work = -borne.bySolid.dot(work_.obstacles.velocity(borne.place));
    for (int n = 0; n < work_.obstacles.count(); ++n) work += work_.onSolids.on(n).work;
    const double more = work - (*changes_)[EnergyChange::Solids];
    book(EnergyChange::Solids, more);
    book(EnergyChange::Pressure, -more);
}

void EnergyBudget::solved(const std::optional<Mixture::SeparatedPhases>& separated, double dt, const Vec3& gravity, const FabricReport& fabric)
{
    if (!changes_) return;
    const Energy now = currentEnergy();
    book(EnergyChange::Gravity, (gravity - settings_.gravity).dot(now.fabricMoment - last_.fabricMoment));
    double alone = now.liquidKinetic - last_.liquidKinetic;  // of faces that only liquid is on
    if (fabric.energyChanges) *changes_ += *fabric.energyChanges;
    if (separated) {
        const Mixture& mixture = work_.coupling->mixture;
        *changes_ += mixture.energyChanges(*separated, work_.grid, fallen_);
        alone -= mixture.kinetic(*separated, work_.grid.faces.velocity) - mixture.kinetic(*separated, fallen_);
        if (pulledMixture_.size() > 0) {
            const double tension = mixture.workOf(*separated, pulledMixture_, work_.grid);
            book(EnergyChange::SurfaceTension, tension);
            book(EnergyChange::Pressure, -tension);  // the mixture takes it for a part of the pressure
        }
    }
    const double tension = workOfSurfaceTension();
    book(EnergyChange::SurfaceTension, tension);
    const double solids = workAgainst(state_.pressure, dt);
    book(EnergyChange::Solids, solids);
    book(EnergyChange::Pressure, alone - tension - solids - pressedIn_ - strained_);
    last_ = now;
}

void EnergyBudget::reflected(double dt, double byOpenings)
{
    if (!changes_) return;
    const BlockArray<double>& again = work_.reflection.potential;
    const double solids = workAgainst(again, dt), sources = inflowWork(state_.grid, work_.inflow, again, dt) + byOpenings;
    book(EnergyChange::Solids, solids);
    book(EnergyChange::Sources, sources);
    book(EnergyChange::ToParticles, -(solids + sources));
}

void EnergyBudget::toParticles(double dt, const PushOutTotals& pushed)
{
    if (!changes_) return;
    isOnFaces_ = isSorted_ = false;
    const Energy now = currentEnergy();
    const LiquidParticles& liquid = state_.liquid;
    const double fallen = -dt * parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p] * settings_.gravity.dot(liquid.velocity(p)); });
    const double lifted = -settings_.gravity.dot(pushed.carried);
    book(EnergyChange::Solids, pushed.work + lifted);
    book(EnergyChange::ToParticles, now.liquidKinetic - last_.liquidKinetic - pushed.work);
    book(EnergyChange::Gravity, fallen);
    book(EnergyChange::PositionCorrection, now.potential - last_.potential - fallen - lifted);
    last_ = now;
}

void EnergyBudget::finished()
{
    if (!changes_) return;
    book(EnergyChange::Gravity, staggeredPotentialOffset(state_, settings_) - lag_);
    book(EnergyChange::Strain, strain_ - report_.energies.strain);
}

}  // namespace sim

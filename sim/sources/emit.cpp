#include "sim/sources/emit.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/shapes/volume.h"
#include "sim/sources/fill_up.h"
#include "sim/sources/lay.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

bool isActive(const Emission& e, double timeFrom, double timeTo)
{
    const bool runs = e.from <= timeFrom && timeFrom <= e.to && !isInstant(e);
    if (timeFrom == timeTo) return runs || (isInstant(e) && e.from <= timeFrom);
    const bool isShort = timeFrom < e.from && e.to <= timeTo;  // no step begins in it
    return runs || isShort;
}

/// How many whole particles there are in a volume, be it negative.
std::size_t wholeParticles(double volume, double perParticle)
{
    constexpr double kRoundOff = 1.0e-9;
    return static_cast<std::size_t>(std::max(0.0, std::floor(volume / perParticle + kRoundOff)));
}

/// One step of a source that flows. What it is asked for, its area times its speed times the step, it owes. Where its pattern finds the
/// room that moving liquid has left, it lays particles there, a layer at a time; where it is covered by liquid that does not move along, it
/// presses them in, and the projection makes room for them (Inflow).
class Flow {
 public:
    Flow(const Scene& scene, std::size_t source, const Emission& emission, double timeFrom, double timeTo, State& state)
        : scene_(scene),
          emission_(emission),
          source_(source),
          state_(state),
          memory_(state.memory.sources[source]),
          plan_(planFor(scene, source, timeFrom, state)),
          region_(regionOf(plan_)),
          pitch_(particleSpacing(plan_.fill, plan_.dx)),
          speed_(emission.velocity.norm()),
          timeFrom_(timeFrom),
          time_(std::max(0.0, std::min(timeTo, emission.to) - std::max(timeFrom, emission.from))),
          isLast_(emission.to <= timeTo)
    {
        plan_.velocity = emission.velocity;
        plan_.age = std::max(0.0, timeFrom - emission.from);
        // Before its first step a source has its whole volume to fill, as far as there is room.
        isFirst_ = !(memory_.laidAt >= emission.from);
        if (isFirst_) time_ += std::max(0.0, timeFrom - emission.from);  // it began within the last step
        if (!isFirst_) plan_.moved = (timeFrom - memory_.laidAt) * emission.velocity;
    }

    void emit(std::optional<MouthSize>& size, std::vector<Inflow>& inflows)
    {
        if (!size) size = measure();
        size_ = *size;
        plan_.regionVolume = size_.volume;
        const LiquidNearby nearby = liquidNear(state_.liquid, plan_, scene_.settings.liquid.density);
        Seeds seeds = seedsFor(scene_, source_, plan_, nearby);
        if (isFirst_) memory_ = {.isShut = memory_.isShut};
        memory_.laidAt = std::max(emission_.from, timeFrom_);
        lookWhatCovers();
        owe();
        layFreely(seeds);
        pressIn(seeds.volume);
        const double room = roomMade();
        if (room > 0.0 || memory_.isShut) inflows.push_back({source_, region_, room});
    }

 private:
    static constexpr double kLayers = 2.0;  ///< behind the inlet that are looked at
    static constexpr double kFading = 4.0;  ///< how far what came freely moves until it counts no more [pitches]

    MouthSize measure() const { return {areaAcross(region_, emission_.velocity, pitch_), boundedVolume(region_, plan_.dx)}; }
    double packing() const { return packingOf(plan_.fill.pattern); }
    double asked() const { return packing() * size_.area * speed_ * time_; }  ///< volume that the source asks for in the step [cm^3]
    double layer() const { return packing() * size_.area * pitch_; }
    double left() const { return emission_.maxVolume - state_.emittedVolume[source_]; }

    /// Finds which share of the first layers behind its inlet other liquid takes than what has come there freely and moves along: none in a
    /// jet, all of it under water, or where what came is held up.
    void lookWhatCovers()
    {
        const double room = kLayers * layer(), moved = plan_.moved.norm();
        if (!(room > 0.0)) return;
        const double taken = volumeBehindInlet() / room;
        if (isFirst_) {
            memory_.covered = std::min(1.0, taken);
            memory_.freely = kFading * layer() * (1.0 - memory_.covered);
        }
        const double others = std::clamp(taken - memory_.freely / (kFading * layer()), 0.0, 1.0);
        memory_.covered += std::min(1.0, moved / pitch_) * (others - memory_.covered);
        memory_.freely *= std::exp(-moved / (kFading * pitch_));
    }
    double volumeBehindInlet() const
    {
        const Vec3 way = (kLayers * pitch_ / speed_) * emission_.velocity;
        const Inlet inlet(region_, plan_.solids, way, pitch_);
        Eigen::AlignedBox3d box = region_.bounds();
        box.extend(Eigen::AlignedBox3d(box.min() + way, box.max() + way));
        const LiquidParticles& liquid = state_.liquid;
        return parallelSum(liquid.count,
                           [&](std::size_t p) {
                               const Vec3 x = liquid.position(p);
                               return box.contains(x) && (inlet.hasEntered(x) || inlet.hasPassed(x)) ? liquid.mass[p] : 0.0;
                           }) /
               scene_.settings.liquid.density;
    }

    /// Share of the mouth that liquid covers, free of the noise of single particles [-].
    double coveredShare() const
    {
        constexpr double kAll = 0.8, kNone = 0.2;
        return memory_.covered > kAll ? 1.0 : memory_.covered < kNone ? 0.0 : memory_.covered;
    }

    void owe()
    {
        if (memory_.isShut) memory_.owed = std::min(memory_.owed, 0.0);
        const double asked = memory_.isShut ? 0.0 : this->asked(), covered = coveredShare();
        memory_.owed += asked;
        // Layers come one by one, of which the first may be late: no more than that and the rounding to steps is no reason to press.
        const double slack = (1.0 - covered) * layer() + 2.0 * asked;
        const double share = covered > 0.0 ? memory_.toPress + covered * asked : 0.0;
        const bool isAllPressed = covered == 1.0 || (covered > 0.0 && isLast_);
        memory_.toPress = isAllPressed ? memory_.owed : std::clamp(share, memory_.owed - slack, memory_.owed + slack);
        memory_.toPress = std::max(0.0, memory_.toPress);
    }

    /// The places that have just come into the region may be laid up to a layer in advance, others where they are owed.
    void layFreely(Seeds& seeds)
    {
        const std::size_t most = countUpTo(left(), seeds.volume);
        if (!isFirst_) {
            const double owed = memory_.owed - memory_.toPress;
            keepAllowed(wholeParticles(owed + (1.0 - coveredShare()) * layer(), seeds.volume), owed, seeds);
        }
        const NewParticles particles = firstOf(seeds, most);
        lay(scene_, source_, emission_, particles, state_);
        if (isFirst_) return;
        memory_.owed -= static_cast<double>(particles.positions.size()) * seeds.volume;
        memory_.freely += static_cast<double>(particles.positions.size()) * seeds.volume;
    }
    void keepAllowed(std::size_t mostEntered, double owed, Seeds& seeds) const
    {
        std::vector<char> hasCome(seeds.positions.size());
        const Inlet inlet(region_, plan_.solids, plan_.moved, pitch_);
        for (std::size_t n = 0; n < hasCome.size(); ++n) hasCome[n] = inlet.hasEntered(seeds.positions[n]) || inlet.hasPassed(seeds.positions[n]);
        const std::size_t entered = std::min(mostEntered, static_cast<std::size_t>(std::ranges::count(hasCome, 1)));
        std::size_t others = wholeParticles(owed - static_cast<double>(entered) * seeds.volume, seeds.volume), come = entered;
        std::vector<Vec3> kept;
        for (std::size_t n = 0; n < hasCome.size(); ++n) {
            std::size_t& rest = hasCome[n] ? come : others;
            if (rest == 0) continue;
            --rest;
            kept.push_back(seeds.positions[n]);
        }
        seeds.positions = std::move(kept);
    }

    void pressIn(double particle)
    {
        const std::size_t count = std::min(wholeParticles(memory_.toPress, particle), countUpTo(left(), particle));
        const std::vector<Vec3> positions = spread(count);
        lay(scene_, source_, emission_, {positions, particle}, state_);
        const double volume = static_cast<double>(positions.size()) * particle;
        memory_.owed -= volume;
        memory_.toPress -= volume;
        memory_.crowded += volume;
    }

    /// Volume for which the step makes room [cm³]: at about the rate that the source is asked for, be particles larger than what that is in the step.
    /// At once, the room of one particle in a short step would push the liquid around it away at any speed.
    double roomMade()
    {
        const double rest = 1.0 - std::exp(-speed_ * time_ / pitch_);  // of what is crowded: gone as soon as what came has moved on by its pitch
        const double room = std::min(memory_.crowded, asked() + rest * memory_.crowded);
        memory_.crowded -= room;
        return room;
    }

    /// Places spread evenly over the region, over those of several steps, too: an additive sequence in three dimensions (Roberts 2018).
    std::vector<Vec3> spread(std::size_t count) const
    {
        constexpr std::uint64_t kMostTries = 4096;  // for each, of which as many succeed as the region fills of its box
        constexpr std::uint64_t kApart = 64;        // elements from where one particle begins to where the next does
        constexpr double kStep[kAxes] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
        const Eigen::AlignedBox3d box = region_.bounds();
        std::vector<Vec3> places;
        std::uint64_t number = kApart * state_.nextId;
        for (std::uint64_t tries = 0; places.size() < count && tries < kMostTries * count; ++tries, ++number) {
            Vec3 x;
            for (int a = 0; a < kAxes; ++a) {
                const double at = 0.5 + static_cast<double>(number) * kStep[a];
                x[a] = box.min()[a] + (at - std::floor(at)) * box.sizes()[a];
            }
            if (region_.distance(x) < 0.0) places.push_back(x);
        }
        return places;
    }

    const Scene& scene_;
    const Emission& emission_;
    std::size_t source_;
    State& state_;
    SourceMemory& memory_;
    SeedPlan plan_;
    Shape region_;
    double pitch_;     ///< pitch of the pattern [cm]
    double speed_;     ///< [cm/s]
    double timeFrom_;  ///< the beginning of the step [s]
    double time_;      ///< part of the step in which the source is asked for anything [s]
    MouthSize size_;
    bool isFirst_ = false;
    bool isLast_;  ///< whether the emission ends within the step
};

/// Measures anew what may have changed.
void prepare(const Scene& scene, double time, const State& state, EmissionWorkspace& work)
{
    work.inflows.clear();
    std::size_t count = 0;
    for (const SourceSettings& source : scene.sources) count += source.emissions.size();
    work.sizes.resize(count);
    const bool isStill = std::ranges::all_of(scene.obstacles, [&](const ObstacleSettings& o) { return !o.motion.moves(time - state.lastDt, time); });
    if (!isStill) work.sizes.assign(count, std::nullopt);
}

bool gives(const Emission& emission, double emittedVolume, double timeFrom, double timeTo)
{
    return isActive(emission, timeFrom, timeTo) && emittedVolume < emission.maxVolume;
}

}  // namespace

double packingOfSources(const Scene& scene, const State& state)
{
    double packing = 0.0;
    for (std::size_t n = 0; n < scene.sources.size(); ++n) {
        const SourceSettings& source = scene.sources[n];
        double own = packingOf(source.fill.pattern);
        const bool isBody = source.emissions.size() == 1 && isInstant(source.emissions[0]) && source.emissions[0].from <= scene.settings.time.start;
        const bool isWhole = isBody && !(source.emissions[0].maxVolume < std::numeric_limits<double>::infinity());
        if (own < 1.0 && isWhole)
            own = state.emittedVolume[n] / boundedVolume(regionOf(planFor(scene, n, scene.settings.time.start, state)), scene.settings.cell);
        packing = std::max(packing, own);
    }
    return packing > 0.0 ? packing : 1.0;
}

bool emits(const Scene& scene, const State& state, double timeFrom, double timeTo)
{
    for (std::size_t source = 0; source < scene.sources.size(); ++source)
        for (const Emission& emission : scene.sources[source].emissions)
            if (gives(emission, state.emittedVolume[source], timeFrom, timeTo)) return true;
    return false;
}

void emitLiquid(const Scene& scene, State& state, double timeFrom, double timeTo, EmissionWorkspace& work)
{
    state.emittedVolume.resize(scene.sources.size(), 0.0);
    state.memory.sources.resize(scene.sources.size());
    prepare(scene, timeFrom, state, work);
    std::size_t number = 0;
    for (std::size_t source = 0; source < scene.sources.size(); ++source)
        for (const Emission& emission : scene.sources[source].emissions) {
            std::optional<MouthSize>& size = work.sizes[number++];
            if (!gives(emission, state.emittedVolume[source], timeFrom, timeTo)) continue;
            if (isInstant(emission) || emission.velocity.isZero(0.0)) fillUp(scene, source, emission, timeFrom, state);
            else Flow(scene, source, emission, timeFrom, timeTo, state).emit(size, work.inflows);
        }
}

void emitLiquid(const Scene& scene, State& state, double timeFrom, double timeTo)
{
    EmissionWorkspace work;
    emitLiquid(scene, state, timeFrom, timeTo, work);
}

}  // namespace sim

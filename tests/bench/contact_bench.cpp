#include "sim/fabric/contact/candidate_list.h"
#include "sim/fabric/contact/contact.h"
#include "tests/sim/fabric/contact/contact_scenes.h"

#include <benchmark/benchmark.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <ctime>

// Contact of the woven sheet in steps of 1e-3 s with two Newton iterations each, its motion prescribed. Hit: a ball of radius 1.44 goes
// through the sheet at 300 cm/s; below and around it the wanted moves follow it, elsewhere they shiver. Counters: cpu_ms, time of
// all threads in contact, per step; search_ms and contact_ms, wall time of its two stages, per step. Argument: threads.

namespace sim::test {
namespace {

constexpr double kStep = 1.0e-3, kBall = 1.44, kSpeed = 300.0, kRadius = 0.048;

double noise(int v, int step, int axis) { return std::sin(12.9898 * v + 78.233 * step + 37.719 * axis); }

/// The sheet, hit: where it was at the start of a step, and where a solver without contact would want it.
struct Driven {
    Fabric fabric = wovenSheet(100);
    FabricContact contact{fabric};
    std::vector<Vec3> x = fabric.rest, v = std::vector<Vec3>(x.size(), Vec3::Zero()), u = v;
    Vec3 ball{0.144 * 99 / 2, 0.072 + kRadius + kBall + 0.05, 0.144 * 99 / 2};
    int steps = 0;
    LimitReport report;
    std::size_t active = 0;
    double cpuSeconds = 0.0;  ///< of all threads, in contact alone

    template <class F>
    void charge(F&& f)
    {
        const std::clock_t before = std::clock();
        f();
        cpuSeconds += static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    }

    bool isHit() const { return ball.y() < 3.0; }

    void move(StageClock& clock)
    {
        charge([&] {
            const FabricContact::LimitedMoves limited = contact.limit(x, u, report, clock);
            for (std::size_t i = 0; i < x.size(); ++i) x[i] += u[i];
            contact.moved(limited);
        });
    }

    /// What Newton would ask for: out of the ball, towards the neighbours' motion, and out of contact.
    void wish(const ActiveContacts& contacts)
    {
        for (Vec3& w : u) w.setZero();
        for (std::size_t c = 0; c < contacts.size(); ++c)
            for (int a = 0; a < 4; ++a) {
                const int i = contacts.vertices[c][a];
                u[i] -= contacts.weights[c][a] * 0.2 / contacts.stiffness[c] * contacts.force[c];
            }
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Vec3 d = x[i] - ball;
            const double gap = d.norm() - kBall - kRadius;
            if (gap < 0.0) u[i] -= gap * d.normalized();
            for (int k = 0; k < 3; ++k) u[i][k] += 0.002 * noise(static_cast<int>(i), steps, k);
            if (fabric.pinned[i]) u[i].setZero();
        }
    }

    void step(bool hit, StageClock& clock)
    {
        const std::vector<Vec3> start = x;
        if (hit) ball.y() -= kSpeed * kStep;
        charge([&] { contact.beginStep(x, fabric.mass, kStep, kStep); });
        for (std::size_t i = 0; i < x.size(); ++i) u[i] = fabric.pinned[i] ? Vec3::Zero().eval() : Vec3(kStep * v[i]);
        move(clock);
        for (int newton = 0; newton < 2; ++newton) {
            const ActiveContacts* contacts = nullptr;
            charge([&] { contacts = &contact.activeAt(x, clock).pairs(); });
            active = contacts->size();
            clock.stop();
            wish(*contacts);
            move(clock);
        }
        clock.stop();
        for (std::size_t i = 0; i < x.size(); ++i) {  // as elastic yarns would: a deep funnel around the ball, damped
            const Vec3 d = fabric.rest[i] - Vec3(ball.x(), 0.0, ball.z());
            const double share = std::exp(-d.squaredNorm() / 8.0);
            v[i] = 0.9 * (x[i] - start[i]) / kStep;
            if (hit) v[i] = 0.5 * v[i] - 0.5 * Vec3(0.0, kSpeed * share, 0.0);
            if (fabric.pinned[i]) v[i].setZero();
        }
        ++steps;
    }
};

void sheet(benchmark::State& state, bool hit)
{
    const int threads = static_cast<int>(state.range(0));
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute([&] {
        StageTimes times;
        LimitReport report;
        double cpu = 0.0, candidates = 0.0, active = 0.0, steps = 0.0, least = 1.0e9;
        constexpr int kSteps = 20;
        for (auto _ : state) {
            state.PauseTiming();
            Driven driven;
            state.ResumeTiming();
            StageClock clock(times);
            for (int s = 0; s < kSteps; ++s, ++steps) {
                driven.step(hit, clock);
                candidates += static_cast<double>(driven.contact.candidates());
                active += static_cast<double>(driven.active);
                least = std::min(least, driven.contact.leastDistance());
            }
            report = driven.report;
            cpu += driven.cpuSeconds;
        }
        const double scale = 1.0e3 / steps;
        state.counters["cpu_ms"] = 1.0e3 * cpu / steps;
        state.counters["search_ms"] = scale * times.stageSeconds[static_cast<int>(Stage::FabricCandidates)];
        state.counters["contact_ms"] = scale * times.stageSeconds[static_cast<int>(Stage::FabricContact)];
        state.counters["builds"] = static_cast<double>(report.candidateListBuilds) / kSteps;
        state.counters["blends"] = static_cast<double>(report.blends) / kSteps;
        state.counters["global_scalings"] = report.globalScalings;
        state.counters["candidates"] = candidates / steps;
        state.counters["active"] = active / steps;
        state.counters["least"] = least;
    });
}

void contactOfSheetHit(benchmark::State& state) { sheet(state, true); }
void contactOfSheetQuiet(benchmark::State& state) { sheet(state, false); }

/// One pass over the distances of all candidates; the counter is per pair.
void distances(benchmark::State& state)
{
    const Fabric fabric = wovenSheet(100);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    contact::CandidateList list(fabric);
    std::array<std::vector<Vec3>, 2> x = {fabric.rest, fabric.rest};
    for (Vec3& v : x[1]) v.y() *= 1.001;
    list.coverPositions(x[0]);
    double passes = 0.0;
    const std::clock_t before = std::clock();
    for (auto _ : state) {
        list.measure(x[static_cast<std::size_t>(passes) % 2]);
        passes += 1.0;
    }
    const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    state.counters["pairs"] = static_cast<double>(list.size());
    state.counters["ns_per_pair"] = 1.0e9 * seconds / (passes * static_cast<double>(list.size()));
}
BENCHMARK(distances)->Unit(benchmark::kMillisecond);

BENCHMARK(contactOfSheetHit)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(contactOfSheetQuiet)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace sim::test

BENCHMARK_MAIN();

#include "sim/simulation.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/scenes.h"
#include <cstdio>
#include <cstdlib>
using namespace sim; using namespace sim::test;
int main(int argc, char** argv)
{
    const int steps = argc > 1 ? atoi(argv[1]) : 50, threads = argc > 2 ? atoi(argv[2]) : 2, modes = argc > 3 ? atoi(argv[3]) : 8;
    const double dt = argc > 4 ? atof(argv[4]) : 2e-4; const int every = argc > 5 ? atoi(argv[5]) : steps;
    onThreads(threads, [&] {
        Scene scene = damBreakSmall(modes == 0 ? TransferMethod::Flip : modes == 1 ? TransferMethod::Pic : modes == 4 ? TransferMethod::Apic : TransferMethod::PolyPic, modes);
        scene.settings.time.dt = dt; if (argc > 6) { scene.settings.time.dt = 4e-3; scene.settings.time.mode = TimeMode::Cfl; }
        Simulation s(scene);
        std::printf("particles %zu E0 %.6g\n", s.state().liquid.count, s.energies().total());
        if (argc > 6) { while (s.state().time < atof(argv[6])) { auto r = s.step(std::min(atof(argv[6]), s.state().time + 4e-3)); if (s.state().step % 100 == 0) std::printf("t %.3f dt %.2e cfl %.2f it %d cells %zu blocks %zu tot %.5g part %zu gaps %d\n", s.state().time, r.dt, r.cfl, r.pressure.iterations, r.liquidCells, r.blocks, r.energies.total(), r.particles, (int)s.workspace().grid.hasGaps); } }
        std::vector<StepReport> reports;
        for (int n = 0; n < steps; ++n) {
            for (double until = s.state().time + dt; s.state().time < until;) reports.push_back(s.step(until));
            if ((n + 1) % every == 0) {
                const auto& r = reports.back();
                std::vector<double> total;
                std::printf("step %ld t %.4f cfl %.3f it %d cells %zu blocks %zu particles %zu max %.1f K %.4g M %.4g P %.6g tot %.6g\n", (long)s.state().step, s.state().time, r.cfl, r.pressure.iterations, r.liquidCells, r.blocks, r.particles, r.maxSpeed, r.energies.kinetic, r.energies.modal, r.energies.potential, r.energies.total());
                for (int st = 0; st < kStages; ++st) { std::vector<double> v; for (auto& q : reports) v.push_back(q.stageSeconds[st]); std::sort(v.begin(), v.end()); std::printf("  %s %.2f", kStageNames[st].data(), 1e3 * v[v.size() / 2]); }
                for (auto& q : reports) total.push_back(q.seconds()); std::sort(total.begin(), total.end());
                std::printf("\n  total median %.2f ms min %.2f\n", 1e3 * total[total.size() / 2], 1e3 * total[0]);
                std::fflush(stdout); reports.clear();
            }
        }
        std::printf("hash %016lx\n", stateHash(s.state()));
        return 0;
    });
}

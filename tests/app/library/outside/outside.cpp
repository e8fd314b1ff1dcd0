// Runs a scene and tells the hash of its last state. It uses the same libraries of templates as Drench does, by its own options.
// usage: outside SCENE FRAMES SECONDS_PER_FRAME
#include <drench/simulation.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <cstdio>
#include <cstdlib>
#include <vector>

/// Turns and solves: what Drench does as well, with the memory and the arithmetic of these options.
double ownWork()
{
    std::vector<Eigen::VectorXd> kept;
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    double sum = 0.0;
    for (int n = 1; n < 20; ++n) {
        const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n) + 0.1 * Eigen::MatrixXd::Ones(n, n);
        kept.push_back(a.ldlt().solve(Eigen::VectorXd::Ones(n)));
        place = Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(0.1 * n, Eigen::Vector3d(1, 2, 2) / 3.0) * place;
        sum += kept.back().sum() + (place * Eigen::Vector3d(0.1, 0.2, 0.3)).norm();
    }
    return sum;
}

int main(int, char** arguments)
{
    drench::Simulation simulation(drench::Scene::load(arguments[1]));
    double own = ownWork();
    for (int n = 1; n <= std::atoi(arguments[2]); ++n) {
        simulation.advanceTo(n * std::atof(arguments[3]));
        own += ownWork();
    }
    for (const char* wrong : {"no_such_key", "time.dt"}) try {
            drench::Scene scene;
            scene.set(wrong, "-1 furlong");
            scene.check();
            return 1;
        } catch (const drench::InputError&) {
        }
    std::printf("%016llx\n", static_cast<unsigned long long>(simulation.stateHash()));
    return own > 0.0 ? 0 : 1;
}

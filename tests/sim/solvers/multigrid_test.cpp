#include "tests/sim/solvers/poisson_laws.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// M applied to a vector of the unknowns.
class Preconditioner {
 public:
    explicit Preconditioner(const PoissonScene& scene) : scene_(scene) { multigrid_.build(scene.grid, scene.matrix); }

    std::vector<double> operator()(const std::vector<double>& v)
    {
        BlockArray<float>& r = multigrid_.rightHandSide();
        std::copy(v.begin(), v.end(), r.block(0));
        dot = multigrid_.cycle();
        const float* x = multigrid_.solution().block(0);
        return {x, x + v.size()};
    }
    double dot = 0.0;

    /// Random numbers at the unknowns, 0 elsewhere.
    std::vector<double> randomVector(std::mt19937& random) const
    {
        std::vector<double> v(scene_.grid.count() * std::size_t{kBlockCells}, 0.0);
        for (int b = 0; b < scene_.grid.count(); ++b)
            for (int c = 0; c < kBlockCells; ++c)
                if (scene_.isUnknown(b, c)) v[b * kBlockCells + c] = static_cast<float>(std::uniform_real_distribution(-1.0, 1.0)(random));
        return v;
    }

 private:
    const PoissonScene& scene_;
    Multigrid multigrid_;
};

double dot(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

std::vector<PoissonScene> scenes()
{
    std::mt19937 random(5);
    return {boxWithSurface({40, 30, 20}), fullBox({20, 20, 20}), poolWithWaves(60), randomScene(random, {30, 30, 30}, {-11, 0, 5}, 0.6),
            randomScene(random, {30, 30, 30}, {-11, 0, 5}, 0.95)};
}

TEST(Multigrid, IsSymmetric)
{
    std::mt19937 random(6);
    for (const PoissonScene& scene : scenes()) {
        Preconditioner m(scene);
        const std::vector<double> x = m.randomVector(random), y = m.randomVector(random);
        const std::vector<double> mx = m(x), my = m(y);
        EXPECT_NEAR(dot(x, my), dot(y, mx), 2.0e-6 * std::sqrt(dot(x, x) * dot(my, my)));
    }
}

TEST(Multigrid, IsPositiveDefinite)
{
    std::mt19937 random(7);
    for (const PoissonScene& scene : scenes()) {
        Preconditioner m(scene);
        for (int repeat = 0; repeat < 5; ++repeat) {
            const std::vector<double> x = m.randomVector(random);
            EXPECT_GT(dot(x, m(x)), 0.0);
            EXPECT_NEAR(m.dot, dot(x, m(x)), 1.0e-6 * m.dot);
        }
    }
}

TEST(Multigrid, LargestEigenvalueOfPreconditionedMatrixStaysBelowTwo)
{
    std::mt19937 random(8);
    for (const PoissonScene& scene : scenes()) {
        Preconditioner m(scene);
        std::vector<double> x = m.randomVector(random);
        double largest = 0.0;
        for (int n = 0; n < 30; ++n) {
            BlockArray<double> p = zeroPressure(scene);
            std::copy(x.begin(), x.end(), p.block(0));
            std::vector<double> ax(x.size(), 0.0);
            scene.forEachCell([&](const Vec3i& cell, int b, int c) {
                if (scene.isUnknown(b, c)) ax[b * kBlockCells + c] = matrixTimes(scene, p, cell);
            });
            const double energy = dot(x, ax);
            x = m(ax);
            largest = dot(ax, x) / energy;
            const double size = std::sqrt(dot(x, x));
            for (double& v : x) v /= size;
        }
        EXPECT_GT(largest, 0.9);
        EXPECT_LT(largest, 1.9);
    }
}

}  // namespace
}  // namespace sim::test

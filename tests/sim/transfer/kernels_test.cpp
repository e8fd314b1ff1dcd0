#include "sim/transfer/gather.h"
#include "sim/transfer/reference.h"
#include "sim/transfer/scatter.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

using namespace sim;
using namespace sim::test;

namespace {

/// Largest difference of two fields relative to the largest value.
template <class A>
double relativeDifference(const A& a, const A& b, std::size_t n)
{
    double largest = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        largest = std::max(largest, std::abs(b[i]));
        difference = std::max(difference, std::abs(a[i] - b[i]));
    }
    return difference / largest;
}

}  // namespace

class FastKernels : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Modes, FastKernels, ::testing::Values(1, 4, 6, 8, 10, 11, 15, 27));

TEST_P(FastKernels, ScatterAgreesWithReference)
{
    const SortedLiquid liquid = randomLiquid(20000, GetParam());
    FaceFields fast, plain;
    ScatterScratch scratch;
    particlesToFaces({liquid.particles, liquid.order, liquid.grid}, scratch, fast);
    particlesToFacesReference({liquid.particles, liquid.order, liquid.grid}, plain);
    EXPECT_LT(relativeDifference(fast.sums.block(0), plain.sums.block(0), plain.sums.size()), 1e-12);
}

TEST_P(FastKernels, GatherAgreesWithReference)
{
    SortedLiquid fast = randomLiquid(20000, GetParam());
    FaceFields faces;
    fillRandomVelocities(fast.grid, faces);
    LiquidParticles plain = fast.particles;
    facesToParticlesReference(faces, fast.grid, GetParam(), plain);
    GatherScratch scratch;
    GatherSettings settings;
    settings.modes = GetParam();
    facesToParticles(faces, fast.order, fast.grid, settings, scratch, fast.particles);
    for (int axis = 0; axis < kAxes; ++axis)
        for (int r = 0; r < plain.modeCount; ++r) {
            SCOPED_TRACE(r);
            double largest = 0.0, difference = 0.0;
            for (std::size_t p = 0; p < plain.count; ++p) {
                largest = std::max(largest, std::abs(plain.mode(axis, r)[p]));
                difference = std::max(difference, std::abs(plain.mode(axis, r)[p] - fast.particles.mode(axis, r)[p]));
            }
            if (r >= GetParam() && largest == 0.0) EXPECT_EQ(difference, 0.0);
            else EXPECT_LT(difference, 1e-12 * largest);
        }
}

TEST_P(FastKernels, GatherMovesParticlesWithTheirMeanVelocity)
{
    SortedLiquid liquid = randomLiquid(5000, GetParam());
    const LiquidParticles before = liquid.particles;
    FaceFields faces;
    fillRandomVelocities(liquid.grid, faces);
    GatherScratch scratch;
    GatherSettings settings;
    settings.modes = GetParam();
    settings.dt = 0.01;
    facesToParticles(faces, liquid.order, liquid.grid, settings, scratch, liquid.particles);
    for (std::size_t p = 0; p < before.count; ++p)
        EXPECT_LT((liquid.particles.position(p) - before.position(p) - settings.dt * liquid.particles.velocity(p)).norm(), 1e-14);
}

TEST_P(FastKernels, SameBitsForAnyThreadCount)
{
    const auto roundTrip = [&](int threads) {
        return onThreads(threads, [&] {
            SortedLiquid liquid = randomLiquid(20000, GetParam());
            FaceFields faces;
            ScatterScratch scatterScratch;
            GatherScratch gatherScratch;
            GatherSettings settings;
            settings.modes = GetParam();
            settings.dt = 0.02;
            fillRandomVelocities(liquid.grid, faces);
            particlesToFaces({liquid.particles, liquid.order, liquid.grid}, scatterScratch, faces);
            const double sum = facesToParticles(faces, liquid.order, liquid.grid, settings, gatherScratch, liquid.particles).kinetic;
            std::vector<double> all(faces.sums.block(0), faces.sums.block(0) + faces.sums.size());
            all.insert(all.end(), liquid.particles.x[0].begin(), liquid.particles.x[0].end());
            all.push_back(sum);
            return all;
        });
    };
    const auto one = roundTrip(1);
    for (int threads : {2, 3, 8}) EXPECT_EQ(roundTrip(threads), one) << threads << " threads";
}

TEST(FastKernels, UsesEightThreads)
{
#ifdef __SANITIZE_THREAD__
    const int expected = kPlainThreads;  // of the thread sanitizer's build, however many are asked for
#else
    const int expected = 8;
#endif
    EXPECT_EQ(onThreads(8, [] { return workerCount(); }), expected);
}

#include "sim/particles/velocity_modes.h"

#include <gtest/gtest.h>

#include <random>

using namespace sim;

namespace {

Basis basisAt(const Vec3& offset) { return {Basis1D(offset.x()), Basis1D(offset.y()), Basis1D(offset.z())}; }

template <class F>
void forEachNode(F&& f)
{
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) f(i, j, k);
}

/// 1-D factor of degree d at node n of the orthogonal basis: 1, z, z² − A z − 1/4.
double orthogonalFactor(const Basis1D& basis, int n, int d)
{
    const double z = basis.z[n];
    return d == 0 ? 1.0 : d == 1 ? z : z * z - basis.skew * z - 0.25;
}

class RandomOffsets {
 public:
    Vec3 next() { return {unit_(random_), unit_(random_), unit_(random_)}; }

 private:
    std::mt19937 random_{1};
    std::uniform_real_distribution<double> unit_{-0.5, 0.5};
};

}  // namespace

// Moments of the quadratic spline about the particle, exact for every offset (transfer/README.md, B-splines).
TEST(Spline, MomentsAreExact)
{
    RandomOffsets offsets;
    for (int trial = 0; trial < 1000; ++trial) {
        const double r = offsets.next().x();
        const Basis1D basis(r);
        double moment[5] = {};
        for (int n = 0; n < 3; ++n)
            for (int k = 0; k < 5; ++k) moment[k] += basis.weight[n] * std::pow(basis.z[n], k);
        EXPECT_NEAR(moment[0], 1.0, 1e-13);
        EXPECT_NEAR(moment[1], 0.0, 1e-13);
        EXPECT_NEAR(moment[2], 0.25, 1e-13);
        EXPECT_NEAR(moment[3], r * (1.0 - 4.0 * r * r) / 4.0, 1e-13);
        EXPECT_NEAR(moment[4], 0.25 - 1.5 * r * r + 3.0 * r * r * r * r, 1e-13);
    }
}

// The 27 products are orthogonal under the weights, and the quadratic coefficient is half the second difference.
TEST(PolyPicModes, BasisIsMassOrthogonal)
{
    RandomOffsets offsets;
    for (int trial = 0; trial < 50; ++trial) {
        const Basis basis = basisAt(offsets.next());
        std::array<std::array<double, kMaxModes>, kMaxModes> gram{};
        forEachNode([&](int i, int j, int k) {
            std::array<double, kMaxModes> s;
            for (int r = 0; r < kMaxModes; ++r)
                s[r] = orthogonalFactor(basis[0], i, kDegrees[r][0]) * orthogonalFactor(basis[1], j, kDegrees[r][1]) *
                       orthogonalFactor(basis[2], k, kDegrees[r][2]);
            const double w = basis[0].weight[i] * basis[1].weight[j] * basis[2].weight[k];
            for (int r = 0; r < kMaxModes; ++r)
                for (int q = 0; q < kMaxModes; ++q) gram[r][q] += w * s[r] * s[q];
        });
        for (int r = 0; r < kMaxModes; ++r)
            for (int q = 0; q < r; ++q) EXPECT_LT(std::abs(gram[r][q]), 1e-12 * std::sqrt(gram[r][r] * gram[q][q]) + 1e-16);
    }
}

TEST(PolyPicModes, QuadraticCoefficientIsTheSecondDifference)
{
    RandomOffsets offsets;
    const Basis basis = basisAt(offsets.next());
    const double row[3] = {1.7, -0.4, 3.1};
    Modes c{};
    forEachNode([&](int i, int j, int k) { projectOntoModes(basis, {i, j, k}, row[i], kMaxModes, c); });
    EXPECT_NEAR(c[8], 0.5 * (row[0] - 2.0 * row[1] + row[2]), 1e-12);
}

// One particle, any 27 values: 27 modes lose nothing.
TEST(PolyPicModes, TwentySevenModesReproduceAnyStencil)
{
    RandomOffsets offsets;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int trial = 0; trial < 100; ++trial) {
        const Basis basis = basisAt(offsets.next());
        double value[3][3][3];
        Modes c{};
        forEachNode([&](int i, int j, int k) {
            value[i][j][k] = unit(random);
            projectOntoModes(basis, {i, j, k}, value[i][j][k], kMaxModes, c);
        });
        const Modes monomial = toMonomials(basis, c);
        forEachNode([&](int i, int j, int k) { EXPECT_NEAR(evaluateModes(basis, {i, j, k}, monomial), value[i][j][k], 1e-12); });
    }
}

TEST(PolyPicModes, MonomialsAndOrthogonalCoefficientsAreInverse)
{
    RandomOffsets offsets;
    const Basis basis = basisAt(offsets.next());
    Modes c;
    for (int r = 0; r < kMaxModes; ++r) c[r] = std::sin(1.0 + r);
    const Modes back = toOrthogonal(basis, toMonomials(basis, c));
    for (int r = 0; r < kMaxModes; ++r) EXPECT_NEAR(back[r], c[r], 1e-14);
}

// The weighted mean of the polynomial is the orthogonal mean, at whatever offset it is read (transfer/README.md, Modes).
TEST(PolyPicModes, MeanOfMonomialsIsTheOrthogonalMean)
{
    RandomOffsets offsets;
    const Basis basis = basisAt(offsets.next());
    Modes c;
    for (int r = 0; r < kMaxModes; ++r) c[r] = std::cos(2.0 + r);
    const Modes monomial = toMonomials(basis, c);
    double mean = 0.0;
    for (int r = 0; r < kMaxModes; ++r) mean += kMeanOfMode[r] * monomial[r];
    EXPECT_NEAR(mean, c[0], 1e-14);
}

// Golden data, computed by an independent program (h = 0.288, offset (0.3, −0.2, 0.1)).
TEST(PolyPicModes, GoldenGather)
{
    const double h = 0.288;
    const Basis basis = basisAt({0.3, -0.2, 0.1});
    Modes c{};
    double value[3][3][3];
    forEachNode([&](int a, int b, int d) {
        const double i = a - 1, j = b - 1, k = d - 1;
        value[a][b][d] =
            1 + 2 * i - 3 * j + 4 * k + 5 * i * j - 6 * i * k + 7 * j * k - 8 * i * j * k + 9 * i * i - 10 * j * j + 11 * k * k + 12 * i * i * j;
        projectOntoModes(basis, {a, b, d}, value[a][b][d], kMaxModes, c);
    });
    EXPECT_NEAR(h * basis[0].skew, 0.055296, 1e-12);
    EXPECT_NEAR(h * basis[1].skew, -0.048384, 1e-12);
    EXPECT_NEAR(h * basis[2].skew, 0.027648, 1e-12);
    EXPECT_NEAR(basis[0].weight[0], 0.02, 1e-14);
    EXPECT_NEAR(basis[1].weight[1], 0.71, 1e-14);
    EXPECT_NEAR(basis[2].weight[2], 0.18, 1e-14);
    const double golden[] = {4.232,         20.0944444444, 30.2777777778, 15.75,          165.219907407, -53.0478395062,
                             55.4591049383, -334.89797668, 79.5717592593, -120.563271605, 132.619598765};
    const double scale[] = {1, h, h, h, h * h, h * h, h * h, h * h * h, h * h, h * h, h * h};
    for (int r = 0; r < 11; ++r) EXPECT_NEAR(c[r] / scale[r], golden[r], 1e-8) << "mode " << r;
    EXPECT_NEAR(c[15] / (h * h * h), 502.346965021, 1e-6);
    for (int r : {11, 12, 13, 14, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26}) EXPECT_NEAR(c[r], 0.0, 1e-10) << "mode " << r;

    const double atMiddle[] = {4.232, 3.78624, 2.692, 1.0}, atCorner[] = {4.232, 22.82944, 30.4888, 24.0};
    const int modes[] = {1, 4, 8, 27};
    for (int n = 0; n < 4; ++n) {
        Modes truncated = c;
        std::fill(truncated.begin() + modes[n], truncated.end(), 0.0);
        const Modes monomial = toMonomials(basis, truncated);
        EXPECT_NEAR(evaluateModes(basis, {1, 1, 1}, monomial), atMiddle[n], 1e-10);
        EXPECT_NEAR(evaluateModes(basis, {2, 2, 2}, monomial), atCorner[n], 1e-10);
    }
}

// What the transfers reproduce, and how much they damp what they do not (transfer/README.md, Conservation).
#include "sim/core/units.h"
#include "tests/sim/transfer/transfers.h"

#include <gtest/gtest.h>

#include <map>

using namespace sim;
using namespace sim::test;

namespace {

constexpr double kCell = 0.288;

/// 80 particles in 5³ cells, which is where the fields below are of order 1.
Transfers fewParticles(int modes) { return Transfers(randomLiquid(80, modes, {5, 5, 5}, {-2, 6, 3}, kCell)); }

/// Place relative to the middle of the particles' box, in cells.
Vec3 inBox(const BlockGrid& grid, const Vec3& x) { return (x - grid.origin) / grid.dx - Vec3(0.5, 8.5, 5.5); }

/// Largest error of G2P → P2G at fixed positions, relative to the largest velocity.
template <class F>
double roundTripError(int modes, F&& field)
{
    Transfers t = fewParticles(modes);
    double largest = 0.0;
    t.setVelocities([&](int axis, int b, int c) {
        const double u = field(axis, inBox(t.grid(), faceMiddle(t.grid(), axis, b, c)));
        largest = std::max(largest, std::abs(u));
        return u;
    });
    t.toParticles(modes);
    t.liquid.sort();
    t.toFaces();
    return t.largestError([&](int axis, const Vec3& x) { return field(axis, inBox(t.grid(), x)); }) / largest;
}

double constant(int axis, const Vec3&) { return 1.0 - 0.7 * axis; }
double linear(int axis, const Vec3& z) { return constant(axis, z) + 0.3 * z.x() - (0.2 + 0.1 * axis) * z.y() + 0.15 * z.z(); }
double trilinear(int axis, const Vec3& z)
{
    return linear(axis, z) + 0.1 * z.x() * z.y() - 0.07 * (1 + axis) * z.x() * z.z() + 0.12 * z.y() * z.z() - 0.05 * z.prod();
}
double squares(int axis, const Vec3& z) { return trilinear(axis, z) + 0.1 * z.x() * z.x() - 0.2 * z.y() * z.y() + 0.15 * (1 - axis) * z.z() * z.z(); }
/// As good as random, and the same for every call.
double anything(int axis, const Vec3& z) { return std::sin(1000.0 * (1 + axis) + 12.9898 * z.x() + 78.233 * z.y() + 37.719 * z.z()); }

}  // namespace

// Law 3.
TEST(RoundTrip, IsExactOnWhatTheModesSpan)
{
    EXPECT_LT(roundTripError(1, constant), 1e-11);
    EXPECT_LT(roundTripError(4, linear), 1e-11);
    EXPECT_LT(roundTripError(8, trilinear), 1e-11);
    EXPECT_LT(roundTripError(11, squares), 1e-11);
    EXPECT_LT(roundTripError(27, anything), 1e-11);
}

TEST(RoundTrip, IsNotExactBeyond)
{
    EXPECT_GT(roundTripError(1, linear), 1e-3);
    EXPECT_GT(roundTripError(4, trilinear), 1e-3);
    EXPECT_GT(roundTripError(8, squares), 1e-3);
    EXPECT_GT(roundTripError(11, anything), 1e-3);
}

namespace {

/// APIC as published (Jiang et al. 2015), on a map of faces, sharing nothing with the code under test but particles and
/// cells.
class PlainApic {
 public:
    struct Particle {
        Vec3 x, v;
        Mat3 gradient;  ///< rows: components [1/s]
        double mass;
    };
    PlainApic(double dx, const Vec3& origin) : dx_(dx), origin_(origin) {}

    std::vector<Particle> particles;

    void toFaces()
    {
        faces_.clear();
        for (const Particle& p : particles)
            forEachFace(p.x, [&](int axis, Face& face, double w, const Vec3& z) {
                face.mass += w * p.mass;
                face.momentum += w * p.mass * (p.v[axis] + p.gradient.row(axis).dot(z));
            });
    }
    void toParticles(double dt)
    {
        for (Particle& p : particles) {
            p.v.setZero();
            p.gradient.setZero();
            forEachFace(p.x, [&](int axis, Face& face, double w, const Vec3& z) {
                const double u = face.momentum / face.mass;
                p.v[axis] += w * u;
                p.gradient.row(axis) += 4.0 / (dx_ * dx_) * w * u * z.transpose();
            });
            p.x += dt * p.v;
        }
    }

 private:
    struct Face {
        double mass = 0.0, momentum = 0.0;
    };
    static double spline(double d)
    {
        d = std::abs(d);
        return d < 0.5 ? 0.75 - d * d : d < 1.5 ? 0.5 * (1.5 - d) * (1.5 - d) : 0.0;
    }
    /// Call f(axis, face, weight, face − particle) for the faces in reach.
    template <class F>
    void forEachFace(const Vec3& x, F&& f)
    {
        for (int axis = 0; axis < kAxes; ++axis) {
            const Vec3 shift = 0.5 * (Vec3::Ones() - unitVector(axis));
            const Vec3 q = (x - origin_) / dx_ - shift;
            const Vec3i nearest = (q.array() + 0.5).floor().cast<int>();
            for (int n = 0; n < 27; ++n) {
                const Vec3i i = nearest + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
                const Vec3 z = i.cast<double>() - q;
                f(axis, faces_[{axis, i.x(), i.y(), i.z()}], spline(z.x()) * spline(z.y()) * spline(z.z()), dx_ * z);
            }
        }
    }
    double dx_;
    Vec3 origin_;
    std::map<std::array<int, 4>, Face> faces_;
};

}  // namespace

// Law 5.
TEST(FourModes, AreApic)
{
    const double dt = 0.05;
    Transfers t(randomLiquid(500, 4));
    PlainApic apic(t.grid().dx, t.grid().origin);
    t.liquid.moveModesHome();
    LiquidParticles& p = t.liquid.particles;
    apic.particles.resize(p.count);
    for (std::size_t s = 0; s < p.count; ++s) {
        PlainApic::Particle& q = apic.particles[p.id[s]];
        q = {p.position(s), p.velocity(s), Mat3::Zero(), p.mass[s]};
        for (int a = 0; a < kAxes; ++a)
            for (int b = 0; b < kAxes; ++b) q.gradient(a, b) = p.mode(a, 1 + b)[s] / t.grid().dx;
    }
    for (int step = 0; step < 5; ++step) {
        t.liquid.sort();
        t.toFaces();
        t.toParticles(4, dt);
        apic.toFaces();
        apic.toParticles(dt);
    }
    for (std::size_t s = 0; s < p.count; ++s) {
        const PlainApic::Particle& q = apic.particles[p.id[s]];
        EXPECT_LT((p.position(s) - q.x).norm(), 1e-12);
        EXPECT_LT((p.velocity(s) - q.v).norm(), 1e-12);
        for (int a = 0; a < kAxes; ++a)
            for (int b = 0; b < kAxes; ++b) EXPECT_NEAR(p.mode(a, 1 + b)[s], t.grid().dx * q.gradient(a, b), 1e-12);
    }
}

namespace {

/// Energy on the faces after 4 transfers to and fro without motion, relative to before; u_a = sin(k x_{a+1} + a) cos(k
/// x_{a+2}) of wavelength 6 cells, once filtered by 8 modes, on 400 particles in the 5³ cells from the origin. Lengths
/// and velocities are in units of `unit` cm.
double energyKept(int modes, unsigned seed, double unit = 1.0)
{
    SortedLiquid liquid;
    liquid.grid.dx = kCell / unit;
    liquid.particles.modeCount = 8;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.0, 5.0);
    for (std::uint32_t p = 0; p < 400; ++p) {
        Vec3 x;
        for (int a = 0; a < kAxes; ++a) x[a] = liquid.grid.dx * place(random);
        liquid.particles.add(x, 1.0, p, Vec3::Zero());
    }
    liquid.sort();
    const auto transfer = [](Transfers& t, int n) {
        const int stored = storedModes(n);
        LiquidParticles fresh;
        fresh.modeCount = stored;
        const LiquidParticles& p = t.liquid.particles;
        for (std::size_t s = 0; s < p.count; ++s) fresh.add(p.position(s), p.mass[s], p.id[s], Vec3::Zero());
        t.liquid.particles = fresh;
        t.liquid.sort();
        t.toParticles(n);
        t.liquid.sort();
        t.toFaces();
    };
    Transfers t(std::move(liquid));
    const double k = 2.0 * kPi / (6.0 * t.grid().dx);
    t.toFaces();
    t.setVelocities([&](int axis, int b, int c) {
        const Vec3 x = faceMiddle(t.grid(), axis, b, c);
        return 100.0 / unit * std::sin(k * x[(axis + 1) % 3] + axis) * std::cos(k * x[(axis + 2) % 3]);
    });
    transfer(t, 8);
    const double before = t.faceEnergy();
    for (int cycle = 0; cycle < 4; ++cycle) transfer(t, modes);
    return t.faceEnergy() / before;
}

double meanEnergyKept(int modes)
{
    constexpr int kTrials = 20;
    double sum = 0.0;
    for (unsigned seed = 1; seed <= kTrials; ++seed) sum += energyKept(modes, seed);
    return sum / kTrials;
}

}  // namespace

// Law 5: energy after four transfers.
TEST(Damping, OfAWaveIsThePublishedOne)
{
    EXPECT_NEAR(meanEnergyKept(1), 0.062, 0.01);
    EXPECT_NEAR(meanEnergyKept(4), 0.559, 0.01);
    EXPECT_NEAR(meanEnergyKept(8), 0.791, 0.01);
    EXPECT_NEAR(energyKept(27, 1), 1.0, 1e-10);
}

TEST(Damping, DoesNotDependOnTheUnitOfLength)
{
    for (int modes : {1, 4, 8, 11, 27}) EXPECT_NEAR(energyKept(modes, 1, 100.0), energyKept(modes, 1), 1e-12) << modes << " modes";
}

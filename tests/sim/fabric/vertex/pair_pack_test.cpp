#include "sim/fabric/vertex/pair_pack.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

using testing::Noise;

/// Pairs at random, of one kind, with and without friction.
ActiveContacts randomPairs(Noise& random, int firstSide, std::size_t count)
{
    ActiveContacts c;
    for (std::size_t i = 0; i < count; ++i) {
        const int first = 4 * static_cast<int>(i);
        const double s = 0.5 + 0.5 * random(), t = 0.5 + 0.5 * random();
        c.vertices.push_back({first, first + 1, first + 2, first + 3});
        c.firstSide.push_back(static_cast<std::uint8_t>(firstSide));
        c.weights.push_back(firstSide == 2 ? std::array{1.0 - s, s, t - 1.0, -t} : std::array{1.0, 0.5 * s + 0.5 * t - 1.0, -0.5 * s, -0.5 * t});
        c.normal.push_back(random.vector().normalized());
        c.stiffness.push_back(std::exp(3.0 * random()));
        c.frictionStiffness.push_back(i % 3 == 0 ? 0.0 : std::exp(3.0 * random()));
        ActiveContacts::Lever lever;
        for (auto& direction : lever)
            for (Vec3& of : direction) of = 0.3 * random.vector();
        c.lever.push_back(lever);
    }
    return c;
}

struct Loaded {
    std::array<PackVec3, 4> p;
    std::vector<Vec3> moves;
};

Loaded randomMoves(Noise& random, std::size_t count)
{
    Loaded loaded;
    for (std::size_t v = 0; v < 4 * count; ++v) loaded.moves.push_back(random.vector());
    for (int k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < count; ++l) setLane(loaded.p[k], static_cast<int>(l), loaded.moves[4 * l + k]);
    return loaded;
}

std::array<PackVec3, 4> times(const PairPack& pack, int firstSide, const std::array<PackVec3, 4>& p)
{
    return firstSide == 2 ? pack.times<2>(p) : pack.times<1>(p);
}

PairPack packOf(const ActiveContacts& contacts, float coupled)
{
    PairPack pack = {};
    for (std::size_t i = 0; i < contacts.size(); ++i) pack.set(i, contacts, i);
    for (auto& side : pack.isCoupled) side.fill(coupled);
    return pack;
}

/// What eight pairs do to moves is Bᵀ H B of each, to the rounding of floats, and has no sum, to that of doubles; nor do moves that all share do any.
TEST(PairPack, IsTheMatrixOfItsPairs)
{
    Noise random(11);
    for (int round = 0; round < 50; ++round)
        for (const int firstSide : {2, 1}) {
            const ActiveContacts contacts = randomPairs(random, firstSide, kLanes);
            const Loaded loaded = randomMoves(random, kLanes);
            const std::array<PackVec3, 4> force = times(packOf(contacts, 1.0f), firstSide, loaded.p);
            for (int l = 0; l < kLanes; ++l) {
                const Vec3 n = contacts.normal[l], slip = contacts.slip(l, [&](int v) { return loaded.moves[v]; }), along = n.dot(slip) * n;
                const std::array<Vec3, 4> expected =
                    contacts.forcesOnVertices(l, contacts.stiffness[l] * along + contacts.frictionStiffness[l] * (slip - along));
                Vec3 sum = Vec3::Zero();
                double size = 0.0;  // of the forces, if what cancels in them did not
                for (int k = 0; k < 4; ++k) size += (contacts.stiffness[l] + contacts.frictionStiffness[l]) * loaded.moves[4 * l + k].norm();
                for (int k = 0; k < 4; ++k) {
                    EXPECT_LT((laneOf(force[k], l) - expected[k]).norm(), 1.0e-6 * size);
                    sum += laneOf(force[k], l);
                }
                EXPECT_LT(sum.norm(), 1.0e-14 * size);
            }
        }
}

/// What the strands' matrix has of a side, and what the packs leave out for it, are the same to the rounding of doubles.
TEST(PairPack, LeavesOutWhatTheBlocksOfItsSidesAre)
{
    Noise random(12);
    for (int round = 0; round < 50; ++round) {
        const ActiveContacts contacts = randomPairs(random, 2, kLanes);
        const Loaded loaded = randomMoves(random, kLanes);
        const std::array<PackVec3, 4> all = times(packOf(contacts, 1.0f), 2, loaded.p), rest = times(packOf(contacts, 0.0f), 2, loaded.p);
        for (int l = 0; l < kLanes; ++l)
            for (int k = 0; k < 4; ++k) {
                const RoundedPair pair(contacts, l);
                const int other = k ^ 1;  // on the same edge
                const Vec3 own = pair.block(k, k).matrix() * loaded.moves[4 * l + k] + pair.block(k, other).matrix() * loaded.moves[4 * l + other];
                const Vec3 leftOut = laneOf(all[k], l) - laneOf(rest[k], l);
                EXPECT_LT((own - leftOut).norm(), 1.0e-13 * (laneOf(all[k], l).norm() + own.norm()));
            }
    }
}

}  // namespace
}  // namespace sim

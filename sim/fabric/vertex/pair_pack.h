#pragma once

#include "sim/fabric/contact/contact.h"
#include "sim/fabric/vec3t.h"
#include "sim/fabric/vertex/mat3_columns.h"

#include <array>
#include <cstring>

namespace sim {

/// Eight pairs of one kind as the solver of the Newton system reads them; lanes beyond the last are pairs that do nothing. Their matrices are
/// Bᵀ H B (ActiveContacts), H = k_n n nᵀ + k_t Σ t tᵀ with the tangents t, of numbers rounded to float but for the weights, which sum to zero.
struct PairPack {
    using Floats = std::array<float, kLanes>;
    static constexpr int kNone = -1;

    alignas(64) std::array<std::array<double, kLanes>, 4> weights;
    std::array<std::array<int, kLanes>, 4> vertices;
    std::array<std::array<int, kLanes>, 4> incidence;  ///< places where forces on the vertices go; kNone in lanes without a pair
    std::array<Floats, 3> normal;
    Floats stiffness, across;                                   ///< k_n and k_t [dyn/cm]
    std::array<Floats, 2> isCoupled;                            ///< 1 where a side acts on itself here, 0 where the strands' matrix has that
    std::array<std::array<std::array<Floats, 3>, 2>, 2> lever;  ///< ActiveContacts::lever, by its directions, tangents and components [-]
    bool hasLever;                                              ///< whether any of the pairs has friction

    /// Pair i of the contacts into a lane, but for isCoupled and incidence.
    void set(std::size_t lane, const ActiveContacts& contacts, std::size_t i)
    {
        const auto store = [&](std::array<Floats, 3>& to, const Vec3& v) {
            for (int a = 0; a < 3; ++a) to[a][lane] = static_cast<float>(v[a]);
        };
        for (int k = 0; k < 4; ++k) {
            weights[k][lane] = contacts.weights[i][k];
            vertices[k][lane] = contacts.vertices[i][k];
        }
        store(normal, contacts.normal[i]);
        stiffness[lane] = static_cast<float>(contacts.stiffness[i]);
        across[lane] = static_cast<float>(contacts.frictionStiffness[i]);
        if (!(contacts.frictionStiffness[i] > 0.0)) return;
        hasLever = true;
        for (int d = 0; d < 2; ++d)
            for (int j = 0; j < 2; ++j) store(lever[d][j], contacts.lever[i][d][j]);
    }

    static Pack widened(const Floats& v)
    {
        using Eight = float __attribute__((vector_size(32)));
        Eight eight;
        std::memcpy(&eight, v.data(), sizeof eight);
        return __builtin_convertvector(eight, Pack);
    }
    static PackVec3 widened(const std::array<Floats, 3>& v) { return {widened(v[0]), widened(v[1]), widened(v[2])}; }

    /// Bᵀ H B p of the vertices of each pair, but for what the strands' matrix has of it.
    template <int kFirstSide>
    std::array<PackVec3, 4> times(const std::array<PackVec3, 4>& p) const
    {
        constexpr auto kEnds = directionsOfPair(kFirstSide);
        constexpr std::array<int, 2> kSideOf = {kFirstSide == 2 ? 0 : 1, 1};  // side of each direction
        const PackVec3 n = widened(normal);
        const std::array<PackVec3, 2> t = tangentsOf(n);
        std::array<Pack, 4> weight;
        std::array<PackVec3, 2> side = {};
        for (int k = 0; k < 4; ++k) {
            weight[k] = loadPack(weights[k].data());
            side[k < kFirstSide ? 0 : 1] += weight[k] * p[k];
        }
        std::array<PackVec3, 2> slip;  // by sides, along n and both tangents
        for (int i = 0; i < 2; ++i) slip[i] = {dot(n, side[i]), dot(t[0], side[i]), dot(t[1], side[i])};
        if (hasLever)
            for (int d = 0; d < 2; ++d) {
                const PackVec3 turn = p[kEnds[d][1]] - p[kEnds[d][0]];
                for (int j = 0; j < 2; ++j) slip[kSideOf[d]][1 + j] -= dot(widened(lever[d][j]), turn);
            }
        const Pack pressing = widened(stiffness), holding = widened(across);
        std::array<PackVec3, 2> on;  // likewise
        for (int i = 0; i < 2; ++i) {
            const PackVec3 all = widened(isCoupled[i]) * slip[i] + slip[1 - i];
            on[i] = {pressing * all.x, holding * all.y, holding * all.z};
            side[i] = on[i].x * n + on[i].y * t[0] + on[i].z * t[1];
        }
        std::array<PackVec3, 4> force;
        for (int k = 0; k < 4; ++k) force[k] = weight[k] * side[k < kFirstSide ? 0 : 1];
        if (hasLever)
            for (int d = 0; d < 2; ++d) {
                const PackVec3 couple = on[kSideOf[d]].y * widened(lever[d][0]) + on[kSideOf[d]].z * widened(lever[d][1]);
                force[kEnds[d][0]] += couple;
                force[kEnds[d][1]] -= couple;
            }
        return force;
    }
};

/// A pair with the numbers of packs, and blocks of its matrix: with those of packs they sum to none where all vertices move alike.
class RoundedPair {
 public:
    RoundedPair(const ActiveContacts& contacts, std::size_t i)
        : contacts_(contacts),
          i_(i),
          stiffness_(static_cast<float>(contacts.stiffness[i])),
          across_(static_cast<float>(contacts.frictionStiffness[i])),
          normal_(rounded(contacts.normal[i]))
    {
        const std::array<Vec3T<double>, 2> t = tangentsOf(Vec3T<double>{normal_[0], normal_[1], normal_[2]});
        for (int j = 0; j < 2; ++j) tangent_[j] = HalfPack{t[j].x, t[j].y, t[j].z, 0.0};
    }
    /// Block of two of its vertices, by columns: those of the same side, or the same.
    Mat3Columns block(int k, int other) const
    {
        const double pressing = stiffness_ * contacts_.weights[i_][k] * contacts_.weights[i_][other];
        Mat3Columns sum;
        for (int a = 0; a < 3; ++a) sum.column[a] = (pressing * normal_[a]) * normal_;
        if (!(across_ > 0.0)) return sum;
        for (int j = 0; j < 2; ++j) {
            const HalfPack own = across_ * slipOf(k, j), its = other == k ? slipOf(k, j) : slipOf(other, j);
            for (int a = 0; a < 3; ++a) sum.column[a] += its[a] * own;
        }
        return sum;
    }

 private:
    static HalfPack rounded(const Vec3& v) { return HalfPack{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0.0}; }
    /// Derivative of the slip along a tangent by a vertex [-].
    HalfPack slipOf(int k, int j) const
    {
        const auto ends = directionsOfPair(contacts_.firstSide[i_]);
        HalfPack sum = contacts_.weights[i_][k] * tangent_[j];
        for (int d = 0; d < 2; ++d) {
            if (ends[d][0] == k) sum += rounded(contacts_.lever[i_][d][j]);
            if (ends[d][1] == k) sum -= rounded(contacts_.lever[i_][d][j]);
        }
        return sum;
    }

    const ActiveContacts& contacts_;
    std::size_t i_;
    double stiffness_, across_;  ///< k_n, k_t [dyn/cm]
    HalfPack normal_, tangent_[2];
};

}  // namespace sim

#include "sim/fabric/contact/box_tree.h"

#include "sim/core/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sim::contact {

namespace {

constexpr float kFar = 1.0e30f;
/// Boxes grow by so much of their coordinates: some roundings of single precision [-].
constexpr double kRounding = 5.0e-7;
constexpr SweptBox kNowhere = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}, {kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};

float below(double v) { return static_cast<float>(v - kRounding * std::abs(v)); }
float above(double v) { return static_cast<float>(v + kRounding * std::abs(v)); }

std::uint64_t spread(std::uint64_t v)  // bits 0, 1, 2 … to bits 0, 3, 6 …
{
    std::uint64_t r = 0;
    for (int b = 0; b < 21; ++b) r |= ((v >> b) & 1) << (3 * b);
    return r;
}

/// Morton code of a point within the box: points of near numbers are near each other.
std::uint64_t mortonCode(const Vec3& x, const Eigen::AlignedBox3d& box)
{
    const double scale = 2097151.0 / std::max(box.sizes().maxCoeff(), 1.0e-30);
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) code |= spread(static_cast<std::uint64_t>((x[k] - box.min()[k]) * scale)) << k;
    return code;
}

}  // namespace

void SweptBoxes::set(int lane, const SweptBox& box)
{
    for (std::size_t k = 0; k < 3; ++k) {
        lo[k][lane] = box.lo[k], hi[k][lane] = box.hi[k];
        moveLo[k][lane] = box.moveLo[k], moveHi[k][lane] = box.moveHi[k];
    }
}

SweptBox SweptBoxes::box(int lane) const
{
    SweptBox b;
    for (std::size_t k = 0; k < 3; ++k) {
        b.lo[k] = lo[k][lane], b.hi[k] = hi[k][lane];
        b.moveLo[k] = moveLo[k][lane], b.moveHi[k] = moveHi[k][lane];
    }
    return b;
}

SweptBox SweptBoxes::around(unsigned lanes) const
{
    SweptBox all = kNowhere;
    for (; lanes != 0; lanes &= lanes - 1) {
        const SweptBox b = box(std::countr_zero(lanes));
        for (std::size_t k = 0; k < 3; ++k) {
            all.lo[k] = std::min(all.lo[k], b.lo[k]), all.hi[k] = std::max(all.hi[k], b.hi[k]);
            all.moveLo[k] = std::min(all.moveLo[k], b.moveLo[k]), all.moveHi[k] = std::max(all.moveHi[k], b.moveHi[k]);
        }
    }
    return all;
}

BoxTree::BoxTree(std::vector<int> corners, int perPrimitive, std::span<const Vec3> rest, std::vector<double> reach)
    : perPrimitive_(perPrimitive), order_(reach.size())
{
    if (order_.empty()) return;
    std::iota(order_.begin(), order_.end(), 0);
    Eigen::AlignedBox3d box;
    std::vector<Vec3> middles(order_.size(), Vec3::Zero());
    for (std::size_t p = 0; p < middles.size(); ++p) {
        for (int c = 0; c < perPrimitive; ++c) middles[p] += rest[corners[perPrimitive * p + c]] / perPrimitive;
        box.extend(middles[p]);
    }
    std::vector<std::uint64_t> code(order_.size());
    for (std::size_t p = 0; p < code.size(); ++p) code[p] = mortonCode(middles[p], box);
    std::ranges::stable_sort(order_, {}, [&](int p) { return code[p]; });

    for (int p : order_) {
        for (int c = 0; c < perPrimitive; ++c) corners_.push_back(corners[perPrimitive * p + c]);
        reach_.push_back(reach[p]);
    }
    SweptBoxes nowhere;
    for (int l = 0; l < kFloatLanes; ++l) nowhere.set(l, kNowhere);
    std::size_t n = order_.size();
    do {
        n = (n + kFloatLanes - 1) / kFloatLanes;
        levels_.emplace_back(n, nowhere);
    } while (n > 1);
    dirty_.resize(levels_[0].size());
}

unsigned BoxTree::lanes(int leaf) const
{
    const int left = static_cast<int>(order_.size()) - leaf * kFloatLanes;
    return left >= kFloatLanes ? 0xffffu : (1u << left) - 1;
}

void BoxTree::refit(const Sweep& sweep, std::span<const char> dirtyVertices)
{
    if (empty()) return;
    parallelFor(levels_[0].size(), 32, [&](std::size_t i) { refitLeaf(sweep, dirtyVertices, static_cast<int>(i)); });
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        const std::vector<SweptBoxes>& children = levels_[level - 1];
        parallelFor(levels_[level].size(), 4, [&](std::size_t group) {
            const std::size_t first = group * kFloatLanes, count = std::min<std::size_t>(kFloatLanes, children.size() - first);
            for (std::size_t c = 0; c < count; ++c) {
                const unsigned filled = level == 1 ? lanes(static_cast<int>(first + c)) : 0xffffu;
                levels_[level][group].set(static_cast<int>(c), children[first + c].around(filled));
            }
        });
    }
}

void BoxTree::refitLeaf(const Sweep& sweep, std::span<const char> dirtyVertices, int leaf)
{
    SweptBoxes& boxes = levels_[0][leaf];
    unsigned dirty = 0;
    for (int lane = 0; lane < std::popcount(lanes(leaf)); ++lane) {
        const std::size_t place = static_cast<std::size_t>(leaf) * kFloatLanes + lane;
        const int* corner = corners_.data() + place * perPrimitive_;
        Vec3 lo = sweep.from[corner[0]], hi = lo, moveLo = sweep.move[corner[0]], moveHi = moveLo;
        char isDirty = dirtyVertices[corner[0]];
        for (int c = 1; c < perPrimitive_; ++c) {
            const Vec3 x = sweep.from[corner[c]], u = sweep.move[corner[c]];
            lo = lo.cwiseMin(x), hi = hi.cwiseMax(x), moveLo = moveLo.cwiseMin(u), moveHi = moveHi.cwiseMax(u);
            isDirty |= dirtyVertices[corner[c]];
        }
        SweptBox box;
        for (std::size_t k = 0; k < 3; ++k) {
            box.lo[k] = below(lo[k] - reach_[place]), box.hi[k] = above(hi[k] + reach_[place]);
            box.moveLo[k] = below(moveLo[k]), box.moveHi[k] = above(moveHi[k]);
        }
        boxes.set(lane, box);
        dirty |= (isDirty ? 1u : 0u) << lane;
    }
    dirty_[leaf] = dirty;
}

}  // namespace sim::contact

#include "sim/liquid/openings.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr int kReach = 6;             ///< how far beyond the plane faces are driven: the domain's last cells, and what their particles reach [cells]
constexpr double kRoundOff = 1.0e-6;  ///< of what lies in a plane of faces [cells]

CellRef find(const BlockGrid& grid, const Vec3i& cell)
{
    const int block = grid.find(Vec3i(cell[0] >> 3, cell[1] >> 3, cell[2] >> 3));
    return {block == BlockGrid::kNone ? grid.count() : block, cellInBlock(cell[0] & 7, cell[1] & 7, cell[2] & 7)};
}

/// Call f(cell, block, number in it) for the cells from `low` to `high` whose blocks exist.
template <class F>
void forEachCell(const BlockGrid& grid, const Vec3i& low, const Vec3i& high, F&& f)
{
    for (int b = 0; b < grid.count(); ++b) {
        const Vec3i first = kBlockEdge * grid.coords(b), begin = low.cwiseMax(first), end = high.cwiseMin(first + Vec3i::Constant(kBlockEdge - 1));
        for (int k = begin[2]; k <= end[2]; ++k)
            for (int j = begin[1]; j <= end[1]; ++j)
                for (int i = begin[0]; i <= end[0]; ++i) f(Vec3i(i, j, k), CellRef{b, cellInBlock(i & 7, j & 7, k & 7)});
    }
}

}  // namespace

void Openings::prepare(std::span<const OpeningSettings> openings, const Eigen::AlignedBox3d& domain, const Obstacles& solids, double dx,
                       const Vec3& gravity)
{
    dx_ = dx;
    up_ = gravity.isZero(0.0) ? Vec3(Vec3::Zero()) : Vec3(-gravity.normalized());
    for (const OpeningSettings& opening : openings) {
        Side side;
        side.opening = opening;
        const int a = opening.axis;
        side.low = (domain.min() / dx).array().floor().cast<int>() - kThickness;
        side.high = (domain.max() / dx).array().ceil().cast<int>() + (kThickness - 1);
        side.plane = opening.isUpper ? static_cast<int>(std::floor(domain.max()[a] / dx + kRoundOff)) - kThickness
                                     : static_cast<int>(std::ceil(domain.min()[a] / dx - kRoundOff)) + kThickness;
        side.low[a] = opening.isUpper ? side.plane : side.plane - kReach;
        side.high[a] = side.low[a] + kReach - 1;
        const Vec3i size = side.high - side.low + Vec3i::Ones();
        side.faces.resize(static_cast<std::size_t>(size.prod() / size[a]));
        if (!opening.isInlet() && gravity[a] == 0.0 && !gravity.isZero(0.0)) findDepth(solids, domain, side);
        sides_.push_back(side);
    }
}

/// Of the liquid at its level in the plane of an outlet, if there is air above.
void Openings::findDepth(const Obstacles& solids, const Eigen::AlignedBox3d& domain, Side& side) const
{
    int up = 0;
    up_.cwiseAbs().maxCoeff(&up);
    const int a = side.opening.axis, across = kAxes - a - up;
    const Vec3i low = (domain.min() / dx_ + Vec3::Constant(kRoundOff)).array().floor().cast<int>();
    const Vec3i high = (domain.max() / dx_ - Vec3::Constant(kRoundOff)).array().ceil().cast<int>();
    double area = 0.0, width = 0.0;  // in faces
    bool isFree = false;
    for (int n = low[across]; n < high[across]; ++n) {
        bool isOpen = false;
        for (int m = low[up]; m < high[up]; ++m) {
            Vec3 x = Vec3::Zero();
            x[a] = dx_ * side.plane;
            x[across] = dx_ * (n + 0.5);
            x[up] = dx_ * (m + 0.5);
            if (!(solids.distance(x) > 0.0)) continue;
            const double below = (side.opening.level - up_.dot(x)) / dx_ + 0.5;  // of the face [cells]
            isFree = isFree || below < 0.5;
            isOpen = isOpen || below > 0.0;
            area += std::clamp(below, 0.0, 1.0);
        }
        width += isOpen ? 1.0 : 0.0;
    }
    if (isFree && width > 0.0) side.depth = dx_ * area / width;
}

bool Openings::isBeyond(const Side& side, const Vec3i& cell)
{
    return (cell.array() >= side.low.array()).all() && (cell.array() <= side.high.array()).all();
}

/// Is any of the cell below the level?
bool Openings::isUnderLevel(const Side& side, const Vec3i& cell) const
{
    const double lowest = dx_ * (up_.dot(cell.cast<double>() + Vec3::Constant(0.5)) - 0.5 * up_.cwiseAbs().sum());
    return up_.isZero(0.0) || lowest < side.opening.level - kRoundOff * dx_;
}

void Openings::find(const BlockGrid& grid, LiquidGrid& liquid)
{
    planeFaces_.clear();
    drivenFaces_.clear();
    liquid.hasOpenings = !empty();
    if (empty()) return;
    liquid.beyond.resize(grid.count());
    liquid.atOpenings.resize(grid.count());
    const std::size_t words = static_cast<std::size_t>(grid.count()) * BlockBits<>::kWords;
    std::fill_n(liquid.beyond.block(0), words, std::uint64_t{0});
    std::fill_n(liquid.atOpenings.block(0), kAxes * words, std::uint64_t{0});
    for (Side& side : sides_) {
        findPlane(grid, side);
        findDriven(grid, side, liquid);
        for (std::size_t n = side.firstFace; n < side.endFace; ++n)
            liquid.atOpenings.set(planeFaces_[n].face.block, planeFaces_[n].face.cell, side.opening.axis);
    }
    for (const DrivenFace& driven : drivenFaces_) liquid.atOpenings.set(driven.face.block, driven.face.cell, driven.axis);
}

/// Where a plane keeps the number of its face at a cell.
int& Openings::faceAt(Side& side, const Vec3i& cell) const
{
    const int a = side.opening.axis, b = (a + 1) % kAxes, c = (a + 2) % kAxes;
    const int row = side.high[b] - side.low[b] + 1;
    return side.faces[static_cast<std::size_t>((cell[c] - side.low[c]) * row + cell[b] - side.low[b])];
}

void Openings::findPlane(const BlockGrid& grid, Side& side)
{
    const int a = side.opening.axis;
    Vec3i low = side.low, high = side.high, up = Vec3i::Zero();
    low[a] = high[a] = side.plane;
    int axis = 0;
    const double size = up_.cwiseAbs().maxCoeff(&axis);
    if (size > 0.0) up[axis] = up_[axis] > 0.0 ? 1 : -1;
    std::ranges::fill(side.faces, kNone);
    side.firstFace = planeFaces_.size();
    forEachCell(grid, low, high, [&](const Vec3i& cell, const CellRef& face) {
        const Vec3i below = cell - Vec3i::Unit(a), inner = side.opening.isUpper ? below : cell, outer = side.opening.isUpper ? cell : below;
        faceAt(side, cell) = static_cast<int>(planeFaces_.size());
        const Vec3i over = up[axis] > 0 ? Vec3i(inner + up) : inner;
        planeFaces_.push_back({.face = face,
                               .inner = sim::find(grid, inner),
                               .over = sim::find(grid, over),
                               .height = dx_ * up_.dot(outer.cast<double>() + Vec3::Constant(0.5))});
    });
    side.endFace = planeFaces_.size();
    if (axis == a || size == 0.0) return;
    forEachCell(grid, low, high, [&](const Vec3i& cell, const CellRef&) {
        const Vec3i above = cell + up;
        const int own = faceAt(side, cell), next = above[axis] >= low[axis] && above[axis] <= high[axis] ? faceAt(side, above) : kNone;
        planeFaces_[own].above = next;
        if (next != kNone) planeFaces_[next].below = own;
    });
}

void Openings::findDriven(const BlockGrid& grid, const Side& side, LiquidGrid& liquid)
{
    using By = DrivenFace::By;
    const OpeningSettings& opening = side.opening;
    const int a = opening.axis;
    const double velocity = -opening.outward() * opening.velocity;
    Vec3i high = side.high;
    if (!opening.isUpper) ++high[a];  // the plane is above the last cell
    forEachCell(grid, side.low, high, [&](const Vec3i& cell, const CellRef& face) {
        Vec3i inner = cell, inPlane = cell;
        inner[a] = opening.isUpper ? side.plane - 1 : side.plane;
        inPlane[a] = side.plane;
        const bool stands = opening.isInlet() && isUnderLevel(side, cell);
        if (isBeyond(side, cell)) {
            liquid.beyond.set(face.block, face.cell);
            for (int b = 0; b < kAxes; ++b)
                if (b != a) drivenFaces_.push_back({face, b, stands ? By::Velocity : By::Copy, sim::find(grid, inner), 0.0});
        }
        const bool isOutermost = !opening.isUpper && cell[a] == side.low[a];
        if (isOutermost || (cell[a] == side.plane && !opening.isInlet())) return;
        if (!opening.isInlet()) drivenFaces_.push_back({face, a, By::Copy, sim::find(grid, inPlane), 0.0});
        else if (cell[a] == side.plane && !stands) drivenFaces_.push_back({face, a, By::VelocityInAir, sim::find(grid, inner), velocity});
        else drivenFaces_.push_back({face, a, By::Velocity, {}, velocity});
    });
}

void Openings::closeInlets(PressureFaces& faces) const
{
    for (const Side& side : sides_)
        for (std::size_t n = side.firstFace; side.opening.isInlet() && n < side.endFace; ++n)
            faces.coefficient().block(planeFaces_[n].face.block, side.opening.axis)[planeFaces_[n].face.cell] = 0.0;
}

void Openings::takeHeld(BlockBits<3>& unheld) const
{
    for (const Side& side : sides_)
        for (std::size_t n = side.firstFace; n < side.endFace; ++n) {
            const auto [block, cell] = planeFaces_[n].face;
            unheld.block(block, side.opening.axis)[cell >> 6] &= ~(std::uint64_t{1} << (cell & 63));
        }
}

void Openings::findInletCells(const LiquidCells& cells, std::size_t opening, std::vector<InflowCell>& found) const
{
    found.clear();
    const Side& side = sides_[opening];
    for (std::size_t n = side.firstFace; side.opening.isInlet() && n < side.endFace; ++n) {
        const auto [block, cell] = planeFaces_[n].inner;
        if (cells.liquid().inside.test(block, cell)) found.push_back({opening, block, cell, 0.0});
    }
}

}  // namespace sim

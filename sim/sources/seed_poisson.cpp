#include "sim/sources/seed_patterns.h"

#include <array>

namespace sim {

namespace {

/// Darts thrown at each cube of the lattice.
constexpr int kRounds = 24;

/// The particles in a cube of one pitch: more than a few do not fit at the pattern's distance.
struct Cube {
    std::array<Vec3, 4> x;
    int count = 0;
};

/// Darts at cubes of one pitch.
class DartBoard {
 public:
    DartBoard(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing)
        : region_(region), random_(plan.fill.seed, plan.stream), distance_(minimumDistance(plan.fill, plan.dx)), taken_(existing, distance_)
    {
        const double pitch = particleSpacing(plan.fill, plan.dx);
        const Vec3 first = plan.source.bounds().min() + plan.age * plan.velocity;
        lattice_ = PlaceLattice::inBox(plan.source.bounds(), first, Vec3::Constant(pitch), 1.0);
        cubes_.resize(static_cast<std::size_t>(lattice_.size.cast<double>().prod()));
    }

    /// One dart at each cube. Every other cube along each axis at a time: darts at two of these cannot be nearer than a
    /// pitch, so they do not have to know of each other.
    void throwRound(int round)
    {
        for (int color = 0; color < 8; ++color) {
            const Vec3i begin(color & 1, color >> 1 & 1, color >> 2);
            const Vec3i count = (lattice_.size - begin + Vec3i::Ones()).cwiseMax(0) / 2;
            parallelFor(static_cast<std::size_t>(count[1]) * count[2], [&](std::size_t row) {
                const int j = begin[1] + 2 * static_cast<int>(row % count[1]), k = begin[2] + 2 * static_cast<int>(row / count[1]);
                for (int i = begin[0]; i < lattice_.size[0]; i += 2) throwAt(i, j, k, round);
            });
        }
    }

    std::vector<Vec3> hits() const
    {
        return lattice_.collect<Vec3>([&](int i, int j, int k, std::vector<Vec3>& list) {
            const Cube& cube = cubes_[indexOf(i, j, k)];
            list.insert(list.end(), cube.x.begin(), cube.x.begin() + cube.count);
        });
    }

 private:
    std::size_t indexOf(int i, int j, int k) const { return (static_cast<std::size_t>(k) * lattice_.size[1] + j) * lattice_.size[0] + i; }

    void throwAt(int i, int j, int k, int round)
    {
        Cube& cube = cubes_[indexOf(i, j, k)];
        if (cube.count == static_cast<int>(cube.x.size())) return;
        Vec3 x = lattice_.position(i, j, k);
        for (int a = 0; a < kAxes; ++a) x[a] += lattice_.pitch[a] * random_.uniform(lattice_.randomIndex(i, j, k), kAxes * round + a);
        if (!hasRoom(i, j, k, x) || !(region_.distance(x) < 0.0) || taken_.anyNearer(x, distance_)) return;
        cube.x[cube.count++] = x;
    }

    bool hasRoom(int i, int j, int k, const Vec3& x) const
    {
        for (int c = std::max(k - 1, 0); c <= std::min(k + 1, lattice_.size[2] - 1); ++c)
            for (int b = std::max(j - 1, 0); b <= std::min(j + 1, lattice_.size[1] - 1); ++b)
                for (int a = std::max(i - 1, 0); a <= std::min(i + 1, lattice_.size[0] - 1); ++a) {
                    const Cube& cube = cubes_[indexOf(a, b, c)];
                    for (int n = 0; n < cube.count; ++n)
                        if ((cube.x[n] - x).squaredNorm() < distance_ * distance_) return false;
                }
        return true;
    }

    const Shape& region_;
    CounterRandom random_;
    double distance_;
    PointBins taken_;
    PlaceLattice lattice_;
    std::vector<Cube> cubes_;
};

std::vector<Vec3> throwDarts(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing)
{
    DartBoard board(plan, region, existing);
    for (int round = 0; round < kRounds; ++round) board.throwRound(round);
    return board.hits();
}

}  // namespace

PatternPlaces poissonPlaces(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing)
{
    PatternPlaces places;
    places.free = throwDarts(plan, region, existing);
    places.count = existing.empty() ? places.free.size() : throwDarts(plan, region, {}).size();
    return places;
}

}  // namespace sim

#include "render/tube_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace render {

namespace {

using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kThinPixels = 3.5f;  ///< radius below which yarns.frag has let the plies fade out

/// Section of a tube at one place along it.
struct Ring {
    Vector3f center, tangent, m1;
    float turn, value, wetness;
};

Vector3f anyAcross(const Vector3f& tangent)
{
    int axis;
    tangent.cwiseAbs().minCoeff(&axis);
    return tangent.cross(Vector3f::Unit(axis)).normalized();
}

Vector3f across(const Vector3f& direction, const Vector3f& tangent)
{
    const Vector3f projected = direction - direction.dot(tangent) * tangent;
    const float length = projected.norm();
    return length > 1.0e-3f ? Vector3f(projected / length) : anyAcross(tangent);
}

/// One strand of the view, with what is asked of it again and again.
class Strand {
 public:
    Strand(const FrameView::Yarns& yarns, int strand)
        : yarns_(yarns), first_(yarns.begin[strand]), a_(yarns.halfAxes[strand][0]), b_(yarns.halfAxes[strand][1])
    {
        // A yarn of three plies that lie at about 30 degrees: pitch = π · diameter / tan 30°.
        pitch_ = 5.4f * (a_ + b_);
        const int end = yarns.begin[strand + 1];
        while (first_ + size_ < end && yarns.positions[first_ + size_].allFinite() && yarns.directions[first_ + size_].allFinite()) ++size_;
    }

    int size() const { return size_; }
    float a() const { return a_; }
    float b() const { return b_; }
    const Vector3f& x(int i) const { return yarns_.positions[first_ + i]; }
    /// Slope of the smooth curve at a vertex, times an edge: half the way from neighbour to neighbour.
    Vector3f slope(int i) const
    {
        const int before = std::max(i - 1, 0), after = std::min(i + 1, size_ - 1);
        return (x(after) - x(before)) / static_cast<float>(after - before);
    }
    /// Ring at u in 0 … 1 between vertex i and the next: Catmull-Rom.
    Ring ring(int i, float u) const
    {
        const int j = std::min(i + 1, size_ - 1);
        const Vector3f d = x(j) - x(i), s = slope(i), e = slope(j);
        const Vector3f c2 = 3.0f * d - 2.0f * s - e, c3 = s + e - 2.0f * d;
        Ring ring;
        ring.center = x(i) + u * (s + u * (c2 + u * c3));
        Vector3f tangent = s + u * (2.0f * c2 + 3.0f * u * c3);
        if (!(tangent.norm() > 0.0f)) tangent = d;
        ring.tangent = tangent.norm() > 0.0f ? Vector3f(tangent.normalized()) : Vector3f(Vector3f::UnitX());
        ring.m1 = across((1.0f - u) * yarns_.directions[first_ + i] + u * yarns_.directions[first_ + j], ring.tangent);
        const auto between = [&](std::span<const float> f) { return (1.0f - u) * f[first_ + i] + u * f[first_ + j]; };
        ring.turn = between(yarns_.along) / pitch_;
        ring.value = yarns_.values.empty() ? 0.0f : between(yarns_.values);
        ring.wetness = yarns_.wetness.empty() ? 0.0f : between(yarns_.wetness);
        return ring;
    }
    float turnsOf(float length) const { return length / pitch_; }

 private:
    const FrameView::Yarns& yarns_;
    int first_, size_ = 0;
    float a_, b_, pitch_;
};

/// A thin tube in the picture needs few sides and few pieces per edge.
class Fineness {
 public:
    Fineness(const Strand& strand, const TubeDetail& detail) : strand_(strand), detail_(detail)
    {
        float nearest = std::numeric_limits<float>::infinity();
        for (int i = 0; i < strand.size(); ++i) nearest = std::min(nearest, (strand.x(i) - detail.eye).squaredNorm());
        radiusPixels_ = pixelsOf(std::max(strand.a(), strand.b()), std::sqrt(nearest));
        const int enough = radiusPixels_ < 1.0f ? 4 : radiusPixels_ < kThinPixels ? 5 : radiusPixels_ < 5.0f ? 6 : radiusPixels_ < 8.0f ? 8 : 64;
        sides_ = std::clamp(enough, 3, std::max(3, detail.sides));
    }

    int sides() const { return sides_; }
    float radiusPixels() const { return radiusPixels_; }
    int capRings() const { return sides_ <= 6 ? 1 : 3; }
    /// Pieces of the edge from vertex i to the next, so that no piece turns by more than a few degrees or strays
    /// visibly.
    int pieces(int i) const
    {
        const Vector3f edge = strand_.x(i + 1) - strand_.x(i);
        const float length = edge.norm();
        if (!(length > 0.0f)) return 1;
        const auto angleTo = [&](const Vector3f& slope) { return std::atan2(edge.cross(slope).norm(), edge.dot(slope)); };
        const float turn = angleTo(strand_.slope(i)) + angleTo(strand_.slope(i + 1));
        constexpr float kTurnPerPiece = 12.0f * kPi / 180.0f, kPixelsPerPiece = 6.0f;
        const float visible = pixelsOf(length, (strand_.x(i) - detail_.eye).norm()) / kPixelsPerPiece;
        return static_cast<int>(std::clamp(std::round(std::min(turn / kTurnPerPiece, visible)), 1.0f, 12.0f));
    }

 private:
    float pixelsOf(float length, float distance) const { return detail_.pixelsPerTangent * length / std::max(distance, 1.0e-6f); }

    const Strand& strand_;
    const TubeDetail& detail_;
    float radiusPixels_ = 0.0f;
    int sides_ = 3;
};

/// Writes rings of `sides` + 1 corners (the seam has two) and joins each to the one before it.
class RingWriter {
 public:
    RingWriter(const Strand& strand, int sides, const TubeColor& color, TubeMesh& mesh) : strand_(strand), sides_(sides), color_(color), mesh_(mesh)
    {
        // Seen from all around, a polygon with corners on a circle is narrower than the circle: on average by this.
        const float n = static_cast<float>(sides);
        widening_ = kPi / (n * std::sin(kPi / n));
    }

    /// @param lean  of the round end: 0 = on the tube … ±π/2 = its tip, along the tangent
    void add(const Ring& ring, float lean = 0.0f)
    {
        const float shrink = std::cos(lean), tip = std::sin(lean), a = strand_.a(), b = strand_.b();
        const Vector3f m2 = ring.tangent.cross(ring.m1);
        const float reach = std::min(a, b) * tip;
        const Vector3f center = ring.center + reach * ring.tangent;
        const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
        const std::array<std::uint8_t, 4> color = color_(ring.wetness);
        for (int k = 0; k <= sides_; ++k) {
            const float angle = static_cast<float>(k) / static_cast<float>(sides_);
            const float c = std::cos(2.0f * kPi * angle), s = std::sin(2.0f * kPi * angle);
            const Vector3f normal = (shrink * (b * c * ring.m1 + a * s * m2).normalized() + tip * ring.tangent).normalized();
            mesh_.vertices.push_back({.position = center + shrink * widening_ * (a * c * ring.m1 + b * s * m2),
                                      .normal = normal,
                                      .turn = ring.turn + strand_.turnsOf(reach),
                                      .angle = angle,
                                      .value = ring.value,
                                      .color = color});
        }
        if (hasBefore_) join(first - static_cast<std::uint32_t>(sides_) - 1, first);
        hasBefore_ = true;
    }

 private:
    void join(std::uint32_t from, std::uint32_t to)
    {
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides_); ++k)
            mesh_.indices.insert(mesh_.indices.end(), {from + k, from + k + 1, to + k + 1, from + k, to + k + 1, to + k});
    }

    const Strand& strand_;
    int sides_;
    const TubeColor& color_;
    TubeMesh& mesh_;
    float widening_ = 1.0f;
    bool hasBefore_ = false;
};

}  // namespace

bool isThin(const FrameView::Yarns& yarns, int strandIndex, const TubeDetail& detail)
{
    const Strand strand(yarns, strandIndex);
    return Fineness(strand, detail).radiusPixels() < kThinPixels;
}

void addTube(const FrameView::Yarns& yarns, int strandIndex, const TubeDetail& detail, const TubeColor& color, TubeMesh& mesh)
{
    const Strand strand(yarns, strandIndex);
    if (strand.size() < 2 || !(std::min(strand.a(), strand.b()) > 0.0f)) return;
    const Fineness fineness(strand, detail);
    RingWriter writer(strand, fineness.sides(), color, mesh);
    const int caps = fineness.capRings(), last = strand.size() - 2;

    const Ring begin = strand.ring(0, 0.0f);
    for (int k = 0; k < caps; ++k) writer.add(begin, -0.5f * kPi * (1.0f - static_cast<float>(k) / static_cast<float>(caps)));
    for (int i = 0; i <= last; ++i) {
        const int pieces = fineness.pieces(i);
        for (int k = 0; k < pieces; ++k) writer.add(strand.ring(i, static_cast<float>(k) / static_cast<float>(pieces)));
    }
    const Ring end = strand.ring(last, 1.0f);
    for (int k = 0; k <= caps; ++k) writer.add(end, 0.5f * kPi * static_cast<float>(k) / static_cast<float>(caps));
}

}  // namespace render

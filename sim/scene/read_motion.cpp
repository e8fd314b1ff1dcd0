#include "sim/scene/read_place.h"
#include "sim/scene/read_shape.h"
#include "sim/scene/section_reader.h"
#include "sim/scene/section_writer.h"

#include <fmt/format.h>

#include <array>

namespace sim {

static std::span<const Choice<Motion::Frame>> choicesOf(Motion::Frame)
{
    static constexpr Choice<Motion::Frame> kAll[] = {{"world", Motion::Frame::World}, {"local", Motion::Frame::Local}};
    return kAll;
}

namespace {

constexpr double kFastest = 1.0e6;  // [1/s]
const Range kTime = Range::between(-1.0e9, 1.0e9);

enum class PathInterpolation { Cubic, Linear };

std::span<const Choice<PathInterpolation>> choicesOf(PathInterpolation)
{
    static constexpr Choice<PathInterpolation> kAll[] = {{"cubic", PathInterpolation::Cubic}, {"linear", PathInterpolation::Linear}};
    return kAll;
}

/// Everything a piece may say; which of it counts is decided by its kind.
struct Piece {
    std::array<double, 2> t = {0.0, 0.0}, ease = {0.0, 0.0};
    Vec3 translate = Vec3::Zero();
    Vec3 axis = Vec3::UnitY(), origin = Vec3::Zero(), direction = Vec3::UnitX();
    double angle = 0.0, amplitude = 0.0, swing = 0.0, frequency = 1.0;
    Motion::Frame frame = Motion::Frame::World;
    PathInterpolation interpolation = PathInterpolation::Cubic;
};

struct Kind {
    bool translates = false, rotates = false, oscillates = false, followsPath = false, swings = false;
};

Vec3 unit(const Vec3& axis, const Node& node, const std::string& path)
{
    const double length = axis.norm();
    if (!(length > 0.0) || !std::isfinite(length)) fail(node.location, path + ": must be a direction, like [0, 1, 0]");
    return axis / length;
}

template <class V>
void describeTurn(V& v, Piece& p)
{
    v.vector("axis", p.axis, Quantity::None, "Direction to turn about");
    v.vector("origin", p.origin, Quantity::Length, "Point on the axis");
    v.choice("frame", p.frame, "Whether axis and origin stay in space or go with the body");
}

template <class V>
void visitFields(V& v, Piece& p, const Kind& kind)
{
    if (!kind.followsPath) v.pair("t", p.t, Quantity::Time, kTime, "Times of its beginning and end");
    if (kind.translates || kind.rotates)
        v.pair("ease", p.ease, Quantity::Time, Range::atLeast(0.0), "Time in which it gets going, and comes to rest");
    if (kind.translates) v.vector("translate", p.translate, Quantity::Length, "How far it moves between them");
    if (kind.followsPath) v.choice("interp", p.interpolation, "What joins places of keys");
    for (const char* key : {"rotate", "oscillate", "keys"}) v.other(key, "");
}

std::vector<std::array<double, 4>> readPath(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.size() < 2)
        fail(node.location, fmt::format("{}: needs two or more rows [t, x, y, z], not {}", path, node.called()));
    std::vector<std::array<double, 4>> rows;
    for (const Node& row : node.items) {
        if (!row.isList() || row.items.size() != 4) fail(row.location, fmt::format("{}: a row is [t, x, y, z], not {}", path, row.called()));
        std::array<double, 4>& out = rows.emplace_back();
        out[0] = readNumber(row.items[0], path, Quantity::Time, kTime);
        for (std::size_t i = 1; i < 4; ++i) out[i] = readNumber(row.items[i], path, Quantity::Length, Range::between(-kFarthest, kFarthest));
        if (rows.size() > 1 && !(out[0] > rows[rows.size() - 2][0])) fail(row.location, fmt::format("{}: times must ascend", path));
    }
    return rows;
}

/// One piece of a motion: reads it, adds it, and says it again.
class PieceReader {
 public:
    PieceReader(const Node& node, std::string path) : node_(node), path_(std::move(path)) {}

    std::string addTo(Motion& motion)
    {
        kind_ = kindOf();
        const auto fields = [&](auto& v) { visitFields(v, piece_, kind_); };
        SectionReader::read(&node_, path_, fields);
        if (!kind_.followsPath) checkSpan();
        std::string tail;
        if (kind_.rotates) tail = addRotation(motion);
        if (kind_.oscillates) tail = addOscillation(motion);
        if (kind_.followsPath) tail = addPath(motion);
        if (kind_.translates) motion.addTranslation(piece_.t[0], piece_.t[1], piece_.translate, piece_.ease[0], piece_.ease[1]);
        SectionWriter writer;
        fields(writer);
        std::string text = writer.flow();
        text.pop_back();
        return text + tail + "}";
    }

 private:
    Kind kindOf() const
    {
        if (!node_.isMap())
            fail(node_.location, fmt::format("{}: needs a map like {{t: [0, 1], translate: [0, 5, 0]}}, not {}", path_, node_.called()));
        const Kind kind{node_.find("translate") != nullptr, node_.find("rotate") != nullptr, node_.find("oscillate") != nullptr,
                        node_.find("keys") != nullptr, false};
        if (kind.translates + kind.rotates + kind.oscillates + kind.followsPath != 1) {
            fail(node_.location, fmt::format("{}: needs one of translate, rotate, oscillate, keys", path_));
        }
        return kind;
    }

    void checkSpan()
    {
        if (!node_.find("t")) fail(node_.location, fmt::format("{}: t is missing; it is the span of time, like t: [0, 0.2]", path_));
        const double span = piece_.t[1] - piece_.t[0];
        if (!(span > 0.0)) fail(node_.find("t")->location, fmt::format("{}.t: must end after it begins", path_));
        const Node* ease = node_.find("ease");
        if (!ease) piece_.ease = {span / 3.0, span / 3.0};
        if (ease && piece_.ease[0] + piece_.ease[1] > span) fail(ease->location, fmt::format("{}.ease: both together must fit into t", path_));
    }

    std::string addRotation(Motion& motion)
    {
        const Node& node = *node_.find("rotate");
        const std::string path = joinPath(path_, "rotate");
        const auto fields = [&](auto& v) {
            describeTurn(v, piece_);
            v.required("angle", "how far to turn, in degrees, like angle: 90");
            v.number("angle", piece_.angle, Quantity::Angle, Range::between(-1.0e6, 1.0e6), "");
        };
        SectionReader::read(&node, path, fields);
        const Motion::Axis axis{unit(piece_.axis, node, path + ".axis"), piece_.origin, piece_.frame};
        motion.addRotation(piece_.t[0], piece_.t[1], axis, piece_.angle, piece_.ease[0], piece_.ease[1]);
        SectionWriter writer;
        fields(writer);
        return ", rotate: " + writer.flow();
    }

    std::string addOscillation(Motion& motion)
    {
        const Node& node = *node_.find("oscillate");
        const std::string path = joinPath(path_, "oscillate");
        kind_.swings = node.find("axis") != nullptr;
        const auto fields = [&](auto& v) {
            if (kind_.swings) describeTurn(v, piece_);
            if (!kind_.swings) v.vector("direction", piece_.direction, Quantity::None, "Direction of the swing");
            v.required("amplitude", "how far it swings to each side, a length (with axis: an angle)");
            if (kind_.swings) v.number("amplitude", piece_.swing, Quantity::Angle, Range::between(-3600.0, 3600.0), "");
            if (!kind_.swings) v.number("amplitude", piece_.amplitude, Quantity::Length, Range::between(-kFarthest, kFarthest), "");
            v.required("frequency", "swings per second, like frequency: 2");
            v.number("frequency", piece_.frequency, Quantity::Frequency, Range::aboveTo(0.0, kFastest), "");
        };
        SectionReader::read(&node, path, fields);
        if (kind_.swings) {
            const Motion::Axis axis{unit(piece_.axis, node, path + ".axis"), piece_.origin, piece_.frame};
            motion.addSwing(piece_.t[0], piece_.t[1], axis, piece_.swing, piece_.frequency);
        } else {
            motion.addOscillation(piece_.t[0], piece_.t[1], unit(piece_.direction, node, path + ".direction"), piece_.amplitude, piece_.frequency);
        }
        SectionWriter writer;
        fields(writer);
        return ", oscillate: " + writer.flow();
    }

    std::string addPath(Motion& motion)
    {
        std::vector<double> times;
        std::vector<Vec3> offsets;
        std::string rows;
        for (const auto& [t, x, y, z] : readPath(*node_.find("keys"), joinPath(path_, "keys"))) {
            times.push_back(t);
            offsets.emplace_back(x, y, z);
            rows += fmt::format("{}[{}, {}, {}, {}]", rows.empty() ? "" : ", ", formatPlain(t), formatPlain(x), formatPlain(y), formatPlain(z));
        }
        motion.addPath(times, offsets, piece_.interpolation == PathInterpolation::Cubic);
        return ", keys: [" + rows + "]";
    }

    const Node& node_;
    std::string path_;
    Kind kind_;
    Piece piece_;
};

}  // namespace

ReadMotion readMotion(const Node& node, const std::string& path)
{
    ReadMotion out;
    if (!node.isList()) {
        out.text = fmt::format("[{}]", PieceReader(node, path).addTo(out.motion));
        return out;
    }
    if (node.items.empty()) fail(node.location, fmt::format("{}: is an empty list; remove it", path));
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        out.text += (i > 0 ? ", " : "") + PieceReader(node.items[i], joinPath(path, std::to_string(i))).addTo(out.motion);
    }
    out.text = "[" + out.text + "]";
    return out;
}

}  // namespace sim

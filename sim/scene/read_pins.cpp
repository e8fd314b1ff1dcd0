#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_list.h"
#include "sim/scene/read_shape.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace sim {

namespace {

/// "x-" or "z+": the lower or upper end of a piece along an axis.
struct EndOfAxis {
    int axis = 0;
    bool isUpper = false;
};

EndOfAxis parseEnd(const std::string& word, const Node& node, const std::string& path)
{
    if (word.size() == 2 && word[0] >= 'x' && word[0] <= 'z' && (word[1] == '-' || word[1] == '+')) return {word[0] - 'x', word[1] == '+'};
    fail(node.location, fmt::format("{}: {} is no side; write x-, x+, y-, y+, z- or z+", path, inQuotes(word)));
}

/// The corners of a generator's lattice, and where they are.
class Corners {
 public:
    Corners(const FabricGeometry& geometry, const Node& node, const std::string& path) : geometry_(geometry), node_(node), path_(path)
    {
        if (geometry.lattice.empty())
            fail(node.location, path + ": has corners and sides only with cloth_grid, woven_yarns and strand; use nodes, box or ball");
        const Vec2i last = geometry.latticeSize - Vec2i::Ones();
        const std::vector<int> rows = last[1] > 0 ? std::vector<int>{0, last[1]} : std::vector<int>{0};
        for (const int row : rows) {
            for (const int column : {0, last[0]}) {
                corners.emplace_back(column, row);
                bounds_.extend(positions_.emplace_back(nearest(corners.back())));
            }
        }
    }

    std::vector<Vec2i> corners;

    /// Is a corner at this end of the piece? In the outer quarter, so that sheets may lie askew.
    bool isAt(std::size_t corner, const EndOfAxis& end) const
    {
        const double low = bounds_.min()[end.axis], extent = bounds_.sizes()[end.axis];
        constexpr double kFlat = 1.0e-6;  // of the whole piece's size
        if (!(extent > kFlat * bounds_.sizes().maxCoeff())) return false;
        const double share = (positions_[corner][end.axis] - low) / extent;
        return end.isUpper ? share > 0.75 : share < 0.25;
    }

    /// Does a vertex belong to the patch of that corner?
    bool isInPatch(const Vec2i& v, const Vec2i& corner, int patch, bool borderOnly) const
    {
        const Vec2i away = (v - corner).cwiseAbs();
        const Vec2i last = geometry_.latticeSize - Vec2i::Ones();
        const bool isBorder = v[0] == 0 || v[0] == last[0] || v[1] == 0 || v[1] == last[1];
        return away.maxCoeff() < patch && (isBorder || !borderOnly);
    }

    /// The sides of the sheet, each by its axis of the lattice and the number of its column or row, that lie at an end.
    std::vector<std::pair<int, int>> sidesAt(const EndOfAxis& end) const
    {
        std::vector<std::pair<int, int>> sides;
        for (int axis = 0; axis < 2; ++axis) {
            const int last = geometry_.latticeSize[axis] - 1;
            if (last == 0) continue;
            for (const int line : {0, last}) {
                bool isThere = true;
                for (std::size_t c = 0; c < corners.size(); ++c) isThere = isThere && (corners[c][axis] != line || isAt(c, end));
                if (isThere) sides.emplace_back(axis, line);
            }
        }
        return sides;
    }

 private:
    /// The vertex that is nearest to a place of the lattice: weaves without borders have none at the corner itself.
    Vec3 nearest(const Vec2i& corner) const
    {
        const auto distance = [&](const Vec2i& v) { return (v - corner).cwiseAbs().sum(); };
        const auto best = std::min_element(geometry_.lattice.begin(), geometry_.lattice.end(),
                                           [&](const Vec2i& a, const Vec2i& b) { return distance(a) < distance(b); });
        return geometry_.points[best - geometry_.lattice.begin()];
    }

    const FabricGeometry& geometry_;
    const Node& node_;
    const std::string& path_;
    std::vector<Vec3> positions_;
    Eigen::AlignedBox3d bounds_;
};

/// One pin: which vertices, and the words for them.
class PinReader {
 public:
    PinReader(const Node& node, std::string path, const FabricGeometry& geometry, std::span<const Vec3> placed, double cell)
        : node_(node), path_(std::move(path)), geometry_(geometry), placed_(placed), cell_(cell), held_(placed.size(), 0)
    {
    }

    PinGroup read()
    {
        PinGroup pin;
        pin.where = node_.location.text();
        SectionReader::read(&node_, path_, [&](auto& v) {
            v.text("name", pin.name, "By which motions call it");
            for (const char* key : kSelections) v.other(key, "");
            v.integer("patch", patch_, 1, 1'000'000, "Vertices from each corner, or rows from the side");
            v.flag("border_only", borderOnly_, "Of a patch only what lies on the border");
            v.flag("twist", pin.twist, "The twist of yarns is held too");
            v.other("motion", "How they move");
        });
        if (const Node* name = node_.find("name")) requireName(pin.name, name->location, path_ + ".name");
        pin.text = select();
        for (std::size_t i = 0; i < held_.size(); ++i) {
            if (held_[i]) pin.vertices.push_back(static_cast<int>(i));
        }
        if (pin.vertices.empty()) fail(node_.location, fmt::format("{}: holds no vertex; move or enlarge what it selects", calledPath(pin)));
        if (const Node* motion = node_.find("motion")) {
            ReadMotion read = readMotion(*motion, joinPath(path_, "motion"));
            pin.motion = std::move(read.motion);
            pin.motionText = std::move(read.text);
        }
        return pin;
    }

 private:
    /// "fabrics.cloth.pin, "left"", for messages.
    std::string calledPath(const PinGroup& pin) const { return pin.name.empty() ? path_ : fmt::format("{}, {}", path_, inQuotes(pin.name)); }

    static constexpr const char* kSelections[] = {"corners", "edge", "nodes", "shape", "box", "ball"};

    std::string select()
    {
        std::string kind;
        for (const char* key : kSelections) {
            if (!node_.find(key)) continue;
            if (!kind.empty()) fail(node_.location, fmt::format("{}: has both {} and {}; make them two pins in a list", path_, kind, key));
            kind = key;
        }
        if (kind.empty())
            fail(node_.location,
                 fmt::format("{}: selects nothing; it takes one of {}", path_, listed({std::begin(kSelections), std::end(kSelections)})));
        const bool hasPatches = kind == "corners" || kind == "edge";
        if (!hasPatches && node_.find("patch")) fail(node_.find("patch")->location, path_ + ".patch: needs corners or edge");
        if (kind != "corners" && node_.find("border_only")) fail(node_.find("border_only")->location, path_ + ".border_only: needs corners");
        const Node& value = *node_.find(kind);
        const std::string path = joinPath(path_, kind);
        if (kind == "corners") return "corners: " + selectCorners(value, path) + patchText();
        if (kind == "edge") return "edge: " + selectEdge(value, path) + patchText();
        if (kind == "nodes") return "nodes: " + selectNodes(value, path);
        return selectInside(value, kind);
    }

    std::string patchText() const { return fmt::format(", patch: {}{}", patch_, borderOnly_ ? ", border_only: true" : ""); }

    std::string selectCorners(const Node& value, const std::string& path)
    {
        const Corners corners(geometry_, value, path);
        if (value.isScalar() && value.text == "all") {
            for (const Vec2i& corner : corners.corners) holdPatch(corners, corner);
            return "all";
        }
        if (!value.isList()) fail(value.location, fmt::format("{}: needs all, or a list like [\"x- z-\", \"x- z+\"], not {}", path, value.called()));
        for (const Node& item : value.items) {
            const std::string& text = readText(item, path);
            std::istringstream words(text);
            std::vector<EndOfAxis> ends;
            for (std::string word; words >> word;) ends.push_back(parseEnd(word, item, path));
            bool isAny = false;
            for (std::size_t c = 0; c < corners.corners.size(); ++c) {
                const bool isMeant =
                    !ends.empty() && std::all_of(ends.begin(), ends.end(), [&](const EndOfAxis& end) { return corners.isAt(c, end); });
                if (isMeant) holdPatch(corners, corners.corners[c]);
                isAny = isAny || isMeant;
            }
            if (!isAny) fail(item.location, fmt::format("{}: the piece has no corner {}", path, inQuotes(text)));
        }
        return value.flow();
    }

    void holdPatch(const Corners& corners, const Vec2i& corner)
    {
        for (std::size_t i = 0; i < held_.size(); ++i) {
            if (corners.isInPatch(geometry_.lattice[i], corner, patch_, borderOnly_)) held_[i] = 1;
        }
    }

    std::string selectEdge(const Node& value, const std::string& path)
    {
        const std::string& text = readText(value, path);
        const Corners corners(geometry_, value, path);
        const auto sides = corners.sidesAt(parseEnd(text, value, path));
        if (sides.empty()) fail(value.location, fmt::format("{}: the piece has no side {}", path, inQuotes(text)));
        for (const auto& [axis, line] : sides) {
            for (std::size_t i = 0; i < held_.size(); ++i) {
                if (std::abs(geometry_.lattice[i][axis] - line) < patch_) held_[i] = 1;
            }
        }
        return Node::scalar(text, {}).flow();
    }

    std::string selectNodes(const Node& value, const std::string& path)
    {
        if (!value.isList()) fail(value.location, fmt::format("{}: needs a list of numbers of vertices, like [0, 1], not {}", path, value.called()));
        const std::vector<int>& points = geometry_.ofFile;
        const auto last = static_cast<std::int64_t>(points.empty() ? held_.size() : points.size()) - 1;
        for (const Node& item : value.items) {
            const std::int64_t number = readInteger(item, path, 0, last), point = points.empty() ? number : points[number];
            if (point < 0)
                fail(item.location, fmt::format("{}: nothing of the file is at its vertex {}; choose one that a face or a line has", path, number));
            held_[point] = 1;
        }
        return value.flow();
    }

    std::string selectInside(const Node& value, const std::string& kind)
    {
        Node shape = value;
        if (kind != "shape") {
            shape = Node::map(value.location);
            shape.at(kind, value.location) = value;
        }
        const ReadShape read = readShape(shape, kind == "shape" ? joinPath(path_, kind) : path_, cell_);
        constexpr double kRoundOff = 1.0e-9;  // [cm]: what lies on the surface is held
        for (std::size_t i = 0; i < held_.size(); ++i) held_[i] = read.shape.distance(placed_[i]) <= kRoundOff;
        return "shape: " + read.text;
    }

    const Node& node_;
    std::string path_;
    const FabricGeometry& geometry_;
    std::span<const Vec3> placed_;
    double cell_;
    int patch_ = 1;
    bool borderOnly_ = false;
    std::vector<char> held_;
};

}  // namespace

std::vector<PinGroup> readPins(const Node& node, const std::string& path, const FabricGeometry& geometry, std::span<const Vec3> placed, double cell)
{
    if (!node.isList()) return {PinReader(node, path, geometry, placed, cell).read()};
    std::vector<PinGroup> pins;
    for (std::size_t i = 0; i < node.items.size(); ++i)
        pins.push_back(PinReader(node.items[i], joinPath(path, std::to_string(i)), geometry, placed, cell).read());
    return pins;
}

}  // namespace sim

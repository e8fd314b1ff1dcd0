#include "sim/fabric/pieces/orient.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sim {

namespace {

struct Side {
    int low, high;  ///< vertices
    int face;
    bool isDown;  ///< the face runs from high to low

    bool isBeside(const Side& other) const { return low == other.low && high == other.high; }
};

std::vector<Side> sortedSides(const std::vector<Vec3i>& faces)
{
    std::vector<Side> sides;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f), a > b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::array{a.low, a.high, a.face} < std::array{b.low, b.high, b.face};
    });
    return sides;
}

struct Neighbour {
    int face = -1;
    bool isAgainst = false;  ///< whether both faces run along their edge in one direction
};

}  // namespace

std::string orientAlike(std::vector<Vec3i>& faces, const std::vector<int>& names)
{
    const auto nameOf = [&](int vertex) { return names.empty() ? vertex : names[static_cast<std::size_t>(vertex)]; };
    const std::vector<Side> sides = sortedSides(faces);
    std::vector<std::array<Neighbour, 3>> neighbours(faces.size());
    std::vector<int> known(faces.size(), 0);
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side &a = sides[i], &b = sides[i + 1];
        if (!a.isBeside(b)) continue;
        if (i + 2 < sides.size() && a.isBeside(sides[i + 2]))
            return fmt::format("the edge between vertices {} and {} has more than two faces; split the mesh there", nameOf(a.low), nameOf(a.high));
        const bool isAgainst = a.isDown == b.isDown;
        neighbours[a.face][known[a.face]++] = {b.face, isAgainst};
        neighbours[b.face][known[b.face]++] = {a.face, isAgainst};
    }
    enum : char { Unseen, Kept, Turned };
    std::vector<char> state(faces.size(), Unseen);
    std::vector<int> open;
    for (std::size_t first = 0; first < faces.size(); ++first) {
        if (state[first] != Unseen) continue;
        state[first] = Kept;
        open.assign(1, static_cast<int>(first));
        while (!open.empty()) {
            const int f = open.back();
            open.pop_back();
            for (const Neighbour& n : neighbours[f]) {
                if (n.face < 0) continue;
                const char wanted = (state[f] == Turned) != n.isAgainst ? Turned : Kept;
                if (state[n.face] != Unseen && state[n.face] != wanted) return "the mesh has one side only, like a Möbius strip; cut it";
                if (state[n.face] == Unseen) open.push_back(n.face);
                state[n.face] = wanted;
            }
        }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (state[f] == Turned) std::swap(faces[f][1], faces[f][2]);
    }
    return "";
}

}  // namespace sim

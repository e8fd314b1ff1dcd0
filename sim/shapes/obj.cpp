#include "sim/shapes/obj.h"

#include "sim/core/check.h"
#include "sim/shapes/cut_polygon.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

namespace sim {

namespace {

constexpr std::string_view kBlanks = " \t";
constexpr std::size_t kMostElements = 100'000'000;  ///< vertices or triangles: more is not a mesh but a mistake

/// The next word of a line, which is cut off; empty at its end.
std::string_view nextWord(std::string_view& line)
{
    const std::size_t begin = std::min(line.find_first_not_of(kBlanks), line.size());
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

/// A sign that says nothing is no part of a number for from_chars.
std::string_view withoutPlus(std::string_view number)
{
    if (number.size() > 1 && number[0] == '+' && number[1] != '-' && number[1] != '+') number.remove_prefix(1);
    return number;
}

/// Reads one file; knows the line for messages.
class ObjReader {
 public:
    ObjReader(const std::filesystem::path& file, bool wantsLines) : file_(file.string()), in_(file, std::ios::binary), wantsLines_(wantsLines) {}

    TriangleMesh readMesh()
    {
        read();
        if (mesh_.triangles.empty()) throw InputError(file_ + ": has no faces");
        return std::move(mesh_);
    }

    PolylineSet readLines()
    {
        read();
        if (lines_.empty()) throw InputError(file_ + ": has no lines (l)");
        return {std::move(mesh_.vertices), std::move(lines_)};
    }

 private:
    void read()
    {
        if (!in_) throw InputError(file_ + ": cannot be opened");
        skipByteOrderMark();
        for (std::string line; nextLine(line);) {
            std::string_view rest(line);
            const std::string_view kind = nextWord(rest);
            if (kind == "v") readVertex(rest);
            if (kind == "f") readFace(rest);
            if (kind == "l" && wantsLines_) readLine(rest);
            if (std::max(mesh_.vertices.size(), mesh_.triangles.size()) > kMostElements) fail("more than 100 million vertices or triangles");
        }
        if (in_.bad()) throw InputError(file_ + ": could not be read to its end");
    }

    void skipByteOrderMark()
    {
        for (const int byte : {0xEF, 0xBB, 0xBF})
            if (in_.peek() == byte) in_.get();
    }

    /// Reads a line without its comment; a backslash at its end goes on with the next one. Lines end with LF, CR or both.
    bool nextLine(std::string& line)
    {
        line.clear();
        line_ += linesRead_;
        linesRead_ = 0;
        for (std::string part; nextPart(part);) {
            ++linesRead_;
            const bool hasComment = part.find('#') != std::string::npos;
            line += part.substr(0, part.find('#'));
            if (hasComment || !part.ends_with('\\')) break;
            line.back() = ' ';
        }
        return linesRead_ > 0;
    }

    bool nextPart(std::string& part)
    {
        part.clear();
        int c = in_.get();
        if (c == std::ifstream::traits_type::eof()) return false;
        for (; c != std::ifstream::traits_type::eof() && c != '\n' && c != '\r'; c = in_.get()) part.push_back(static_cast<char>(c));
        if (c == '\r' && in_.peek() == '\n') in_.get();
        return true;
    }

    [[noreturn]] void fail(const std::string& what) const { throw InputError(file_ + ":" + std::to_string(line_) + ": " + what); }

    void readVertex(std::string_view rest)
    {
        Vec3 v;
        for (double& x : v) {
            const std::string_view word = nextWord(rest);
            if (word.empty()) fail("a vertex needs three coordinates");
            const std::string_view number = withoutPlus(word);
            const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), x);
            if (error != std::errc() || end != number.data() + number.size()) fail("not a number: \"" + std::string(word) + "\"");
            if (!std::isfinite(x)) fail("not a finite number: \"" + std::string(word) + "\"");
        }
        mesh_.vertices.push_back(v);
    }

    int readCorner(std::string_view word) const
    {
        const std::string_view number = withoutPlus(word.substr(0, word.find('/')));
        long long index = 0;
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
        if (error != std::errc() || end != number.data() + number.size()) fail("not a corner: \"" + std::string(word) + "\"");
        const auto count = static_cast<long long>(mesh_.vertices.size());
        const long long fromZero = index > 0 ? index - 1 : count + index;
        if (index == 0 || fromZero < 0 || fromZero >= count)
            fail("vertex " + std::to_string(index) + " does not exist; there are " + std::to_string(count) + " so far");
        return static_cast<int>(fromZero);
    }

    void readFace(std::string_view rest)
    {
        corners_.clear();
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) corners_.push_back(readCorner(word));
        if (corners_.size() < 3) fail("a face needs three corners or more");
        cutPolygon(mesh_.vertices, corners_, mesh_.triangles);
    }

    void readLine(std::string_view rest)
    {
        std::vector<int>& line = lines_.emplace_back();
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) line.push_back(readCorner(word));
        if (line.size() < 2) fail("a line needs two vertices or more");
    }

    std::string file_;
    std::ifstream in_;
    bool wantsLines_;
    int line_ = 1;       ///< where the line that is being read begins
    int linesRead_ = 0;  ///< number of lines read so far, for that line
    std::vector<int> corners_;
    TriangleMesh mesh_;
    std::vector<std::vector<int>> lines_;
};

}  // namespace

TriangleMesh readObj(const std::filesystem::path& file) { return ObjReader(file, false).readMesh(); }

PolylineSet readObjLines(const std::filesystem::path& file) { return ObjReader(file, true).readLines(); }

Shape shapeFromObj(const std::filesystem::path& file, double scale, double cell, std::vector<std::string>* notes)
{
    if (!(scale > 0.0) || !std::isfinite(scale)) throw InputError(file.string() + ": scale must be a positive number");
    TriangleMesh mesh = readObj(file);
    for (Vec3& v : mesh.vertices) v *= scale;
    try {
        return Shape::mesh(mesh.vertices, mesh.triangles, cell, notes);
    } catch (const InputError& e) {
        throw InputError(file.string() + ": " + e.what());
    }
}

}  // namespace sim

#pragma once

#include "sim/core/types.h"
#include "sim/scene/choice.h"
#include "sim/scene/ignores_reading.h"
#include "sim/scene/node.h"
#include "sim/scene/range.h"
#include "sim/scene/units.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace sim {

/// Visitor of the declarations in describe.h: writes a struct as YAML in cgs, every value with `# [unit] help`.
/// What it writes reads back to the same struct.
class SectionWriter : public IgnoresReading {
 public:
    explicit SectionWriter(int depth = 0) : depth_(depth) {}

    /// Puts what follows deeper, for the fields of a list's elements.
    void indentBy(int levels) { depth_ += levels; }

    /// The lines written so far, comments aligned.
    std::string take() const;
    /// All written so far on one line, without comments: "{center: [0, 0, 0], radius: 1}".
    std::string flow() const;
    /// One line: a key and its value as YAML flow text, and the comment.
    void line(const std::string& key, const std::string& value, const std::string& comment);
    /// One element of a list, as YAML flow text.
    void item(const std::string& value) { lines_.push_back({std::string(static_cast<std::size_t>(2 * depth_), ' ') + "- " + value, ""}); }
    /// A line "key:" with everything `inner` writes below it.
    template <class Inner>
    void below(const std::string& key, const char* help, Inner inner)
    {
        SectionWriter deeper(depth_ + 1);
        inner(deeper);
        if (deeper.lines_.empty()) return;
        line(key, "", help);
        lines_.insert(lines_.end(), deeper.lines_.begin(), deeper.lines_.end());
    }

    void number(const char* key, double& x, Quantity q, Range, const char* help) { line(key, formatNumber(x, q), comment(q, help)); }
    void numberOr(const char* key, double& x, double unset, Quantity q, Range range, const char* help)
    {
        if (x != unset) number(key, x, q, range, help);
    }
    void numberOrWord(const char* key, const NumberOrWord& x, Quantity q, Range, const char* help)
    {
        line(key, x.isWord ? x.word : formatNumber(x.number, q), comment(q, help));
    }
    void integer(const char* key, int& x, int, int, const char* help) { line(key, std::to_string(x), help); }
    void seed(const char* key, std::uint64_t& x, const char* help) { line(key, std::to_string(x), help); }
    void flag(const char* key, bool& x, const char* help) { line(key, x ? "true" : "false", help); }
    void text(const char* key, std::string& x, const char* help)
    {
        if (!x.empty()) line(key, Node::scalar(x, {}).flow(), help);
    }
    void texts(const char* key, std::vector<std::string>& all, const char* help);
    template <class E>
    void choice(const char* key, E& x, const char* help)
    {
        std::string words, chosen;
        for (const Choice<E>& c : choicesOf(x)) {
            if (c.value == x) chosen = c.word;
            words += (words.empty() ? "" : " | ") + std::string(c.word);
        }
        line(key, chosen, std::string(help) + ": " + words);
    }
    void vector(const char* key, Vec3& x, Quantity q, const char* help) { numbers(key, {x.data(), 3}, q, help); }
    void pair(const char* key, std::array<double, 2>& x, Quantity q, Range, const char* help) { numbers(key, x, q, help); }
    void numberOrPair(const char* key, std::array<double, 2>& x, Quantity q, Range range, const char* help)
    {
        if (x[0] == x[1]) return number(key, x[0], q, range, help);
        numbers(key, x, q, help);
    }
    void counts(const char* key, Eigen::Vector2i& n, int low, int high, const char* help) { pixels(key, n[0], n[1], low, high, help); }
    void pixels(const char* key, int& width, int& height, int, int, const char* help)
    {
        std::string list = "[";
        list += std::to_string(width) + ", " + std::to_string(height) + "]";
        line(key, list, help);
    }
    void color(const char* key, Eigen::Vector3f& x, const char* help);
    void flags(const char* key, std::initializer_list<NamedFlag> all, const char* help);
    void either(const char* key, bool& x, const char* yes, const char* no, const char* help)
    {
        line(key, x ? yes : no, std::string(help) + ": " + yes + " | " + no);
    }
    template <class T>
    void section(const char* key, T& x, const char* help)
    {
        below(key, help, [&](SectionWriter& w) { visitFields(w, x); });
    }
    template <class Fields>
    void group(const char* key, const char* help, Fields fields)
    {
        below(key, help, fields);
    }
    template <class T, class Field>
    void perPhase(const char* key, T& liquid, T& fabric, Field field)
    {
        if (liquid == fabric) {
            field(*this, key, liquid);
            return;
        }
        below(key, "", [&](SectionWriter& w) {
            field(w, "liquid", liquid);
            field(w, "fabric", fabric);
        });
    }
    template <class Fields>
    void when(bool holds, Fields fields)
    {
        if (holds) fields(*this);
    }
    template <class Fields>
    void fixed(Fields fields)
    {
        fields(*this);
    }

 private:
    struct Line {
        std::string text, comment;
    };

    static std::string comment(Quantity quantity, const char* help);
    void numbers(const char* key, std::span<double> values, Quantity quantity, const char* help);

    int depth_;
    std::vector<Line> lines_;
};

}  // namespace sim

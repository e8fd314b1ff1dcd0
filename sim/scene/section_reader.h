#pragma once

#include "sim/core/types.h"
#include "sim/scene/choice.h"
#include "sim/scene/key_list.h"
#include "sim/scene/node.h"
#include "sim/scene/range.h"
#include "sim/scene/units.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

// Visitor of the declarations in describe.h that fills a struct.

namespace sim {

/// One number, vector or word; `path` names it in messages. Throw InputError.
double readNumber(const Node& node, const std::string& path, Quantity quantity, const Range& range);
void readNumbers(const Node& node, const std::string& path, std::span<double> out, Quantity quantity, const Range& range);
std::int64_t readInteger(const Node& node, const std::string& path, std::int64_t low, std::int64_t high);
std::uint64_t readSeed(const Node& node, const std::string& path);
bool readFlag(const Node& node, const std::string& path);
const std::string& readText(const Node& node, const std::string& path);
/// The number of the word in the list.
std::size_t readChoice(const Node& node, const std::string& path, const std::vector<std::string>& words);
void readNamedFlags(const Node& node, const std::string& path, std::span<const NamedFlag> flags);
std::vector<std::string> readTexts(const Node& node, const std::string& path);

/// Fills a struct from a map. What the map does not say keeps its value; a value that is wrong throws InputError.
class SectionReader {
 public:
    /// Throws InputError if the node is no map; `path` names it in messages.
    SectionReader(const Node& node, std::string path);

    bool has(const char* key) const { return find(key) != nullptr; }
    const Node* find(const char* key) const { return node_.find(key); }
    const std::string& path() const { return path_; }
    const SourceLocation& location() const { return node_.location; }
    std::string pathOf(const char* key) const { return joinPath(path_, key); }
    /// The line of the key, or of the section where the key is missing.
    SourceLocation locationOf(const char* key) const;

    void number(const char* key, double& out, Quantity quantity, Range range, const char*)
    {
        if (const Node* n = find(key)) out = readNumber(*n, pathOf(key), quantity, range);
    }
    /// A number that may be left out, in which case it has a value of its own, `unset`.
    void numberOr(const char* key, double& out, double, Quantity quantity, Range range, const char* help) { number(key, out, quantity, range, help); }
    /// Either a number, or the word that sets the flag.
    void numberOrWord(const char* key, const NumberOrWord& out, Quantity quantity, Range range, const char* help);
    void integer(const char* key, int& out, int low, int high, const char*)
    {
        if (const Node* n = find(key)) out = static_cast<int>(readInteger(*n, pathOf(key), low, high));
    }
    void seed(const char* key, std::uint64_t& out, const char*)
    {
        if (const Node* n = find(key)) out = readSeed(*n, pathOf(key));
    }
    void flag(const char* key, bool& out, const char*)
    {
        if (const Node* n = find(key)) out = readFlag(*n, pathOf(key));
    }
    void text(const char* key, std::string& out, const char*)
    {
        if (const Node* n = find(key)) out = readText(*n, pathOf(key));
    }
    void texts(const char* key, std::vector<std::string>& out, const char*)
    {
        if (const Node* n = find(key)) out = readTexts(*n, pathOf(key));
    }
    template <class E>
    void choice(const char* key, E& out, const char*)
    {
        const Node* n = find(key);
        if (!n) return;
        std::vector<std::string> words;
        for (const Choice<E>& c : choicesOf(out)) words.emplace_back(c.word);
        out = choicesOf(out)[readChoice(*n, pathOf(key), words)].value;
    }
    void vector(const char* key, Vec3& out, Quantity quantity, const char*)
    {
        if (const Node* n = find(key)) readNumbers(*n, pathOf(key), {out.data(), 3}, quantity, Range::any());
    }
    void pair(const char* key, std::array<double, 2>& out, Quantity quantity, Range range, const char*)
    {
        if (const Node* n = find(key)) readNumbers(*n, pathOf(key), out, quantity, range);
    }
    /// A list of two numbers, or one that stands for both.
    void numberOrPair(const char* key, std::array<double, 2>& out, Quantity quantity, Range range, const char*);
    void pixels(const char* key, int& width, int& height, int low, int high, const char*);
    /// A list of two whole numbers.
    void counts(const char* key, Eigen::Vector2i& out, int low, int high, const char*);
    void color(const char* key, Eigen::Vector3f& out, const char*);
    void flags(const char* key, std::initializer_list<NamedFlag> all, const char*)
    {
        if (const Node* n = find(key)) readNamedFlags(*n, pathOf(key), {all.begin(), all.size()});
    }
    /// Either of two words.
    void either(const char* key, bool& out, const char* yes, const char* no, const char*)
    {
        if (const Node* n = find(key)) out = readChoice(*n, pathOf(key), {yes, no}) == 0;
    }
    template <class T>
    void section(const char* key, T& out, const char*)
    {
        read(find(key), pathOf(key), [&](auto& v) { visitFields(v, out); });
    }
    template <class Fields>
    void group(const char* key, const char*, Fields fields)
    {
        read(find(key), pathOf(key), fields);
    }
    /// One value for both phases, or {liquid: …, fabric: …}.
    template <class T, class Field>
    void perPhase(const char* key, T& liquid, T& fabric, Field field)
    {
        const Node* n = find(key);
        if (n && n->isMap()) {
            read(n, pathOf(key), [&](auto& v) {
                field(v, "liquid", liquid);
                field(v, "fabric", fabric);
            });
        } else {
            field(*this, key, liquid);
            field(*this, key, fabric);
        }
    }
    /// Fields that are printed only under a condition.
    template <class Fields>
    void when(bool, Fields fields)
    {
        fields(*this);
    }
    /// Fields that hold for a whole run.
    template <class Fields>
    void fixed(Fields fields)
    {
        fields(*this);
    }
    template <class Action>
    void whenReading(Action action)
    {
        action(*this);
    }
    /// A choice of which this version runs one.
    void onlySupports(const char* key, const char* word, std::initializer_list<const char*> others, const char*);
    /// A key that this version knows and refuses.
    void unsupported(const char* key, const char* message);
    /// A key that other code reads.
    void other(const char*, const char*) {}
    void formula(const char*, const char*) {}
    void required(const char* key, const char* what);
    void require(bool isMet, const char* key, const std::string& message);

    /// Reads one map by a declaration: first are there only keys it knows, then its fields. Without a map everything
    /// keeps its value.
    template <class Fields>
    static void read(const Node* node, const std::string& path, Fields fields)
    {
        if (!node) return;
        SectionReader reader(*node, path);
        KeyList known;
        fields(known);
        if (const auto& source = node->location.source; source && source->listener) source->listener(known);
        reader.refuseKeysBut(known.names(), known.unsupportedKeys);
        fields(reader);
    }

    /// Throws at the first key that is not one of these; only those of the first list are suggested.
    void refuseKeysBut(const std::vector<std::string>& known, const std::vector<std::string>& later = {}) const;

 private:
    const Node& node_;
    std::string path_;
};

}  // namespace sim

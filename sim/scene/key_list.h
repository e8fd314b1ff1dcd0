#pragma once

#include "sim/core/types.h"
#include "sim/scene/choice.h"
#include "sim/scene/range.h"
#include "sim/scene/units.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sim {

/// A key that a map of a scene may have, as its declaration has it.
struct DeclaredKey {
    enum class Kind {
        Number,   ///< a number; NumberOrWord, where there are words
        Numbers,  ///< a list of `count`
        NumberOrPair,
        Integer,
        Integers,  ///< a list of two
        Flag,
        Text,
        Texts,
        Word,      ///< one of `words`
        Words,     ///< a list of some of `words`
        Map,       ///< a map with the keys `below`
        PerPhase,  ///< as below.front(), or a map with both of `below`
        Formula,   ///< read by other code, which knows the names in it
        Other,     ///< read by other code
    };

    std::string name;
    Kind kind = Kind::Other;
    std::string_view help;
    Quantity quantity = Quantity::None;
    Range range = Range::any();
    std::size_t count = 1;
    std::vector<std::string> words;
    std::vector<DeclaredKey> below;
    std::array<double, 3> values{};  ///< values of numbers where the map does not say them; NaN: none
    std::string word = {};           ///< value of words and texts where the map does not say it
    bool isNeeded = false;
};

/// Visitor of the declarations: what keys there are, and all that is said of them.
class KeyList {
 public:
    std::vector<DeclaredKey> keys;
    std::vector<std::string> unsupportedKeys;  ///< known, and refused in this version

    std::vector<std::string> names() const
    {
        std::vector<std::string> all;
        for (const DeclaredKey& key : keys) all.push_back(key.name);
        return all;
    }

    void number(const char* key, double& x, Quantity quantity, Range range, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Number, help);
        k.quantity = quantity;
        k.range = range;
        k.values[0] = x;
    }
    void numberOr(const char* key, double& x, double unset, Quantity quantity, Range range, const char* help)
    {
        number(key, x, quantity, range, help);
        if (x == unset) keys.back().values[0] = std::numeric_limits<double>::quiet_NaN();
    }
    void numberOrWord(const char* key, const NumberOrWord& x, Quantity quantity, Range range, const char* help)
    {
        number(key, x.number, quantity, range, help);
        keys.back().words = {x.word};
        if (x.isWord) keys.back().word = x.word;
    }
    void integer(const char* key, int& x, int low, int high, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Integer, help);
        k.range = Range::between(low, high);
        k.values[0] = x;
    }
    void seed(const char* key, std::uint64_t& x, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Integer, help);
        k.range = Range::atLeast(0.0);
        k.values[0] = static_cast<double>(x);
    }
    void flag(const char* key, bool& x, const char* help) { add(key, DeclaredKey::Kind::Flag, help).values[0] = x ? 1.0 : 0.0; }
    void text(const char* key, std::string& x, const char* help) { add(key, DeclaredKey::Kind::Text, help).word = x; }
    void texts(const char* key, std::vector<std::string>&, const char* help) { add(key, DeclaredKey::Kind::Texts, help); }
    template <class E>
    void choice(const char* key, E& x, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Word, help);
        for (const Choice<E>& c : choicesOf(x)) {
            k.words.emplace_back(c.word);
            if (c.value == x && k.word.empty()) k.word = c.word;
        }
    }
    void vector(const char* key, Vec3& x, Quantity quantity, const char* help)
    {
        numbers(key, 3, quantity, Range::any(), help).values = {x[0], x[1], x[2]};
    }
    void pair(const char* key, std::array<double, 2>& x, Quantity quantity, Range range, const char* help)
    {
        numbers(key, 2, quantity, range, help).values = {x[0], x[1], 0.0};
    }
    void numberOrPair(const char* key, std::array<double, 2>& x, Quantity quantity, Range range, const char* help)
    {
        pair(key, x, quantity, range, help);
        keys.back().kind = DeclaredKey::Kind::NumberOrPair;
    }
    void pixels(const char* key, int& width, int& height, int low, int high, const char* help)
    {
        DeclaredKey& k = numbers(key, 2, Quantity::None, Range::between(low, high), help);
        k.kind = DeclaredKey::Kind::Integers;
        k.values = {static_cast<double>(width), static_cast<double>(height), 0.0};
    }
    void counts(const char* key, Eigen::Vector2i& x, int low, int high, const char* help) { pixels(key, x[0], x[1], low, high, help); }
    void color(const char* key, Eigen::Vector3f& x, const char* help)
    {
        numbers(key, 3, Quantity::None, Range::between(0.0, 1.0), help).values = {x[0], x[1], x[2]};
    }
    void flags(const char* key, std::initializer_list<NamedFlag> all, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Words, help);
        for (const NamedFlag& f : all) k.words.emplace_back(f.word);
    }
    void either(const char* key, bool& x, const char* yes, const char* no, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Word, help);
        k.words = {yes, no};
        k.word = x ? yes : no;
    }
    template <class T>
    void section(const char* key, T& x, const char* help)
    {
        group(key, help, [&](KeyList& inner) { visitFields(inner, x); });
    }
    template <class Fields>
    void group(const char* key, const char* help, Fields fields)
    {
        KeyList inner;
        fields(inner);
        add(key, DeclaredKey::Kind::Map, help).below = std::move(inner.keys);
    }
    template <class T, class Field>
    void perPhase(const char* key, T& liquid, T& fabric, Field field)
    {
        KeyList inner;
        field(inner, "liquid", liquid);
        field(inner, "fabric", fabric);
        add(key, DeclaredKey::Kind::PerPhase, "").below = std::move(inner.keys);
    }
    template <class Fields>
    void when(bool, Fields fields)
    {
        fields(*this);
    }
    template <class Fields>
    void fixed(Fields fields)
    {
        fields(*this);
    }
    template <class Action>
    void whenReading(Action)
    {
    }
    void onlySupports(const char* key, const char* word, std::initializer_list<const char*>, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Word, help);
        k.words = {word};
        k.word = word;
    }
    void unsupported(const char* key, const char*) { unsupportedKeys.emplace_back(key); }
    void other(const char* key, const char* help) { add(key, DeclaredKey::Kind::Other, help); }
    void formula(const char* key, const char* help) { add(key, DeclaredKey::Kind::Formula, help); }
    void required(const char* key, const char* what) { needed_.emplace_back(key, what); }
    void require(bool, const char*, const std::string&) {}

 private:
    DeclaredKey& add(const char* key, DeclaredKey::Kind kind, const char* help)
    {
        DeclaredKey& k = keys.emplace_back();
        k.name = key;
        k.kind = kind;
        k.help = help;
        for (const auto& [needed, what] : needed_)
            if (k.name == needed) {
                k.isNeeded = true;
                if (k.help.empty()) k.help = what;
            }
        return k;
    }
    DeclaredKey& numbers(const char* key, std::size_t count, Quantity quantity, Range range, const char* help)
    {
        DeclaredKey& k = add(key, DeclaredKey::Kind::Numbers, help);
        k.count = count;
        k.quantity = quantity;
        k.range = range;
        return k;
    }

    std::vector<std::pair<std::string, const char*>> needed_;  ///< keys that have to be there, and what they are for
};

}  // namespace sim

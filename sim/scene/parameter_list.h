#pragma once

#include "sim/scene/choice.h"
#include "sim/scene/ignores_reading.h"
#include "sim/scene/key_list.h"
#include "sim/scene/parameters.h"
#include "sim/scene/source_location.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace sim {

/// Visitor of the declarations: a Parameter for every plain setting.
class ParameterList : public IgnoresReading {
 public:
    ParameterList(std::vector<Parameter>& all, std::string path) : all_(all), path_(std::move(path)) {}

    void number(const char* key, double& x, Quantity q, Range range, const char* help)
    {
        Parameter& p = add(key, Parameter::Kind::Number, formatNumber(x, q), help);
        p.unit = unitOf(q);
        p.range = range;
    }
    void numberOr(const char* key, double& x, double unset, Quantity q, Range range, const char* help)
    {
        number(key, x, q, range, help);
        if (x == unset) all_.back().value.clear();
    }
    void numberOrWord(const char* key, const NumberOrWord& x, Quantity q, Range range, const char* help)
    {
        number(key, x.number, q, range, help);
        if (x.isWord) all_.back().value = x.word;
    }
    void integer(const char* key, int& x, int low, int high, const char* help)
    {
        add(key, Parameter::Kind::Integer, std::to_string(x), help).range = Range::between(low, high);
    }
    void flag(const char* key, bool& x, const char* help) { add(key, Parameter::Kind::Flag, x ? "true" : "false", help); }
    template <class E>
    void choice(const char* key, E& x, const char* help)
    {
        Parameter& p = add(key, Parameter::Kind::Word, "", help);
        for (const Choice<E>& c : choicesOf(x)) {
            p.words.emplace_back(c.word);
            if (c.value == x && p.value.empty()) p.value = c.word;
        }
    }
    void vector(const char* key, Vec3& x, Quantity q, const char* help)
    {
        const std::string list = fmt::format("[{}, {}, {}]", formatNumber(x[0], q), formatNumber(x[1], q), formatNumber(x[2], q));
        add(key, Parameter::Kind::Numbers, list, help).unit = unitOf(q);
    }
    void pair(const char* key, std::array<double, 2>& x, Quantity q, Range range, const char* help)
    {
        Parameter& p = add(key, Parameter::Kind::Numbers, fmt::format("[{}, {}]", formatNumber(x[0], q), formatNumber(x[1], q)), help);
        p.unit = unitOf(q);
        p.range = range;
    }
    void numberOrPair(const char* key, std::array<double, 2>& x, Quantity q, Range range, const char* help) { pair(key, x, q, range, help); }
    void color(const char* key, Eigen::Vector3f& x, const char* help)
    {
        add(key, Parameter::Kind::Numbers, fmt::format("[{:.4g}, {:.4g}, {:.4g}]", x[0], x[1], x[2]), help).range = Range::between(0.0, 1.0);
    }
    void pixels(const char* key, int& width, int& height, int low, int high, const char* help)
    {
        add(key, Parameter::Kind::Numbers, fmt::format("[{}, {}]", width, height), help).range = Range::between(low, high);
    }
    template <class T>
    void section(const char* key, T& x, const char*)
    {
        ParameterList inner = below(key);
        visitFields(inner, x);
    }
    template <class Fields>
    void group(const char* key, const char*, Fields fields)
    {
        ParameterList inner = below(key);
        fields(inner);
    }
    template <class T, class Field>
    void perPhase(const char* key, T& liquid, T& fabric, Field field)
    {
        ParameterList inner = below(key);
        field(inner, "liquid", liquid);
        field(inner, "fabric", fabric);
    }
    template <class Fields>
    void fixed(Fields fields)
    {
        ParameterList inner = *this;
        inner.isFixed_ = true;
        fields(inner);
    }
    template <class Fields>
    void when(bool holds, Fields fields)
    {
        if (holds) fields(*this);
    }

 private:
    ParameterList below(const char* key) const
    {
        ParameterList inner = *this;
        inner.path_ = joinPath(path_, key);
        return inner;
    }
    Parameter& add(const char* key, Parameter::Kind kind, std::string value, const char* help)
    {
        Parameter& p = all_.emplace_back();
        p.path = joinPath(path_, key);
        p.kind = kind;
        p.value = std::move(value);
        p.help = help;
        p.isFixed = isFixed_;
        return p;
    }

    std::vector<Parameter>& all_;
    std::string path_;
    bool isFixed_ = false;
};

}  // namespace sim

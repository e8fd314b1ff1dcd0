#include "sim/scene/parameters.h"

#include "sim/scene/describe.h"
#include "sim/scene/describe_fabric.h"
#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace sim {

namespace {

/// Visitor of the declarations: a Parameter for every plain setting that a run depends on.
class ParameterList {
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
    template <class T>
    void section(const char* key, T& x, const char*)
    {
        ParameterList inner = below(key);
        describe(inner, x);
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
    template <class Action>
    void whenReading(Action)
    {
    }
    void onlyRuns(const char*, const char*, std::initializer_list<const char*>, const char*) {}
    void later(const char*, const char*) {}
    void other(const char*, const char*) {}
    void needs(const char*, const char*) {}
    void require(bool, const char*, const std::string&) {}

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

/// Digits and what goes with them, no unit.
bool isBare(const std::string& numbers)
{
    return std::ranges::all_of(numbers, [](unsigned char c) {
        return std::isdigit(c) || std::string_view("+-.eE, []").find(static_cast<char>(c)) != std::string_view::npos;
    });
}

}  // namespace

std::string overrideText(const Parameter& parameter, const std::string& value)
{
    std::string said;
    const bool takesUnit = !parameter.unit.empty() && isBare(value);
    for (const char c : value) {
        if (takesUnit && parameter.kind == Parameter::Kind::Numbers && (c == ',' || c == ']')) said += " " + parameter.unit;
        said += c;
    }
    if (takesUnit && parameter.kind == Parameter::Kind::Number) said += " " + parameter.unit;
    return parameter.path + "=" + said;
}

std::vector<Parameter> parametersOf(const Settings& settings, const std::vector<NamedMaterial>& materials)
{
    std::vector<Parameter> all;
    Settings values = settings;
    ParameterList top(all, "");
    describe(top, values);
    ParameterList liquid(all, "liquid");
    describe(liquid, values.liquid);
    describeFabric(top, values);
    for (const NamedMaterial& named : materials) {
        FabricMaterial material = named.material;
        ParameterList inner(all, joinPath("materials", named.name));
        describe(inner, material);
    }
    return all;
}

}  // namespace sim

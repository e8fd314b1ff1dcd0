#include "sim/scene/formula.h"

#include "sim/core/units.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sim {

struct Formula::Parser {
    struct Bound {
        FormulaNames::Function function;
        const Parser* parser;

        static double call(void* data, std::span<const double> arguments)
        {
            const Bound& bound = *static_cast<const Bound*>(data);
            return bound.parser->isTrial ? 1.0 : bound.function.value(arguments);
        }
        static double call1(void* data, double a) { return call(data, std::array{a}); }
        static double call2(void* data, double a, double b) { return call(data, std::array{a, b}); }
        static double call3(void* data, double a, double b, double c) { return call(data, std::array{a, b, c}); }
    };

    static double callOfName(void* data, const char* name) { return static_cast<const FormulaNames::OfName*>(data)->value(name); }

    mu::Parser parser;
    std::vector<FormulaNames::OfName> ofNames;
    std::vector<double> values;
    std::vector<Bound> functions;  ///< functions with arguments
    struct Measured {
        FormulaNames::Function function;
        double value = 1.0;
        bool isUsed = false;
    };
    std::vector<Measured> measured;  ///< functions without arguments: variables that are looked up before each evaluation
    bool isTrial = true;             ///< evaluated to find what is wrong with the formula itself

    void define(Bound& bound)
    {
        constexpr bool kMayBeFolded = false;
        switch (bound.function.arguments) {
            case 1: return parser.DefineFunUserData(bound.function.name, Bound::call1, &bound, kMayBeFolded);
            case 2: return parser.DefineFunUserData(bound.function.name, Bound::call2, &bound, kMayBeFolded);
            default: return parser.DefineFunUserData(bound.function.name, Bound::call3, &bound, kMayBeFolded);
        }
    }
};

Formula::Formula(std::string text, const FormulaNames& names) : text_(std::move(text)), parser_(std::make_shared<Parser>())
{
    Parser& p = *parser_;
    p.values.resize(names.variables.size());
    p.ofNames = names.ofNames;
    for (const FormulaNames::Function& function : names.functions)
        if (function.arguments > 0) p.functions.push_back({function, &p});
        else p.measured.push_back({function});
    try {
        p.parser.DefineConst("pi", kPi);
        for (std::size_t i = 0; i < names.variables.size(); ++i) p.parser.DefineVar(names.variables[i], &p.values[i]);
        for (const auto& [name, value] : names.constants) p.parser.DefineConst(name, value);
        for (Parser::Bound& bound : p.functions) p.define(bound);
        for (FormulaNames::OfName& of : p.ofNames) p.parser.DefineFunUserData(of.name, Parser::callOfName, &of, false);
        for (Parser::Measured& measured : p.measured) p.parser.DefineVar(measured.function.name, &measured.value);
        p.parser.SetExpr(text_);
        p.parser.Eval();
        const auto& used = p.parser.GetUsedVar();
        for (Parser::Measured& measured : p.measured) measured.isUsed = used.contains(measured.function.name);
        p.isTrial = false;
    } catch (const mu::Parser::exception_type& error) {
        throw FormulaError(error.GetMsg());
    }
}

double Formula::operator()(std::span<const double> values) const
{
    std::copy(values.begin(), values.end(), parser_->values.begin());
    for (Parser::Measured& measured : parser_->measured)
        if (measured.isUsed) measured.value = measured.function.value({});
    double value = 0.0;
    try {
        value = parser_->parser.Eval();
    } catch (const mu::Parser::exception_type& error) {
        throw FormulaError(error.GetMsg());
    }
    if (!std::isfinite(value)) throw FormulaError("has no finite value");
    return value;
}

}  // namespace sim

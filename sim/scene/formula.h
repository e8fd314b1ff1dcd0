#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sim {

/// What is wrong with a formula of a scene file, or with its value.
struct FormulaError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Names that a formula may use beside pi and the functions of muParser.
struct FormulaNames {
    struct Function {
        std::string name;
        int arguments = 0;  ///< 0 to 3; without any it is written without parentheses
        std::function<double(std::span<const double>)> value;
    };
    /// A function of something that the scene has, called as in force_y("ball").
    struct OfName {
        std::string name;
        std::function<double(const std::string&)> value;  ///< throws FormulaError where there is no such thing, also before there is a value
    };
    std::vector<std::string> variables = {};
    std::map<std::string, double> constants = {};
    std::vector<Function> functions = {};  ///< not called before the formula is evaluated
    std::vector<OfName> ofNames = {};      ///< called when the formula is read, too, to find names that are wrong
};

/// A formula that a scene gives as text, like "1 - exp(-2*t)". Copies share their workspace: one thread at a time.
class Formula {
 public:
    /// Throws FormulaError where the text is no formula of these names.
    explicit Formula(std::string text, const FormulaNames& names = {});

    const std::string& text() const { return text_; }
    /// Throws FormulaError where there is no finite value.
    /// @param values  of the variables, in their order
    double operator()(std::span<const double> values = {}) const;

 private:
    struct Parser;
    std::string text_;
    std::shared_ptr<Parser> parser_;
};

}  // namespace sim

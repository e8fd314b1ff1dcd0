#include "sim/scene/velocity_field.h"

#include "sim/core/units.h"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>

namespace sim {

struct VelocityField::Parsers {
    Vec3 x = Vec3::Zero();
    std::array<mu::Parser, kAxes> of;

    double value(int component, const Vec3& where)
    {
        x = where;
        double value = 0.0;
        try {
            value = of[component].Eval();
        } catch (const mu::Parser::exception_type& error) {
            throw Mistake{component, error.GetMsg()};
        }
        if (!std::isfinite(value))
            throw Mistake{component, fmt::format("has no finite value at ({:.4g}, {:.4g}, {:.4g}) cm", where[0],
                                                 where[1], where[2])};
        return value;
    }
};

VelocityField::VelocityField(const std::array<std::string, kAxes>& formulas)
    : formulas_(formulas), parsers_(std::make_shared<Parsers>())
{
    for (int a = 0; a < kAxes; ++a) {
        mu::Parser& parser = parsers_->of[a];
        parser.DefineConst("pi", kPi);
        for (int b = 0; b < kAxes; ++b) parser.DefineVar(std::string(1, "xyz"[b]), &parsers_->x[b]);
        try {
            parser.SetExpr(formulas[a]);
            parser.Eval();  // finds what is wrong with the formula itself
        } catch (const mu::Parser::exception_type& error) {
            throw Mistake{a, error.GetMsg()};
        }
    }
}

Vec3 VelocityField::at(const Vec3& x) const
{
    return {parsers_->value(0, x), parsers_->value(1, x), parsers_->value(2, x)};
}

Mat3 VelocityField::gradient(const Vec3& x, double h) const
{
    Mat3 gradient;
    for (int b = 0; b < kAxes; ++b) {
        const Vec3 step = h * Vec3::Unit(b);
        gradient.col(b) = (at(x + step) - at(x - step)) / (2.0 * h);
    }
    return gradient;
}

}  // namespace sim

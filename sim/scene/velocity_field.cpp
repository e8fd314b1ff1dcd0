#include "sim/scene/velocity_field.h"

#include <fmt/format.h>

namespace sim {

VelocityField::VelocityField(const std::array<std::string, kAxes>& formulas)
{
    for (int a = 0; a < kAxes; ++a) try {
            of_.emplace_back(formulas[a], FormulaNames{.variables = {"x", "y", "z"}});
        } catch (const FormulaError& error) {
            throw Mistake{a, error.what()};
        }
}

Vec3 VelocityField::at(const Vec3& x) const
{
    Vec3 velocity;
    for (int a = 0; a < kAxes; ++a) try {
            velocity[a] = of_[a]({x.data(), 3});
        } catch (const FormulaError& error) {
            throw Mistake{a, fmt::format("{} at ({:.4g}, {:.4g}, {:.4g}) cm", error.what(), x[0], x[1], x[2])};
        }
    return velocity;
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

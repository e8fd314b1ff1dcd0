#include "sim/particles/velocity_modes.h"

namespace sim {

namespace {

double power(double z, int degree) { return degree == 0 ? 1.0 : degree == 1 ? z : z * z; }

/// Replace the triple of coefficients along one axis, (c0, c1, c2), by f of it, for all degrees of the other two axes.
template <class F>
Modes alongEachAxis(const Modes& c, F&& f)
{
    static constexpr auto kMode = [] {
        std::array<std::array<std::array<int, 3>, 3>, 3> table{};
        for (int r = 0; r < kMaxModes; ++r) table[kDegrees[r][0]][kDegrees[r][1]][kDegrees[r][2]] = r;
        return table;
    }();
    Modes out = c;
    for (int axis = 0; axis < kAxes; ++axis)
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                const auto at = [&](int degree) -> double& {
                    return out[axis == 0 ? kMode[degree][a][b] : axis == 1 ? kMode[a][degree][b] : kMode[a][b][degree]];
                };
                f(axis, at(0), at(1), at(2));
            }
    return out;
}

}  // namespace

double evaluateModes(const Vec3& z, const Modes& c)
{
    double u = 0.0;
    for (int r = 0; r < kMaxModes; ++r) u += c[r] * power(z.x(), kDegrees[r][0]) * power(z.y(), kDegrees[r][1]) * power(z.z(), kDegrees[r][2]);
    return u;
}

double evaluateModes(const Basis& basis, const Vec3i& node, const Modes& c)
{
    return evaluateModes(Vec3(basis[0].z[node.x()], basis[1].z[node.y()], basis[2].z[node.z()]), c);
}

void projectOntoModes(const Basis& basis, const Vec3i& node, double u, int modes, Modes& c)
{
    const auto &x = basis[0].project[node.x()], &y = basis[1].project[node.y()], &z = basis[2].project[node.z()];
    for (int r = 0; r < modes; ++r) c[r] += u * x[kDegrees[r][0]] * y[kDegrees[r][1]] * z[kDegrees[r][2]];
}

Modes toMonomials(const Basis& basis, const Modes& orthogonal)
{
    return alongEachAxis(orthogonal, [&](int axis, double& c0, double& c1, double& c2) {
        c0 -= 0.25 * c2;
        c1 -= basis[axis].skew * c2;
    });
}

Modes toOrthogonal(const Basis& basis, const Modes& monomial)
{
    return alongEachAxis(monomial, [&](int axis, double& c0, double& c1, double& c2) {
        c0 += 0.25 * c2;
        c1 += basis[axis].skew * c2;
    });
}

double meanOf(const Modes& monomial)
{
    double mean = 0.0;
    for (int r = 0; r < kMaxModes; ++r) mean += kMeanOfMode[r] * monomial[r];
    return mean;
}

}  // namespace sim

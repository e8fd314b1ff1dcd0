#include "sim/coupling/porous_law.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double kSeriesEnd = 0.4;              ///< fraction up to which the series for flow across holds [-]
constexpr double kLeastPermeability = 1.0e-20;  ///< [cm^2]
constexpr double kErgun = 0.14288690166235205;  ///< 1.75 / √150 (coupling/README.md, Drag) [-]
constexpr double kMostDrag = 1.0e63;            ///< most drag, where permeability all but vanishes [g/(cm^3 s)]

/// Permeability along fibres that fill the fraction f, in squares of the fibre diameter.
double permeabilityAlong(double f) { return (-std::log(f) - 1.476 + 2.0 * f - 0.5 * f * f) / (16.0 * f); }
double seriesAcross(double f) { return (-std::log(f) - 1.476 + 2.0 * f - 1.774 * f * f + 4.078 * f * f * f) / (32.0 * f); }

}  // namespace

Permeability permeability(double fraction, double fibreDiameter)
{
    const double along = permeabilityAlong(fraction);
    const double across = fraction <= kSeriesEnd ? seriesAcross(fraction) : seriesAcross(kSeriesEnd) * along / permeabilityAlong(kSeriesEnd);
    const double d2 = fibreDiameter * fibreDiameter;
    return {std::max(d2 * along, kLeastPermeability), std::max(d2 * across, kLeastPermeability)};
}

PorousLaw::PorousLaw(const PorousSettings& porous, const LiquidSettings& liquid, const CouplingSettings& coupling)
    : fibreDiameter_(porous.fibreDiameter),
      suctionScale_(porous.poreRadius() > 0.0 ? liquid.surfaceTension * std::max(std::cos(liquid.contactAngle), 0.0) / porous.poreRadius() : 0.0),
      density_(liquid.density),
      viscosity_(liquid.viscosity),
      law_(coupling.drag),
      exponent_(coupling.dragExponent),
      speedOfOne_(viscosity_ / (density_ * fibreDiameter_))
{
}

double PorousLaw::suction(double fraction) const { return fraction < 1.0 ? fraction / (1.0 - fraction) * suctionScale_ : 0.0; }

double PorousLaw::captureRate(double fraction, double cell) const
{
    if (!(fraction > 0.0)) return 1.0;
    return permeability(fraction, fibreDiameter_).across * suction(fraction) / (cell * cell * viscosity_);
}

/// What is not linear in the speed, times the root of the permeability [g/(cm^2 s)].
double PorousLaw::inertialDrag(double fraction, double speed) const
{
    if (law_ != DragLaw::Nonlinear || !(speed > 0.0)) return 0.0;
    const double reynolds = speed / speedOfOne_;
    return kErgun * density_ * speed * std::pow(reynolds, exponent_ - 1.0) / ((1.0 - fraction) * std::sqrt(1.0 - fraction));
}

double PorousLaw::dragOf(double k, double fraction, double inertial) const
{
    if (law_ == DragLaw::Off || !(fraction > 0.0)) return 0.0;
    return std::min(viscosity_ / k + inertial / std::sqrt(k), kMostDrag);
}

double PorousLaw::speedUnder(double force, double k, double fraction) const
{
    constexpr int kMostIterations = 20;
    constexpr double kLastChange = 1.0e-5;  // relative; Newton's next error is its square
    const double linear = drag(k, fraction, 0.0);
    if (!(linear > 0.0 && force > 0.0)) return 0.0;
    double u = force / linear;
    const double atOne = law_ == DragLaw::Nonlinear ? drag(k, fraction, speedOfOne_) - linear : 0.0;
    if (!(atOne > 0.0)) return u;
    // Newton from above, where the force of drag, which grows faster than the speed, leads it down to the root.
    u = std::min(u, speedOfOne_ * std::pow(force / (atOne * speedOfOne_), 1.0 / (1.0 + exponent_)));
    for (int n = 0; n < kMostIterations; ++n) {
        const double c = drag(k, fraction, u), change = (c * u - force) / (linear + (1.0 + exponent_) * (c - linear));
        u -= change;
        if (std::abs(change) < kLastChange * u) break;
    }
    return u;
}

PorousLaw::Drag PorousLaw::drag(double fraction, double speed) const
{
    if (law_ == DragLaw::Off || !(fraction > 0.0)) return {0.0, 0.0};
    const Permeability k = permeability(fraction, fibreDiameter_);
    const double inertial = inertialDrag(fraction, speed);
    return {dragOf(k.along, fraction, inertial), dragOf(k.across, fraction, inertial)};
}

double dragAlongAxis(const PorousLaw::Drag& drag, double shape, double square)
{
    const double across = (1.0 - shape) * drag.along + shape * drag.across;  // across the direction: in the plane of cloth
    const double along = shape * drag.along + (1.0 - shape) * drag.across;
    return across * (1.0 - square) + along * square;
}

double suctionAlongAxis(double shape, double square) { return 1.0 + (1.0 - shape) * (1.0 - square) + shape * square; }

}  // namespace sim

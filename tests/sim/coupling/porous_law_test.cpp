#include "sim/coupling/porous_law.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

PorousSettings usualPores()
{
    PorousSettings porous;
    porous.volumeFraction = 0.4;
    return porous;
}

PorousLaw usualLaw(DragLaw law = DragLaw::Nonlinear, double exponent = 1.6)
{
    CouplingSettings coupling;
    coupling.drag = law;
    coupling.dragExponent = exponent;
    return PorousLaw(usualPores(), LiquidSettings(), coupling);
}

/// Both series of Drummond and Tahir, evaluated apart from the code (coupling/README.md, Drag) [cm^2].
TEST(Permeability, IsThatOfTheTable)
{
    const double fraction[] = {0.05, 0.1, 0.2, 0.3, 0.4};
    const double along[] = {2.0231, 0.63849, 0.16045, 0.058953, 0.025045};
    const double across[] = {1.0099, 0.31654, 0.077360, 0.029002, 0.016988};
    for (int i = 0; i < 5; ++i) {
        const Permeability k = permeability(fraction[i], 0.01);
        EXPECT_NEAR(k.along, along[i] * 1.0e-4, 5.0e-5 * k.along) << fraction[i];  // the table has five digits
        EXPECT_NEAR(k.across, across[i] * 1.0e-4, 5.0e-5 * k.across) << fraction[i];
    }
}

TEST(Permeability, FallsWithTheFractionAllTheWay)
{
    Permeability before = permeability(0.01, 0.01);
    for (double fraction = 0.02; fraction <= 1.0; fraction += 0.01) {
        const Permeability k = permeability(fraction, 0.01);
        EXPECT_LT(k.along, before.along) << fraction;
        EXPECT_LT(k.across, before.across) << fraction;
        EXPECT_GT(std::min(k.along, k.across), 0.0) << fraction;
        before = k;
    }
}

/// Pore radius [cm], suction P_c [dyn/cm^2] and uptake rate κ [1/s] of the usual fabric in water, by hand (coupling/README.md, Suction; Uptake).
TEST(PorousLaw, SuctionAndCaptureOfTheUsualFabric)
{
    EXPECT_NEAR(usualPores().poreRadius(), 0.0061237, 5.0e-8);
    EXPECT_NEAR(usualLaw().suction(0.4), 5933.6, 0.05);
    EXPECT_NEAR(usualLaw().captureRate(0.4, 0.288), 13.655, 5.0e-4);
    EXPECT_EQ(usualLaw().suction(1.0), 0.0);
}

/// Drag along fibres [g/(cm^3 s)] (coupling/README.md, Drag): 3.55e3 at rest; 8.3e3 more at 10 cm/s, or 1.9e3 by Forchheimer's law.
TEST(PorousLaw, DragOfTheUsualFabric)
{
    const double k = permeability(0.4, 0.01).along, rest = usualLaw().drag(k, 0.4, 0.0);
    EXPECT_NEAR(rest, 3.55e3, 0.005e3);
    EXPECT_NEAR(usualLaw().drag(k, 0.4, 10.0) - rest, 8.3e3, 0.05e3);
    EXPECT_NEAR(usualLaw(DragLaw::Nonlinear, 1.0).drag(k, 0.4, 10.0) - rest, 1.9e3, 0.05e3);
    EXPECT_EQ(usualLaw(DragLaw::Linear).drag(k, 0.4, 10.0), rest);
    EXPECT_EQ(usualLaw(DragLaw::Off).drag(k, 0.4, 10.0), 0.0);
    EXPECT_EQ(usualLaw().drag(k, 0.0, 10.0), 0.0);
}

/// The diagonal T_aa of drag (coupling/README.md, Drag): within both drags, with their trace, and alike under turns by 90 degrees.
TEST(DragAlongAxis, LiesBetweenBothAndTurnsWithTheAxes)
{
    testing::Noise noise(1);
    const PorousLaw::Drag drag = {2.0, 20.0};
    for (int i = 0; i < 200; ++i) {
        const Vec3 o = noise.vector().normalized(), turned(o.y(), -o.x(), o.z());  // by 90 degrees about z
        const double shape = (i % 3) * 0.5;
        double sum = 0.0;
        for (int a = 0; a < kAxes; ++a) {
            const double square = o[a] * o[a], t = dragAlongAxis(drag, shape, square);
            EXPECT_GE(t, drag.along * (1.0 - 1.0e-14));
            EXPECT_LE(t, drag.across * (1.0 + 1.0e-14));
            sum += t;
            const int image = a == 0 ? 1 : a == 1 ? 0 : 2;
            EXPECT_DOUBLE_EQ(t, dragAlongAxis(drag, shape, turned[image] * turned[image]));
            EXPECT_DOUBLE_EQ(suctionAlongAxis(shape, square), suctionAlongAxis(shape, turned[image] * turned[image]));
        }
        const double trace = shape * (drag.along + 2.0 * drag.across) + (1.0 - shape) * (2.0 * drag.along + drag.across);
        EXPECT_NEAR(sum, trace, 1.0e-12 * trace);
    }
}

TEST(DragAlongAxis, KnowsYarnsFromCloth)
{
    const PorousLaw::Drag drag = {2.0, 20.0};
    constexpr double kYarn = 1.0, kCloth = 0.0, kOwn = 1.0, kOther = 0.0;
    EXPECT_EQ(dragAlongAxis(drag, kYarn, kOwn), drag.along);
    EXPECT_EQ(dragAlongAxis(drag, kYarn, kOther), drag.across);
    EXPECT_EQ(dragAlongAxis(drag, kCloth, kOwn), drag.across);
    EXPECT_EQ(dragAlongAxis(drag, kCloth, kOther), drag.along);
    EXPECT_EQ(suctionAlongAxis(kYarn, kOwn), 2.0);
    EXPECT_EQ(suctionAlongAxis(kYarn, kOther), 1.0);
    EXPECT_EQ(suctionAlongAxis(kCloth, kOwn), 1.0);
    EXPECT_EQ(suctionAlongAxis(kCloth, kOther), 2.0);
}

}  // namespace
}  // namespace sim

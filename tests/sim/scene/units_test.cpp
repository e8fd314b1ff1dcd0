#include "sim/scene/units.h"

#include "sim/core/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace {

using sim::Quantity;

double cgs(const char* text, Quantity quantity)
{
    const sim::ParsedNumber number = sim::parseNumber(text, quantity, false);
    EXPECT_EQ("", number.problem) << text;
    return number.value;
}

double si(const char* text, Quantity quantity)
{
    const sim::ParsedNumber number = sim::parseNumber(text, quantity, true);
    EXPECT_EQ("", number.problem) << text;
    return number.value;
}

TEST(Units, BareNumbersAreCgsExactly)
{
    EXPECT_EQ(0.288, cgs("0.288", Quantity::Length));
    EXPECT_EQ(-981.0, cgs("-981", Quantity::Acceleration));
    EXPECT_EQ(2.0e-4, cgs("2e-4", Quantity::Time));
    EXPECT_EQ(1.5, cgs("+1.5", Quantity::Density));
}

TEST(Units, BareNumbersOfSiAreConverted)
{
    EXPECT_DOUBLE_EQ(28.8, si("0.288", Quantity::Length));
    EXPECT_DOUBLE_EQ(981.0, si("9.81", Quantity::Acceleration));
    EXPECT_DOUBLE_EQ(1.0, si("1000", Quantity::Density));
    EXPECT_DOUBLE_EQ(8.9e-3, si("8.9e-4", Quantity::Viscosity));
    EXPECT_DOUBLE_EQ(72.0, si("0.072", Quantity::SurfaceTension));
    EXPECT_DOUBLE_EQ(10.0, si("1", Quantity::Pressure));
    EXPECT_DOUBLE_EQ(1.0e6, si("1", Quantity::Volume));
    EXPECT_DOUBLE_EQ(1.0e3, si("1", Quantity::Mass));
    EXPECT_DOUBLE_EQ(200.0, si("2", Quantity::Velocity));
    EXPECT_EQ(2.0, si("2", Quantity::Time));
    EXPECT_EQ(2.0, si("2", Quantity::Frequency));
}

/// Whoever writes a scene in metres gets the same bits as who writes it in centimetres.
TEST(Units, SiAndCgsAreTheSameBits)
{
    struct Pair {
        Quantity quantity;
        int decimals;
        const char* unit;
    };
    const Pair pairs[] = {{Quantity::Length, 2, "m"},          {Quantity::Density, -3, "kg/m^3"},    {Quantity::Pressure, 1, "Pa"},
                          {Quantity::Volume, 6, "m^3"},        {Quantity::SurfaceTension, 3, "N/m"}, {Quantity::Viscosity, 1, "Pa s"},
                          {Quantity::Acceleration, 2, "m/s^2"}};
    std::mt19937 random(3);
    for (const Pair& pair : pairs)
        for (int n = 0; n < 200; ++n) {
            const int digits = std::uniform_int_distribution<int>(1, 999999)(random), exponent = std::uniform_int_distribution<int>(-9, 4)(random);
            const std::string inCgs = std::to_string(digits) + "e" + std::to_string(exponent);
            const std::string inSi = std::to_string(digits) + "E" + std::to_string(exponent - pair.decimals);
            EXPECT_EQ(si(inSi.c_str(), pair.quantity), cgs(inCgs.c_str(), pair.quantity)) << inCgs;
            EXPECT_EQ(cgs((inSi + " " + pair.unit).c_str(), pair.quantity), cgs(inCgs.c_str(), pair.quantity)) << inCgs;
        }
    EXPECT_EQ(si("-1.65e-4", Quantity::Length), -0.0165);
    EXPECT_FALSE(sim::parseNumber("1e308", Quantity::Length, true).problem.empty());
}

TEST(Units, WrittenUnitsMeanTheSameInBothSystems)
{
    struct Case {
        const char* text;
        Quantity quantity;
        double expected;
    };
    const Case cases[] = {{"1.44 cm", Quantity::Length, 1.44},
                          {"0.33 mm", Quantity::Length, 0.033},
                          {"5 um", Quantity::Length, 5.0e-4},
                          {"5 µm", Quantity::Length, 5.0e-4},
                          {"72 dyn/cm", Quantity::SurfaceTension, 72.0},
                          {"72 mN/m", Quantity::SurfaceTension, 72.0},
                          {"9.81 m/s^2", Quantity::Acceleration, 981.0},
                          {"9.81 m/s2", Quantity::Acceleration, 981.0},
                          {"9.81 m/s²", Quantity::Acceleration, 981.0},
                          {"9.81 m s^-2", Quantity::Acceleration, 981.0},
                          {"18.3 MPa", Quantity::Pressure, 1.83e8},
                          {"1 bar", Quantity::Pressure, 1.0e6},
                          {"1 kg/m^3", Quantity::Density, 1.0e-3},
                          {"1 g/cm³", Quantity::Density, 1.0},
                          {"1 mPa s", Quantity::Viscosity, 0.01},
                          {"1 mPa*s", Quantity::Viscosity, 0.01},
                          {"1 mPa·s", Quantity::Viscosity, 0.01},
                          {"1 cP", Quantity::Viscosity, 0.01},
                          {"1 dyn s/cm^2", Quantity::Viscosity, 1.0},
                          {"1 N/m/m", Quantity::Pressure, 10.0},
                          {"2 ms", Quantity::Time, 2.0e-3},
                          {"1 min", Quantity::Time, 60.0},
                          {"200 /s", Quantity::Frequency, 200.0},
                          {"200 1/s", Quantity::Frequency, 200.0},
                          {"2 kHz", Quantity::Frequency, 2000.0},
                          {"3 ml", Quantity::Volume, 3.0},
                          {"3cm^3", Quantity::Volume, 3.0},
                          {"50 %", Quantity::None, 0.5},
                          {"30 deg", Quantity::Angle, sim::kPi / 6.0},
                          {"30°", Quantity::Angle, sim::kPi / 6.0},
                          {"1 rad", Quantity::Angle, 1.0},
                          {"90 deg/s", Quantity::TurnRateDegrees, 90.0}};
    for (const Case& c : cases) {
        EXPECT_DOUBLE_EQ(c.expected, cgs(c.text, c.quantity)) << c.text;
        EXPECT_DOUBLE_EQ(c.expected, si(c.text, c.quantity)) << c.text;
    }
}

TEST(Units, AnglesAreDegreesInBothSystems)
{
    EXPECT_EQ(40.8 * sim::kPi / 180.0, cgs("40.8", Quantity::Angle));
    EXPECT_EQ(40.8 * sim::kPi / 180.0, si("40.8", Quantity::Angle));
    EXPECT_EQ(40.8, cgs("40.8", Quantity::AngleDegrees));
}

TEST(Units, WrongDimensionNamesBoth)
{
    EXPECT_EQ("\"3 cm\" is a length, needs a time (in s)", sim::parseNumber("3 cm", Quantity::Time, false).problem);
    EXPECT_EQ("\"30 deg\" is an angle, needs a length (in cm)", sim::parseNumber("30 deg", Quantity::Length, false).problem);
    EXPECT_EQ("\"2 Pa s\" is a viscosity, needs a pressure (in dyn/cm^2)", sim::parseNumber("2 Pa s", Quantity::Pressure, false).problem);
}

TEST(Units, NonsenseIsRefused)
{
    for (const char* text :
         {"",      " ",    "-",     "+",   "1e",  "--1",  "+-1",  "1 cm/", "1 /", "1 cm//s",  "1 cm^", "1 cm^x", "1 cm^99",  "1 2 cm", "1,5",
          "1 cm)", "0x10", "1_000", "nan", "inf", "-inf", ".nan", "-.inf", "NaN", "infinity", "1e999", "-1e999", "1e300 Gm", "cm"}) {
        EXPECT_NE("", sim::parseNumber(text, Quantity::Length, false).problem) << text;
    }
}

TEST(Units, PrintedNumbersReadBackToTheSameBits)
{
    double x = 1.0e-9;
    for (int i = 0; i < 2000; ++i) {
        x = std::fmod(x * 1.37 + 1.0e-3 * i, 1.0e4);
        for (const Quantity quantity : {Quantity::None, Quantity::Length, Quantity::Angle, Quantity::AngleDegrees}) {
            EXPECT_EQ(x, cgs(sim::formatNumber(x, quantity).c_str(), quantity)) << i;
            EXPECT_EQ(-x, cgs(sim::formatNumber(-x, quantity).c_str(), quantity)) << i;
        }
    }
}

}  // namespace

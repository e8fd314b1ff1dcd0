#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sim {

/// What a number of a scene measures.
enum class Quantity {
    None,
    Length,
    Time,
    Mass,
    Velocity,
    Acceleration,
    Density,
    Pressure,
    Viscosity,
    SurfaceTension,
    Stiffness,         ///< force per width and strain
    BendingStiffness,  ///< moment per width and curvature
    Volume,
    Frequency,
    Angle,            ///< stored in radians, written in degrees
    AngleDegrees,     ///< stored in degrees (pictures)
    TurnRateDegrees,  ///< stored in degrees per second (pictures)
};

/// "a length", "an angle", "a plain number".
std::string nameOf(Quantity quantity);

/// Unit of a bare number, in which ranges are told and resolved scenes are printed: "cm/s", "deg"; "" for plain
/// numbers.
const char* unitOf(Quantity quantity, bool isSi = false);

/// Either a number as it is stored (CGS, radians) or what is wrong with the text.
struct ParsedNumber {
    double value = 0.0;
    std::string problem;  ///< "" if fine; else completes "time.dt: …"
};

/// Reads "0.5", "1.44 cm", "72 dyn/cm", "9.81 m/s^2", "18.3 MPa", "30 deg", "1 mPa s", "200 /s".
/// Bare numbers are in the unit of the quantity in the file's system. Never NaN nor infinite.
ParsedNumber parseNumber(std::string_view text, Quantity quantity, bool isSi);

/// The stored number as a scene file would say it in cgs, such that parseNumber gives back the same bits.
std::string formatNumber(double stored, Quantity quantity);

/// Bare number, shortest form that reads back to the same; always with a point or an exponent with a point.
std::string formatPlain(double value);

/// A stored number in the unit that unitOf names (degrees for angles).
double inFileUnits(double stored, Quantity quantity);

}  // namespace sim

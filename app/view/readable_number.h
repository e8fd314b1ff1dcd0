#pragma once

#include <string>

namespace app {

/// A number as panels show it: "15250", "0.8333", "-0.02", "1.23e7", "3.6e-15". Without an exponent where it has at most six digits before the point
/// or three zeros behind it, without zeros at its end.
/// @param digits  that count, at least; whole numbers have all of theirs
std::string readableNumber(double value, int digits = 4);

}  // namespace app

#pragma once

namespace sim::solids {

/// Advances from t by h [s] in one call of go(t, h) where that succeeds, else by bisection: in two halves, and each of those likewise. Past
/// solids of which one moves and another does not there may be no straight way, but a bent one.
/// @param most  halvings, one within the other
/// @return whether it got to the end
template <class Go>
bool bisectInterval(double t, double h, int most, Go&& go)
{
    if (go(t, h)) return true;
    return most > 0 && bisectInterval(t, 0.5 * h, most - 1, go) && bisectInterval(t + 0.5 * h, 0.5 * h, most - 1, go);
}

}  // namespace sim::solids

#pragma once

namespace sim::solids {

/// Goes for a time h from t [s] in one piece where go(t, h) can, and else in two halves, and each of those likewise: past solids of which one
/// moves and another does not there may be no straight way, but a bent one.
/// @param most  halvings, one within the other
/// @return whether it got to the end
template <class Go>
bool inHalves(double t, double h, int most, Go&& go)
{
    if (go(t, h)) return true;
    return most > 0 && inHalves(t, 0.5 * h, most - 1, go) && inHalves(t + 0.5 * h, 0.5 * h, most - 1, go);
}

}  // namespace sim::solids

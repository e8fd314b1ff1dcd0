#pragma once

#include "sim/settings.h"

namespace sim {

/// Suction and permeability of pores that are full to the part S (coupling/README.md, Wicking): P_c (1 − S^a), and k S^b as Corey 1954 has it.
/// a = b = 1 is linear.
class UnsaturatedLaw {
 public:
    explicit UnsaturatedLaw(const WickingSettings& settings) : a_(settings.suctionExponent), b_(settings.permeabilityExponent) {}

    bool isLinear() const { return a_ == 1.0 && b_ == 1.0; }
    /// Suction relative to that of dry pores, 1 − S^a; S in [0..1].
    double suction(double saturation) const;
    /// Permeability relative to that of full pores, S^b; S in [0..1].
    double permeability(double saturation) const;
    /// Permeability between two places, its mean over the suction between them: with it the flow at rest from one to the other is exact.
    double meanPermeability(double one, double other) const;
    /// Largest ratio of the diffusivity a S^(a + b − 1) to that of the linear law at S = 1.
    double steepest() const { return a_; }
    /// Largest slope of the permeability with the saturation, relative to that of full pores.
    double steepestPermeability() const { return b_; }

 private:
    double a_, b_;  ///< exponents of suction and of permeability [-]
};

}  // namespace sim

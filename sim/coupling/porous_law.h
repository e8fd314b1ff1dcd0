#pragma once

#include "sim/settings.h"

namespace sim {

/// How easily liquid flows along fibres and across them [cm^2].
struct Permeability {
    double along, across;
};

/// Permeability of parallel fibres in a square array.
/// @param fraction  share of the volume that fibres fill, (0..1]
/// Source: Drummond and Tahir 1984. Their series for flow across turns up again beyond 0.4; from there on it falls as that along does
/// (coupling/README.md, Drag).
Permeability permeability(double fraction, double fibreDiameter);

/// What liquid feels in fabric, from the fabric's pores and the liquid's constants (coupling/README.md, Drag).
class PorousLaw {
 public:
    PorousLaw(const PorousSettings& porous, const LiquidSettings& liquid, const CouplingSettings& coupling);

    /// P_c: capillary suction of dry fabric [dyn/cm^2]; 0 where fibres leave no pores.
    double suction(double fraction) const;
    /// σ cos θ/r_p: suction per fibres' over pores' volume; none of what does not wet, as such liquid stays out [dyn/cm^2].
    double suctionOfPores() const { return suctionScale_; }
    /// κ: rate at which fabric takes in what is in the cells around it [1/s] (coupling/README.md, Uptake).
    double captureRate(double fraction, double cell) const;
    /// c: drag per volume and relative speed [g/(cm^3 s)]: Darcy's, and where it is not linear the one of Yazdchi and Luding 2012.
    /// @param permeability  in the direction of the flow [cm^2]
    /// @param speed         of the liquid past the fabric [cm/s]
    double drag(double permeability, double fraction, double speed) const { return dragOf(permeability, fraction, inertialDrag(fraction, speed)); }
    /// Speed at which drag holds a force per volume [dyn/cm^3]; 0 without drag.
    double speedUnder(double force, double permeability, double fraction) const;
    /// Drag by directions; at speeds of all directions together.
    struct Drag {
        double along, across;
    };
    Drag drag(double fraction, double speed) const;

 private:
    double fibreDiameter_, suctionScale_;  ///< [cm], σ cos θ / r_p, at least 0 [dyn/cm^2]
    double density_, viscosity_;           ///< density and viscosity of the liquid [g/cm^3, P]
    DragLaw law_;
    double exponent_;    ///< b, of the speed where drag is not linear [-]
    double speedOfOne_;  ///< μ/(ρ d): at which the Reynolds number of a fibre is 1 [cm/s]

    double inertialDrag(double fraction, double speed) const;
    double dragOf(double permeability, double fraction, double inertial) const;
};

/// T_aa of the drag tensor: drag on the flow along axis a; between the least and the largest of the two (coupling/README.md, Drag).
/// @param shape   of the fabric: 1 = yarns, 0 = cloth, or between
/// @param square  o_a², with the direction o: tangent of yarns, normal of cloth
double dragAlongAxis(const PorousLaw::Drag& drag, double shape, double square);
/// χ_a: suction along axis a: 2 along yarns and in the plane of cloth, 1 across (coupling/README.md, Suction).
double suctionAlongAxis(double shape, double square);

}  // namespace sim

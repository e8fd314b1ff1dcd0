#pragma once

namespace sim {

/// Liquid and fabric on one face of the grid.
struct MixtureFace {
    double liquidMass = 0.0, fabricMass = 0.0;      ///< fabric with what it has absorbed [g]
    double liquidVolume = 0.0, fabricVolume = 0.0;  ///< volumes that pressure acts on; the fabric's: fibres and absorbed liquid [cm^3]
    double drag = 0.0;                              ///< D [g]
    double fraction = 0.0;                          ///< ψ of the cell's volume that fibres fill [-]
};

/// Drag between the two phases solved for on one face, elasticity left out (coupling/README.md, Mixture):
///   u_f = (m_f u_f* + Q m_s u_s* − dt (V_f + Q V_s) ∇p) / C,  u_s = (m_s u_s* + P m_f u_f* − dt (V_s + P V_f) ∇p) / C_s,
///   (1 − ψ) u_f + ψ u_s = F u_f* + S u_s* − dt β ∇p.
struct MixtureSplit {
    double liquidPart = 0.0, fabricPart = 0.0;        ///< P, Q: part of the liquid's, the fabric's impulse that the other takes [-]
    double perLiquidMass = 0.0, perFabricMass = 0.0;  ///< 1/C, 1/C_s [1/g]
    double ofLiquid = 0.0, ofFabric = 0.0;            ///< F, S [-]
    double mobility = 0.0;                            ///< β [cm^3/g]
};

inline MixtureSplit splitMixture(const MixtureFace& f)
{
    MixtureSplit s;
    const double liquid = f.liquidMass + f.drag, fabric = f.fabricMass + f.drag;
    if (liquid > 0.0) s.liquidPart = f.drag / liquid;
    if (fabric > 0.0) s.fabricPart = f.drag / fabric;
    const double c = f.liquidMass + s.fabricPart * f.fabricMass, cs = f.fabricMass + s.liquidPart * f.liquidMass;
    if (c > 0.0) s.perLiquidMass = 1.0 / c;
    if (cs > 0.0) s.perFabricMass = 1.0 / cs;
    const double free = (1.0 - f.fraction) * s.perLiquidMass, bound = f.fraction * s.perFabricMass;
    s.ofLiquid = (free + bound * s.liquidPart) * f.liquidMass;
    s.ofFabric = (bound + free * s.fabricPart) * f.fabricMass;
    s.mobility = free * (f.liquidVolume + s.fabricPart * f.fabricVolume) + bound * (f.fabricVolume + s.liquidPart * f.liquidVolume);
    return s;
}

}  // namespace sim

#pragma once

#include "sim/core/types.h"
#include "sim/core/units.h"
#include "sim/shapes/motion.h"

#include <array>
#include <string>
#include <vector>

namespace sim {

/// What a piece of fabric is made of. Elastic energies of porous fabric carry the packing factor χ = φ² (fabric/README.md, Materials).
struct FabricMaterial {
    double young = 0.0;                         ///< Young's modulus of the fibres; required [dyn/cm^2]
    double poisson = 0.35;                      ///< [-]
    double density = 1.3;                       ///< density of the fibres [g/cm^3]
    double dampingViscosity = 0.0;              ///< η of a Kelvin-Voigt damping with viscous Young's modulus 3η; 0 = none [P]
    bool dampBending = true;                    ///< η damps bending and twisting
    bool dampStretching = true;                 ///< η damps stretching
    double stretchFactor = 1.0;                 ///< factor on the stretching stiffness of yarns [-]
    double contactStiffness = 1.0e-2;           ///< stiffness of contact on the grid relative to young; solver grid only [-]
    double pinStiffness = 2.0e-2;               ///< stiffness of the springs at pins relative to young; solver grid only [-]
    double frictionAngle = 30.0 * kPi / 180.0;  ///< tan of it is Coulomb's coefficient [rad]
    double volumeFraction = 1.0;                ///< φ: fibres per envelope volume [0..1]
    double sectionRotation = 0.0;               ///< angle of an elliptic section's axes against the initial frames [rad]
    double thickness = 0.0;                     ///< thickness of cloth whose piece says none; 0: unknown [cm]

    // Of cloth that stretches and bends otherwise along its warp than along its weft (fabric/shells/README.md, Warp and weft).
    std::array<double, 2> stretchStiffness{};  ///< force per width and strain, pulled along warp and weft; 0: as young has it [dyn/cm]
    double shearStiffness = 0.0;               ///< shear force per width and angle; 0: √(warp · weft) / 2(1 + ν) [dyn/cm]
    std::array<double, 2> bendingStiffness{};  ///< moment per width and curvature, warp and weft bent; 0: as young has it [dyn cm]

    bool hasWarp() const { return stretchStiffness[0] > 0.0 || bendingStiffness[0] > 0.0; }

    double packing() const { return volumeFraction * volumeFraction; }   ///< χ [-]
    double envelopeDensity() const { return density * volumeFraction; }  ///< mass of dry fabric per envelope volume [g/cm^3]
    double shear() const { return young / (2.0 * (1.0 + poisson)); }     ///< [dyn/cm^2]
};

/// Vertices that are held: they follow `motion` from where the scene puts them.
struct PinGroup {
    std::string name;           ///< name by which motions call it; may be empty
    std::vector<int> vertices;  ///< vertices of the piece, ascending
    bool twist = false;         ///< the twist of yarn edges that begin or end at these vertices is held too
    Motion motion;
    std::string text;        ///< which vertices, as a scene says it, in cgs: "corners: all, patch: 2"
    std::string motionText;  ///< the motion as a scene says it, in cgs, on one line; empty if they stand still
    std::string where;       ///< "flag.yaml:14", for messages
};

/// One piece of fabric as a scene describes it: at rest and free of stress where it starts. A vertex may lie on several strands,
/// and on strands and faces.
struct FabricPiece {
    std::string name;
    std::string group;  ///< name for motions that several pieces may share; may be empty
    std::string materialName;
    FabricMaterial material;
    std::array<double, 2> radius{};         ///< half axes of a yarn's section, along m1 and m2; cloth is as thick as their sum [cm]
    Vec3 warp = Vec3::UnitX();              ///< direction of the warp of cloth; its weft lies across
    std::vector<Vec3> points;               ///< [cm]
    std::vector<std::vector<int>> strands;  ///< points in order, at least 2 each
    std::vector<Vec3i> faces;               ///< consistently oriented
    std::vector<int> inFile;                ///< first vertex of its file at each point, from 0; empty where vertices and points are the same
    Vec3 velocity = Vec3::Zero();           ///< [cm/s]
    double wetness = 0.0;                   ///< share of the pores that liquid fills at the start [-]
    std::vector<PinGroup> pins;
    std::string where;               ///< "flag.yaml:14", for messages
    std::string kind;                ///< the generator that made it: "cloth_grid"
    std::string text;                ///< what it was asked for, as a scene says it, in cgs, on one line
    std::vector<std::string> notes;  ///< notes about its file
    std::string transformText;       ///< where it was moved then, as a scene says it; empty if it was not

    /// What a scene calls a point: its number, or that in the file from which it comes.
    int called(int point) const { return inFile.empty() ? point : inFile[static_cast<std::size_t>(point)]; }
};

}  // namespace sim

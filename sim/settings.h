#pragma once

#include "sim/core/types.h"
#include "sim/core/units.h"

#include <cmath>
#include <limits>

// Every number a scene may set: default, unit, one sentence. Keys and ranges are in scene/describe.h.

namespace sim {

enum class TimeMode { Fixed, Cfl, Adaptive };
enum class TimeIntegrator { Plain, Reflected };
enum class TransferMethod { Pic, Flip, Apic, PolyPic };
enum class XiMap { Translation, Affine, AffineConservative };

struct TimeSettings {
    double dt = 1.0e-3;                                     ///< Time step; in modes cfl and adaptive its upper bound [s]
    double duration = 1.0;                                  ///< Simulated time from start to end [s]
    double start = 0.0;                                     ///< Time of the initial state [s]
    TimeMode mode = TimeMode::Fixed;                        ///< Adaptive: as cfl, and a step that turns out bad is made again in halves
    double cfl = 1.0;                                       ///< Cells a particle may cross per step, modes cfl and adaptive [-]
    double maxCflLiquid = 3.0;                              ///< Upper bound of the liquid's CFL number in all modes [-]
    double maxCflFabric = 1.0 / 3.0;                        ///< The fabric's bound, read by fabric.solver grid only [-]
    double dtMin = 1.0e-8;                                  ///< A run that would need smaller steps stops with a message [s]
    TimeIntegrator integrator = TimeIntegrator::Reflected;  ///< Reflected: of two steps the first reflects (liquid/README.md, Reflection)

    bool reflects() const { return integrator == TimeIntegrator::Reflected; }
};

/// How one phase's velocities go to the grid and back.
struct TransferSettings {
    TransferMethod method = TransferMethod::PolyPic;
    int modes = 8;  ///< PolyPIC modes per component, read by polypic only [1..27]
    XiMap xi = XiMap::Translation;
    double flipRatio = 0.99;      ///< FLIP share kept over dampingDt [0..1]
    double affineDamping = 0.0;   ///< Share of all modes but the mean that is lost over dampingDt; 0 = no damping [0..1]
    double dampingDt = 2.0e-4;    ///< Time step to which shares kept and lost refer [s]
    bool dampingPerStep = false;  ///< Shares kept and lost are taken per step as they are, as published
    bool dampModes = true;        ///< affineDamping acts on PolyPIC modes too

    /// N_r: modes per component gathered from the grid.
    int modeCount() const
    {
        switch (method) {
            case TransferMethod::Apic: return 4;
            case TransferMethod::PolyPic: return modes;
            default: return 1;
        }
    }
};

/// The fabric's part of `transfer`; read by fabric.solver grid only.
struct FabricTransferSettings {
    static constexpr int kMostModes = 8;  ///< a sheet is surface everywhere, where quadratic modes feed on faces that carry next to nothing

    TransferMethod method = TransferMethod::PolyPic;  ///< never Flip: the fabric then runs apic
    int modes = 8;                                    ///< PolyPIC modes per component, read by polypic only [1..kMostModes]
    XiMap xi = XiMap::Translation;
    double stretchDamping = 0.0;   ///< Share of the symmetric part of the velocity gradient that is lost over dampingDt [0..1]
    double rotationDamping = 0.0;  ///< Share of the antisymmetric part of the velocity gradient that is lost over dampingDt [0..1]
    double velocityDamping = 0.0;  ///< Share of the velocity that is lost over dampingDt [0..1]
};

struct RelaxSettings {
    double rate = 0.0;   ///< Rate at which crowded particles are pushed apart; 0 = off [1/s]
    double range = 2.0;  ///< Reach of the push in nominal particle radii [-]
};

struct VolumeSettings {
    double rate = 125.0;  ///< Rate at which cells that hold too much expand and holes close; 0 = off [1/s]
};

struct LiquidSettings {
    double density = 1.0;                      ///< [g/cm^3]
    double viscosity = 8.9e-3;                 ///< [P]
    bool solveViscosity = false;               ///< Viscosity acts inside the liquid, not on fabric alone
    int viscositySubsteps = 1;                 ///< Parts of a step, each of which viscosity is solved for [-]
    double surfaceTension = 72.0;              ///< [dyn/cm]
    bool surfaceTensionForce = false;          ///< Surface tension moves the liquid
    int curvatureSmoothing = 7;                ///< Smoothing passes over the fill before its curvature is taken [-]
    double contactAngle = 40.8 * kPi / 180.0;  ///< [rad]
    bool full = false;                         ///< The liquid fills a closed box: there is no air
    int surfaceOrder = 2;                      ///< order of the error of a free surface's motion [1..2] (liquid/README.md, Surface of second order)
    double particleSpacing = 0.0;              ///< Pitch of the particles in cells; 0 = the fill pattern's own [-]
    double wallFriction = 0.0;                 ///< 0 = free slip … 1 = the liquid sticks to walls [-]
    VolumeSettings volume;
    RelaxSettings relax;
};

enum class FabricSolver { Vertex, Grid, Off };
enum class MembraneModel { StVk, NeoHookean };
enum class BendingModel { ShapeOperator, Hinge };
enum class HingeMeasure { Angle, Sin, Tan };
enum class TorsionModel { Ellipse, Polar };
enum class FabricTimeIntegrator { SecondOrder, BackwardEuler };

/// How fabric is solved for (fabric/vertex/README.md, The step in vertices); what it is made of stands in FabricMaterial (fabric/pieces/piece.h).
struct FabricSettings {
    FabricSolver solver = FabricSolver::Vertex;                             ///< Off: pins follow their motions, all else stays
    FabricTimeIntegrator integrator = FabricTimeIntegrator::BackwardEuler;  ///< vertex only
    MembraneModel membrane = MembraneModel::StVk;
    BendingModel bending = BendingModel::ShapeOperator;
    double hingeConstant = 1.0;  ///< c (fabric/shells/README.md, Hinges), bending hinge only; the published code has 3 [-]
    HingeMeasure hingeMeasure = HingeMeasure::Angle;
    TorsionModel torsion = TorsionModel::Ellipse;  ///< Ellipse: St-Venant; Polar: G times the polar moment, as published
    bool twist = true;                             ///< yarns resist twisting
    int newton = 2;                                ///< Newton iterations per step, vertex only
    double tolerance = 0.0;  ///< error left by the linear solve. vertex: relative [-], 0 = 1e-2; grid: [cm/s], 0 = 5e-3 of gravity times the step
    bool contact = true;     ///< fabric touches itself and obstacles
    int maxHalvings = 4;     ///< halvings of a step that could not be taken, vertex only; of driven fabric at least 2 are made
};

/// What fabric is like inside: fibres and the pores between them.
struct PorousSettings {
    double fibreDiameter = 0.01;  ///< [cm]
    double volumeFraction = 1.0;  ///< fibres per envelope volume, of materials that do not say their own (0..1]

    double poreRadius() const { return 0.5 * fibreDiameter * std::sqrt((1.0 - volumeFraction) / volumeFraction); }  ///< [cm]
};

enum class DragLaw { Off, Linear, Nonlinear };
/// Whose fraction of fibres drag goes by: that of the fabric itself, on the volume of the fabric; or of the cell, as published.
enum class DragFraction { Fabric, Cell };

enum class CaptureLaw { Fabric, Published };

/// How fabric takes up liquid.
struct CaptureSettings {
    /// Fabric: each vertex fills the pores of its own share of the fabric. Published: each takes a share of the liquid in the cells around.
    CaptureLaw law = CaptureLaw::Fabric;
    /// Part of its pores that fabric in liquid fills per time; 0 = it stays dry [1/s]. Law fabric. As measured: water wicks 0.3 cm into
    /// knits in the first second, by the root of time 0.06 cm, the thickness of a cloth, in 0.04 s (NCSU, vertical wicking of knits).
    double rate = 25.0;
    double publishedRateFactor = 3.0;  ///< factor on the published law's rate: 3 is the published one, 1 the physical, 0 = fabric stays dry [-]
};

/// How liquid moves in fabric.
struct WickingSettings {
    double rateScale = 1.0;             ///< Factor on the flow; 0 = liquid stays where it was taken up [-]
    double suctionExponent = 1.0;       ///< a of the suction P_c (1 − S^a) of pores that are full to S; 1 = linear [-]
    double permeabilityExponent = 1.0;  ///< b of the permeability S^b of such pores, relative to that of full ones [-]
    bool pressure = true;               ///< The pressure of the liquid around drives it too
};

/// How wet fabric sticks, with solver vertex.
struct CohesionSettings {
    double strength = 0.0;  ///< relative to the capillary force along threads (bridgeForce); published: 2e-3; 0 = none [-]
    bool fabric = true;     ///< Bridges act between fabrics
    bool obstacle = true;   ///< Bridges act between fabric and solids
};

/// How liquid and fabric act on each other (coupling/README.md, Mixture).
struct CouplingSettings {
    DragLaw drag = DragLaw::Nonlinear;  ///< Linear: Darcy's law; Nonlinear: more where liquid is fast
    DragFraction dragFraction = DragFraction::Fabric;
    double dragExponent = 1.6;      ///< exponent of the speed, nonlinear only; 1 = Forchheimer [-]
    bool pressureOnFabric = true;   ///< the liquid's pressure pushes fabric: buoyancy
    bool capillary = true;          ///< suction of empty pores draws the liquid around
    bool capillaryReaction = true;  ///< Suction's reaction acts on the fabric too; not in the published model
    CaptureSettings capture;
    WickingSettings wicking;
    bool drip = true;  ///< fabric lets go of what its pores cannot hold
    CohesionSettings cohesion;
};

struct SolverSettings {
    double pressureTolerance = 1.0e-6;  ///< Largest residual relative to the largest right-hand side [-]
    int maxIterations = 200;
    double viscosityTolerance = 1.0e-6;  ///< Of the viscosity solve, relative to the largest momentum of a face [-]
    int wickingSubsteps = 1;             ///< Least number of parts of a step of the flow in fabric; stability may ask for more [-]
};

struct Settings {
    TimeSettings time;
    double cell = 0.0;                              ///< Grid cell size [cm]; required
    Vec3 gravity = Vec3(0.0, -kEarthGravity, 0.0);  ///< [cm/s^2]
    TransferSettings transfer;                      ///< transfer of the liquid
    FabricTransferSettings fabricTransfer;
    LiquidSettings liquid;
    FabricSettings fabric;
    PorousSettings porous;
    CouplingSettings coupling;
    SolverSettings solver;
};

}  // namespace sim

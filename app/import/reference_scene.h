#pragma once

#include "sim/core/types.h"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

// What a scene of libWetCloth says, with the defaults of its reader (app/import/README.md, Scenes of libWetCloth). All numbers are CGS, angles
// as there.

namespace app::reference {

using sim::Vec3;
using sim::Vec3i;

/// <integrator>, <duration>, <bucketinfo>, <simplegravity>.
struct Run {
    double duration = 0.0, dt = 0.0;  ///< [s]
    std::optional<int> picMethod;     ///< 0 PIC, 1 APIC, 2 PolyPIC
    std::optional<bool> apic;         ///< the choice that files of 2018 have
    int maxIterations = 100;
    int viscositySubsteps = 1;
    double cell = 1.0;            ///< bucket over number of cells [cm]
    Vec3 gravity = Vec3::Zero();  ///< [cm/s^2]
    int line = 1;
};

/// <liquidinfo>, as far as there is something like it here.
struct LiquidInfo {
    double density = 1.0, viscosity = 8.9e-3, surfaceTension = 72.8;  ///< [g/cm^3], [P], [dyn/cm]
    double contactAngle = 0.71209;                                    ///< [rad]
    double fibreDiameter = 0.01, volumeFraction = 0.4;                ///< [cm], [-]
    std::string porousNote;                                           ///< note on how the two came about, where that needs saying
    double particleCellMultiplier = 0.3535533906;                     ///< pitch of the sampling in cells [-]
    double affineKept = 0.99, stretchKept = 0.95, rotationKept = 1.0, velocityKept = 1.0;  ///< shares kept per step [-]
    int fluidModes = 1, solidModes = 1;
    double yazdchiPower = 1.6, captureRate = 1.0;  ///< [-]
    int correctionStep = 8;
    double correctionMultiplier = 2.0, correctionStrength = 0.2;  ///< [radii], [-]
    double wallFriction = 1.0;                                    ///< [-]
    double levelsetYoung = 6.6e6, levelsetThickness = 0.25;       ///< [dyn/cm^2], [cells]
    std::string bendingScheme;                                    ///< tantheta, sintheta, else the angle
    int curvatureSmoothing = 7;
    bool surfaceTensionForce = false, solveViscosity = false;
    bool cohesion = true, softCohesion = true, solidCohesion = true;
    double cohesionCoeff = 0.002;
    bool coheres() const { return cohesion && cohesionCoeff > 0.0 && (softCohesion || solidCohesion); }
    bool drag = true, nonlinearDrag = true, airDrag = false, dragByFutureSolid = false;
    bool solveSolid = true, pressureOnFabric = true, porePressureOnFabric = false, pressureInFabric = true;
    bool varyingFraction = false, nonuniformFraction = false, levelSetForce = true, twist = true;
    int line = 1;
};

/// <ElasticParameters>, in 2018 <StrandParameters>.
struct Material {
    std::array<double, 2> radius = {0.018, 0.018};  ///< radius and biradius [cm]
    bool hasBiradius = false;
    double young = 6.687e5, poisson = 0.35, density = 1.3, viscosity = 0.0;
    std::optional<double> volumeFraction;  ///< part of the envelope that fibres fill [-]; empty: as in liquidinfo
    bool damps = false, dampsOnlyBending = true;
    double stretchingMultiplier = 1.0, collisionMultiplier = 1.0e-3, attachMultiplier = 1.0e-3;
    double frictionAngle = 0.0;                 ///< [deg]
    std::optional<double> unreadFrictionAngle;  ///< friction_angle, which libWetCloth does not read [deg]
    double baseRotation = 0.0;                  ///< [rad]
    int line = 1;
};

struct Particle {
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();  ///< [cm], [cm/s]
    bool isHeld = false, isTwistHeld = false;
    bool isLiquid = false;
    int group = 0;
    std::array<double, 2> radius = {0.0, 0.0};            ///< 0: the material's [cm]
    double mass = 0.0, volume = 0.0, liquidVolume = 0.0;  ///< beyond what cloth and yarns give; absorbed [g], [cm^3]
    bool isTwisted = false;                               ///< theta or omega is not 0
    bool hasFraction = false;                             ///< vf is given
    int line = 1;
};

struct Cloth {
    int material = 0;
    std::vector<Vec3i> faces;  ///< triangles of particles
    int line = 1;
};

struct Yarn {
    int material = 0;
    std::vector<int> particles;  ///< in order
    int line = 1;
};

/// A span in which a source gives liquid.
struct Emission {
    double start = 0.0, end = 0.0;                               ///< [s]
    double maxVolume = std::numeric_limits<double>::infinity();  ///< [cm^3]
    Vec3 velocity = Vec3::Zero();                                ///< [cm/s]
    bool operator==(const Emission& other) const = default;
};

/// <distancefield>
struct Field {
    enum class Usage { Solid, Source, Terminator };
    enum class Type { Sphere, Box, Capsule, Cylinder, File, Union, Intersect };
    Usage usage = Usage::Solid;
    Type type = Type::Sphere;
    int group = 0;
    bool sampled = true, inside = false;
    Vec3 center = Vec3::Zero(), axis = Vec3::UnitY();     ///< [cm], of the rotation
    double angle = 0.0;                                   ///< angle of the rotation about the axis [rad]
    double radius = 0.0, halfLength = 0.0, corner = 0.0;  ///< [cm]
    Vec3 half = Vec3::Zero();                             ///< half size of a box, without its rounding [cm]
    std::string file;
    double scale = 1.0, dx = 0.0;     ///< scale and cell of a file [-], [cm]
    std::vector<int> parts;           ///< parts of a union or an intersection
    bool isPart = false;              ///< whether it is a part of another field
    std::vector<Emission> emissions;  ///< emissions of a source, at least one
    int line = 1;
};

/// <script>
struct Script {
    bool rotates = false;
    std::string course = "cubic";
    int group = 0;
    double start = 0.0, end = 0.0, easeStart = 0.0, easeEnd = 0.0;  ///< [s]
    Vec3 direction = Vec3::Zero();                                  ///< way of a translation [cm], or axis of a rotation [-]
    double angle = 0.0;                                             ///< [rad]
    std::optional<Vec3> origin;                                     ///< origin of a rotation [cm]
    bool isGlobal = false;
    double amplitude = 1.0, frequency = 1.0;
    std::vector<double> base;  ///< knots of a weno motion: values along the direction, baseStep apart
    double baseStep = 1.0;     ///< time between the knots of a weno motion [s]
    int line = 1;
};

struct Camera {
    double distance = 0.0, fov = 40.0;                      ///< [cm], [deg]
    std::array<double, 4> rotation = {0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w
    Vec3 center = Vec3::Zero();                             ///< [cm]
};

struct Scene {
    std::string description, tag;
    Run run;
    LiquidInfo liquid;
    std::vector<Material> materials;
    std::vector<Particle> particles;
    std::vector<Cloth> cloths;
    std::vector<Yarn> yarns;
    std::vector<Field> fields;
    std::vector<Script> scripts;
    std::optional<Camera> camera;
    std::optional<Vec3> background;
    std::vector<int> springLines;  ///< lines of <springforce>
    std::optional<int> poseLine;   ///< line of <pose>
};

}  // namespace app::reference

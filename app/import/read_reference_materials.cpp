#include "app/import/read_reference.h"
#include "sim/core/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

using namespace reference;

namespace {

/// Of fibre diameter, volume fraction and pore radius two give the third; with fewer, libWetCloth keeps what is given
/// beside its defaults.
void readPores(const XmlElement& info, LiquidInfo& out)
{
    const bool hasFraction = info.hasValue("restVolumeFraction"), hasDiameter = info.hasValue("yarnDiameter");
    out.fibreDiameter = info.value("yarnDiameter", out.fibreDiameter);
    out.volumeFraction = info.value("restVolumeFraction", out.volumeFraction);
    const double poreRadius = info.value("poreRadius", 0.0);
    if (!(out.fibreDiameter > 0.0)) info.fail(fmt::format("yarnDiameter must be above 0, not {}", out.fibreDiameter));
    if (!(out.volumeFraction > 0.0 && out.volumeFraction <= 1.0))
        info.fail(fmt::format("restVolumeFraction must be above 0 and at most 1, not {}", out.volumeFraction));
    if (poreRadius <= 0.0 || hasFraction == hasDiameter) {
        if (poreRadius > 0.0)
            out.porousNote =
                "poreRadius is not used: yarnDiameter and restVolumeFraction (given, or the defaults 0.01 cm and 0.4) "
                "say everything";
        return;
    }
    if (hasDiameter) {
        const double ratio = 2.0 * poreRadius / out.fibreDiameter;
        out.volumeFraction = 1.0 / (1.0 + ratio * ratio);
    } else if (out.volumeFraction < 1.0) {
        out.fibreDiameter = 2.0 * poreRadius * std::sqrt(out.volumeFraction / (1.0 - out.volumeFraction));
    }
    out.porousNote =
        fmt::format("poreRadius {} cm gives fibres of {:.4g} cm and the fraction {:.4g}", poreRadius, out.fibreDiameter, out.volumeFraction);
}

/// Cloth of T threads per cm^2, each through half the thickness t and back, as the scenes of 2018 mean it
/// (app/import/README.md, Scenes of libWetCloth).
void readThreads(const XmlElement& info, bool counts, LiquidInfo& out)
{
    const double threads = info.value("fabricThreadCount", 0.0);
    if (threads <= 0.0) return;
    const double half = info.value("halfThickness", 0.018);
    if (!counts || !(half > 0.0)) {
        out.porousNote = fmt::format("fabricThreadCount {} is not used, as the present libWetCloth does not read it", threads);
        return;
    }
    const double d = out.fibreDiameter;
    out.volumeFraction = std::min(1.0, sim::kPi * d * d * threads / (8.0 * half));
    out.porousNote = fmt::format(
        "fabricThreadCount {} and halfThickness {} cm give the volume fraction {:.4g}, by the formula of 2018 "
        "(--no-thread-count "
        "leaves restVolumeFraction as it is)",
        threads, half, out.volumeFraction);
}

void readCoupling(const XmlElement& info, LiquidInfo& out)
{
    out.cohesion = info.value("cohesion", out.cohesion);
    out.softCohesion = info.value("softCohesion", out.softCohesion);
    out.solidCohesion = info.value("solidCohesion", out.solidCohesion);
    out.cohesionCoeff = info.value("cohesionCoeff", out.cohesionCoeff);
    out.drag = info.value("useDrag", out.drag);
    out.nonlinearDrag = info.value("useNonlinearDrag", out.nonlinearDrag);
    out.yazdchiPower = info.value("yazdchiPower", out.yazdchiPower);
    out.airDrag = info.value("dragByAir", out.airDrag);
    out.dragByFutureSolid = info.value("dragByFutureSolid", out.dragByFutureSolid);
    out.captureRate = info.value("elastoCaptureRate", out.captureRate);
    out.solveSolid = info.value("solveSolid", out.solveSolid);
    out.pressureOnFabric = info.value("applyPressureSolid", out.pressureOnFabric);
    out.porePressureOnFabric = info.value("applyPorePressureSolid", out.porePressureOnFabric);
    out.pressureInFabric = info.value("applyPressureManifold", out.pressureInFabric);
    out.varyingFraction = info.value("useVaryingFraction", out.varyingFraction);
    out.nonuniformFraction = info.value("initNonuniformFraction", out.nonuniformFraction);
    out.levelSetForce = info.value("useLevelSetForce", out.levelSetForce);
    out.levelsetYoung = info.value("levelsetYoungModulus", out.levelsetYoung);
    out.levelsetThickness = info.value("levelsetThickness", out.levelsetThickness);
    out.twist = info.value("useTwist", out.twist);
    out.bendingScheme = info.value("bendingScheme", std::string());
}

Material readMaterial(const XmlElement& element, const ImportOptions& options)
{
    Material m;
    m.line = element.line();
    m.radius[0] = element.value("radius", m.radius[0]);
    m.hasBiradius = element.hasValue("biradius");
    m.radius[1] = element.value("biradius", options.roundSections ? m.radius[0] : m.radius[1]);
    m.young = element.value("youngsModulus", m.young);
    m.poisson = element.value("poissonRatio", m.poisson);
    m.density = element.value("density", m.density);
    m.viscosity = element.value("viscosity", m.viscosity);
    if (element.hasValue("restVolumeFraction")) m.volumeFraction = element.value("restVolumeFraction", 0.4);
    m.damps = element.value("accumulateWithViscous", m.damps);
    m.dampsOnlyBending = element.value("accumulateViscousOnlyForBendingModes", m.dampsOnlyBending);
    m.stretchingMultiplier = element.value("stretchingMultiplier", m.stretchingMultiplier);
    m.collisionMultiplier = element.value("collisionMultiplier", m.collisionMultiplier);
    m.attachMultiplier = element.value("attachMultiplier", m.attachMultiplier);
    m.frictionAngle = std::clamp(element.value("frictionAngle", m.frictionAngle), 0.0, 90.0);
    if (element.hasValue("friction_angle")) m.unreadFrictionAngle = std::clamp(element.value("friction_angle", 0.0), 0.0, 90.0);
    if (m.unreadFrictionAngle && options.trustFrictionAngle) m.frictionAngle = *m.unreadFrictionAngle;
    m.baseRotation = element.value("baseRotation", m.baseRotation);
    return m;
}

}  // namespace

LiquidInfo readLiquidInfo(const XmlElement& scene, bool countsThreads)
{
    LiquidInfo out;
    const XmlElement info = scene.child("liquidinfo");
    if (!info) return out;
    out.line = info.line();
    out.density = info.value("liquidDensity", out.density);
    out.viscosity = info.value("viscosity", out.viscosity);
    out.surfaceTension = info.value("surfTensionCoeff", out.surfaceTension);
    out.contactAngle = info.value("restContactAngle", out.contactAngle);
    out.particleCellMultiplier = info.value("particleCellMultiplier", out.particleCellMultiplier);
    out.affineKept = info.value("flipCoeff", out.affineKept);
    out.stretchKept = info.value("elastoFlipCoeff", out.stretchKept);
    out.rotationKept = info.value("elastoFlipAsymCoeff", out.rotationKept);
    out.velocityKept = info.value("elastoAdvectCoeff", out.velocityKept);
    out.fluidModes = info.value("fluidScalarModes", out.fluidModes);
    out.solidModes = info.value("scalarModes", out.solidModes);
    out.correctionStep = std::max(1, info.value("correctionStep", out.correctionStep));
    out.correctionMultiplier = info.value("correctionMultiplier", out.correctionMultiplier);
    out.correctionStrength = info.value("correctionStrength", out.correctionStrength);
    out.wallFriction = info.value("liquidBoundaryFriction", out.wallFriction);
    out.surfaceTensionForce = info.value("surfTension", out.surfaceTensionForce);
    out.curvatureSmoothing = info.value("surfTensionSmoothingStep", out.curvatureSmoothing);
    out.solveViscosity = info.value("computeViscosity", out.solveViscosity);
    readPores(info, out);
    readThreads(info, countsThreads, out);
    readCoupling(info, out);
    return out;
}

std::vector<Material> readReferenceMaterials(const XmlElement& scene, const ImportOptions& options)
{
    std::vector<Material> all;
    for (const char* name : {"ElasticParameters", "StrandParameters"})
        for (const XmlElement& element : scene.children(name)) all.push_back(readMaterial(element, options));
    std::ranges::stable_sort(all, {}, &Material::line);
    return all;
}

}  // namespace app

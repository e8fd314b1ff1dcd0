#include "app/lab/endings/run_course.h"

#include "app/system/csv.h"
#include "sim/coupling/porous_law.h"
#include "sim/scene/load_scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

namespace app {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> kFromOutside = {"sources_erg", "suction_erg", "solids_erg", "pins_erg"};
/// Work of obstacles with their friction, which takes. Where a solve was cut short its forces are booked with more than they took: what is not gone was not taken.
constexpr std::string_view kObstacles = "obstacles_erg";
/// The energy of a surface is in no sum. It gives by its own work and by that of the pressure that it makes; what it takes is not lost.
constexpr std::string_view kSurface = "surface_tension_erg", kPressure = "pressure_erg";

struct Energy {
    double gain = 0.0, largestKinetic = 0.0;  ///< [erg]
};

/// Mass of all that a run has [g], and its cell [cm].
struct Contents {
    double mass = 0.0, cell = 0.0;
};

/// @param liquidMass  [g]
Contents contentsOf(const std::filesystem::path& folder, double liquidMass)
{
    std::ifstream in(folder / "report.json");
    const json report = in ? json::parse(in, nullptr, false) : json();
    if (!report.is_object()) return {};
    return {liquidMass + report.at("fabric").value("mass", 0.0), report.value("cell", 0.0)};
}

/// Speed [cm/s] of motion that is none: in all of the run it would not take anything as far as so many cells, which round-off does.
double negligibleSpeed(double cell, double time)
{
    constexpr double kUnfelt = 1.0e-7;  // cells; what solves to their tolerance leave in stiff cloth at rest is as much as motion by 2e-9
    return time > 0.0 ? kUnfelt * cell / time : 0.0;
}

/// Energy's rise for which nothing outside of liquid and fabric has paid, from energy_ledger.csv, as far as its digits tell.
Energy energyOf(const std::filesystem::path& csv)
{
    constexpr double kLastDigit = 1.0e-8;  // of nine
    std::ifstream in(csv);
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> names = csvCells(line);
    Energy energy;
    std::optional<double> start;
    double lastObstacles = 0.0, lastOwn = 0.0, byObstacles = 0.0, largest = 0.0;
    while (std::getline(in, line)) {
        const std::vector<std::string> cells = csvCells(line);
        double paid = 0.0, total = 0.0, summed = 0.0, surface = 0.0, pressure = 0.0, obstacles = 0.0;
        for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i) {
            const double value = std::strtod(cells[i].c_str(), nullptr);
            if (names[i] == "total_erg") total = value;
            if (names[i] == "kinetic_erg") energy.largestKinetic = std::max(energy.largestKinetic, value);
            if (std::ranges::find(kFromOutside, names[i]) != kFromOutside.end()) paid += value, summed += std::abs(value);
            if (names[i] == kObstacles) obstacles = value;
            if (names[i] == kSurface) surface = value;
            if (names[i] == kPressure) pressure = value;
        }
        if (surface != 0.0) paid += std::max(0.0, surface + std::max(0.0, pressure));
        largest = std::max(largest, summed + std::abs(total) + std::abs(obstacles) + std::abs(surface) + std::abs(pressure));
        const double own = total - paid;  // and what obstacles gave or took
        if (!start) start = own;
        else byObstacles += std::max(obstacles - lastObstacles, std::min(own - lastOwn, 0.0));
        lastObstacles = obstacles;
        lastOwn = own;
        energy.gain = std::max(energy.gain, own - byObstacles - *start - kLastDigit * largest);
    }
    return energy;
}

/// Speed of the fastest of these points that a motion leads, in a run of this duration [s] [cm/s].
template <class Points>
double fastestPrescribed(const sim::Motion& motion, const Points& points, double duration)
{
    constexpr int kParts = 64;  // of the run, in each of which they go at one speed
    if (motion.isStatic()) return 0.0;
    double farthest = 0.0;
    for (int n = 0; n < kParts; ++n) {
        const Eigen::Isometry3d from = motion.transform(n * duration / kParts), to = motion.transform((n + 1) * duration / kParts);
        for (const sim::Vec3& x : points) farthest = std::max(farthest, (to * x - from * x).norm());
    }
    return farthest * kParts / duration;
}

/// Largest speed of the corners of boxes around solids that move, of the vertices of fabric that pins lead and of what sources give and openings let
/// in [cm/s].
double fastestPrescribed(const sim::Scene& scene, double duration)
{
    double fastest = 0.0;
    for (const sim::ObstacleSettings& obstacle : scene.obstacles) {
        std::array<sim::Vec3, 8> corners;
        const Eigen::AlignedBox3d box = obstacle.shape.bounds();
        for (int c = 0; c < 8; ++c) corners[c] = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
        fastest = std::max(fastest, fastestPrescribed(obstacle.motion, corners, duration));
    }
    for (const sim::FabricPiece& piece : scene.fabrics)
        for (const sim::PinGroup& pins : piece.pins) {
            std::vector<sim::Vec3> led;
            for (int v : pins.vertices) led.push_back(piece.points[v]);
            fastest = std::max(fastest, fastestPrescribed(pins.motion, led, duration));
        }
    for (const sim::SourceSettings& source : scene.sources)
        for (const sim::Emission& emission : source.emissions) fastest = std::max(fastest, emission.velocity.norm());
    const double gravity = scene.settings.gravity.norm();
    for (const sim::OpeningSettings& opening : scene.openings) {
        // From its level liquid may fall through all of the domain.
        const double fall = std::isfinite(opening.level) ? std::abs(opening.level) + scene.domain->bounds().sizes().maxCoeff() : 0.0;
        fastest = std::max(fastest, opening.isInlet() ? opening.velocity : std::sqrt(2.0 * gravity * fall));
    }
    return fastest;
}

/// √(2 P/ρ), to which suction P [dyn/cm^2] takes liquid that nothing slows down [cm/s].
double fastestBySuction(const sim::Scene& scene)
{
    constexpr double kAlong = 2.0;  // suction along fibres, relative to that across
    const sim::Settings& settings = scene.settings;
    double suction = 0.0;
    if (settings.coupling.capillary)
        for (const sim::FabricPiece& piece : scene.fabrics) {
            const double fraction = piece.material.volumeFraction;
            suction = std::max(
                suction, kAlong * sim::PorousLaw({settings.porous.fibreDiameter, fraction}, settings.liquid, settings.coupling).suction(fraction));
        }
    return std::sqrt(2.0 * suction / settings.liquid.density);
}

}  // namespace

RunCourse courseOf(const std::filesystem::path& folder)
{
    RunCourse course;
    std::ifstream in(folder / "steps.jsonl");
    double mass = 0.0, longest = 0.0;  // of the liquid, at most [g]; of a step [s]
    for (std::string line; std::getline(in, line);) {
        const json step = json::parse(line, nullptr, false);
        if (!step.is_object()) continue;
        ++course.steps;
        course.time += step.value("dt", 0.0);
        longest = std::max(longest, step.value("dt", 0.0));
        course.largestSpeed = std::max(course.largestSpeed, step.value("max_speed", 0.0));
        if (mass == 0.0) mass = step.at("ledger").value("liquid_mass", 0.0);
    }
    const Energy energy = energyOf(folder / "energy_ledger.csv");
    if (mass > 0.0) course.commonSpeed = std::sqrt(2.0 * energy.largestKinetic / mass);
    double weight = 0.0;
    if (const auto file = folder / "resolved.yaml"; std::filesystem::exists(file) && course.time > 0.0) {
        const sim::Scene scene = sim::loadScene(file);
        course.prescribedSpeed = fastestPrescribed(scene, course.time);
        course.suctionSpeed = fastestBySuction(scene);
        weight = scene.settings.gravity.norm();
    }
    const Contents contents = contentsOf(folder, mass);
    const double least = std::max(negligibleSpeed(contents.cell, course.time), weight * longest);
    const double scale = std::max(energy.largestKinetic, 0.5 * contents.mass * least * least);
    if (scale > 0.0) course.energyGain = energy.gain / scale;
    return course;
}

std::string whyUnsound(const RunCourse& course)
{
    if (course.energyGain > kAllowedGain) return fmt::format("energy: gained {:.3g} of its largest kinetic energy", course.energyGain);
    if (course.commonSpeed > 0.0 &&
        course.largestSpeed > std::max(kAllowedSpeed * std::max(course.commonSpeed, course.prescribedSpeed), course.suctionSpeed))
        return fmt::format("speed: a particle at {:.3g} cm/s; all liquid {:.3g} cm/s", course.largestSpeed, course.commonSpeed);
    return "";
}

}  // namespace app

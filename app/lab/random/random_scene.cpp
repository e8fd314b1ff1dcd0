#include "app/lab/random/random_scene.h"

#include "app/lab/random/random_bodies.h"
#include "sim/scene/old_keys.h"

#include <fmt/format.h>

namespace app {

namespace {

/// What a scene is about.
struct Composition {
    bool hasLiquid = true, hasFabric = true, hasObstacles = true, hasTank = true;
};

Composition randomComposition(RandomSource& random)
{
    const double what = random.between(0.0, 1.0);
    Composition cast;
    cast.hasFabric = what > 0.35;
    cast.hasLiquid = what < 0.8;
    cast.hasObstacles = random.chance(0.6);
    cast.hasTank = random.chance(0.6);
    return cast;
}

/// Published steps are 2e-4 s.
std::string randomTime(RandomSource& random, const RandomPile& pile, double dt)
{
    const std::string_view mode = random.oneOf({"fixed", "cfl", "adaptive"});
    const std::string_view integrator = random.oneOf({"plain", "plain", "reflected"});
    const double cfl = random.acrossScales(0.2, 3.0);
    const std::string lifted = random.chance(0.3) ? ", max_cfl: {liquid: 30, fabric: 30}" : "";
    return fmt::format("time: {{dt: {:.4g}, duration: {:.4g}, mode: {}, cfl: {:.3g}, dt_min: {:.3g}, integrator: {}{}}}\n", dt, pile.duration, mode,
                       cfl, dt / 300.0, integrator, lifted);
}

sim::Vec3 randomGravity(RandomSource& random)
{
    constexpr double kEarth = 981.0;
    const double size = random.chance(0.1) ? 0.0 : random.chance(0.7) ? kEarth : random.acrossScales(1.0, 1.0e4);
    const sim::Vec3 direction = random.chance(0.8) ? sim::Vec3(0.0, -1.0, 0.0) : random.direction();
    return size * direction;
}

std::string randomTransfer(RandomSource& random)
{
    const std::string_view method = random.oneOf({"pic", "flip", "apic", "polypic", "polypic", "polypic"});
    const int modes = random.chance(0.4) ? random.whole(1, 27) : random.chance(0.5) ? 8 : 27;
    const std::string_view xi = random.oneOf({"translation", "affine", "affine_conservative"});
    std::string text = fmt::format("transfer: {{method: {}, modes: {}, xi: {}", method, modes, xi);
    if (random.chance(0.3)) text += fmt::format(", flip_ratio: {:.3g}", random.between(0.0, 1.0));
    if (random.chance(0.3)) {
        const auto lost = [](double kept) { return sim::lostText(std::stod(fmt::format("{:.4g}", kept))); };
        const double affine = random.between(0.9, 1.0), stretch = random.between(0.0, 1.0), rotation = random.between(0.9, 1.0);
        text += fmt::format(", damping: {{liquid_affine: {}, fabric_stretch: {}, fabric_rotation: {}}}, damping_dt: {}", lost(affine), lost(stretch),
                            lost(rotation), random.oneOf({"step", "2.0e-4"}));
    }
    return text + "}\n";
}

std::string randomLiquid(RandomSource& random, RandomPile& pile, bool hasTank)
{
    std::string text = "liquid:\n";
    const bool isThick = random.chance(0.35);
    text += fmt::format("  density: {:.3g}\n", random.chance(0.5) ? 1.0 : random.acrossScales(0.05, 20.0));
    text += fmt::format("  viscosity: {:.3g}\n", isThick ? random.acrossScales(1.0e-2, 1.0e4) : 8.9e-3);
    text += fmt::format("  solve_viscosity: {}\n", isThick || random.chance(0.1));
    text += fmt::format("  surface_tension: {:.3g}\n", random.acrossScales(1.0, 1.0e3));
    text += fmt::format("  surface_tension_force: {}\n", random.chance(0.2));
    text += fmt::format("  surface_order: {}\n", random.chance(0.2) ? 1 : 2);
    text += fmt::format("  contact_angle: {:.3g}\n", random.between(0.0, 180.0));
    text += fmt::format("  wall_friction: {:.3g}\n", random.chance(0.5) ? 0.0 : random.between(0.0, 1.0));
    if (random.chance(0.4)) text += fmt::format("  particle_spacing: {:.3g}\n", random.between(0.25, 0.7));
    if (random.chance(0.3)) text += fmt::format("  volume: {{rate: {:.3g}}}\n", random.acrossScales(1.0, 1.0e4));
    if (random.chance(0.2)) text += fmt::format("  relax: {{rate: {:.3g}}}\n", random.acrossScales(1.0, 1.0e4));
    return text + "  sources:\n" + randomSources(random, pile, hasTank && random.chance(0.5));
}

/// Stiffness and density reach far to both sides of cotton's and wool's.
std::string randomMaterial(RandomSource& random)
{
    constexpr double kUsualYoung = 1.0e7;  // [dyn/cm^2]
    std::string text = fmt::format("  thread:\n    young: {:.3g}\n", kUsualYoung * random.acrossScales(0.01, 100.0));
    text += fmt::format("    poisson: {:.3g}\n", random.between(-0.3, 0.49));
    text += fmt::format("    density: {:.3g}\n", random.acrossScales(0.05, 20.0));
    text += fmt::format("    damping_viscosity: {:.3g}\n", random.chance(0.3) ? 0.0 : random.acrossScales(1.0, 1.0e5));
    text += fmt::format("    friction_angle: {:.3g}\n", random.chance(0.3) ? 0.0 : random.between(0.0, 60.0));
    text += fmt::format("    contact_stiffness: {:.3g}\n", random.acrossScales(1.0e-3, 1.0));
    text += fmt::format("    pin_stiffness: {:.3g}\n", random.acrossScales(1.0e-3, 1.0));
    return text;
}

std::string randomFabricSettings(RandomSource& random)
{
    const double fibre = random.acrossScales(1.0e-3, 3.0e-2), fraction = random.between(0.1, 0.9);
    std::string text = fmt::format("porous: {{fibre_diameter: {:.3g}, volume_fraction: {:.3g}}}\nfabric:\n", fibre, fraction);
    text += fmt::format("  solver: {}\n", random.oneOf({"vertex", "vertex", "vertex", "grid", "grid", "grid", "off"}));
    text += fmt::format("  membrane: {}\n", random.oneOf({"stvk", "neo_hookean"}));
    text += fmt::format("  bending: {}\n", random.oneOf({"shape_operator", "hinge"}));
    text += fmt::format("  hinge: {{measure: {}}}\n", random.oneOf({"angle", "sin", "tan"}));
    text += fmt::format("  torsion: {}\n", random.oneOf({"ellipse", "polar"}));
    text += fmt::format("  twist: {}\n", random.chance(0.8));
    text += fmt::format("  newton: {}\n", random.whole(1, 4));
    text += fmt::format("  contact: {}\n", random.chance(0.9));
    text += fmt::format("  max_halvings: {}\n", random.whole(0, 6));
    return text;
}

std::string randomCoupling(RandomSource& random)
{
    std::string text = fmt::format("coupling:\n  drag: {}\n", random.oneOf({"nonlinear", "nonlinear", "linear", "off"}));
    text += fmt::format("  drag_exponent: {:.3g}\n", random.between(1.0, 2.0));
    text += fmt::format("  pressure_on_fabric: {}\n", random.chance(0.8));
    text += fmt::format("  capillary: {}\n", random.chance(0.7));
    text += fmt::format("  capillary_reaction: {}\n", random.chance(0.5));
    const double factor = random.chance(0.3) ? 0.0 : random.acrossScales(0.1, 10.0);
    const bool isPublished = random.chance(0.3);
    text += fmt::format("  drag_fraction: {}\n", isPublished ? "cell" : "fabric");
    text += isPublished ? fmt::format("  capture: {{law: published, published_rate_factor: {:.3g}}}\n", factor)
                        : fmt::format("  capture: {{rate: {:.3g}}}\n", 25.0 * factor);
    text += fmt::format("  wicking: {{rate_scale: {:.3g}}}\n", random.chance(0.2) ? 0.0 : random.acrossScales(0.1, 10.0));
    text += fmt::format("  drip: {}\n", random.chance(0.7));
    return text;
}

/// A box with walls of a tenth to one cell, not on the grid; `vessel`: all of it.
std::string randomVessel(RandomSource& random, double cell, Eigen::AlignedBox3d& vessel)
{
    const sim::Vec3 half = cell * sim::Vec3{random.between(6.0, 9.0), 20.0, random.between(6.0, 9.0)};
    const double thickness = random.acrossScales(0.1, 1.0) * cell;
    const sim::Vec3 center = sim::Vec3{random.between(-0.5, 0.5) * cell, half.y(), random.between(-0.5, 0.5) * cell};
    const auto box = [&](double out) {
        return fmt::format("{{box: {{center: {}, half: {}}}}}", listText(center), listText(half + sim::Vec3::Constant(out)));
    };
    vessel = {center - half - sim::Vec3::Constant(thickness), center + half + sim::Vec3::Constant(thickness)};
    return fmt::format("  - {{name: vessel, shape: {{subtract: [{}, {}]}}}}\n", box(thickness), box(0.0));
}

std::string randomTank(RandomSource& random, double cell)
{
    const double half = random.between(7.0, 10.0) * cell;
    constexpr double kHeight = 60.0;  // cells: nothing gets out at the top
    const double middle = 0.5 * kHeight * cell;
    const sim::Vec3 size(half, middle, half);
    const std::string box = fmt::format("center: [0, {:.4g}, 0]", middle);
    std::string shape = fmt::format("{{box: {{{}, half: {}}}}}", box, listText(size));
    if (random.chance(0.3)) shape = fmt::format("{{cylinder: {{{}, radius: {:.4g}, half: {:.4g}}}}}", box, half, middle);
    return fmt::format("  - {{name: tank, inside: true, shape: {}}}\n", shape);
}

/// A stream through the liquid, or an outlet that it leaves by, in faces of a domain that is closer around the pile.
/// @param domain  out: that domain
std::string randomOpenings(RandomSource& random, const RandomPile& pile, bool hasGravity, std::string& domain)
{
    const double cell = pile.cell, half = random.between(4.2, 6.0) * cell, height = pile.height + random.between(4.0, 30.0) * cell;
    domain = fmt::format("{{box: {{min: [{0:.4g}, 0, {0:.4g}], max: [{1:.4g}, {2:.4g}, {1:.4g}]}}}}", -half, half, height);
    const auto level = [&] { return hasGravity ? fmt::format(", level: {:.4g}", random.between(0.5, 6.0) * cell) : std::string(); };
    std::string text = "  openings:\n";
    const std::string_view axis = random.oneOf({"x", "z"});
    const bool isInverted = random.chance(0.5);
    if (random.chance(0.7))
        text += fmt::format("    - {{name: inlet, face: {}{}, velocity: {:.3g}{}}}\n", axis, isInverted ? "+" : "-", random.acrossScales(1.0, 100.0),
                            random.chance(0.7) ? level() : "");
    text += fmt::format("    - {{name: outlet, face: {}{}{}}}\n",
                        random.chance(0.8) ? axis
                        : axis == "x"      ? "z"
                                           : "x",
                        isInverted ? "-" : "+", level());
    return text;
}

/// Small pictures: of the start, the middle and all but the end.
std::string pictures(const RandomPile& pile, const std::string& domain)
{
    constexpr double kHalf = 0.499;  // of the duration, of which the file has four digits only
    return fmt::format(
        "domain: {}\nrender: {{size: [96, 96], samples: 1}}\noutput: {{every: {:.6g}, data: [energy, stats, ledger, "
        "checkpoint], checkpoint: {{every: {:.6g}}}}}\n",
        domain, kHalf * pile.duration, kHalf * pile.duration);
}

}  // namespace

std::string randomSceneName(std::uint64_t seed, int number) { return fmt::format("random_{}_{}", seed, number); }

RandomScene randomScene(std::uint64_t seed, int number)
{
    constexpr double kPublishedStep = 2.0e-4;        // [s]
    constexpr std::uint64_t kOpenings = 1ull << 40;  // numbers of their own: scenes without openings are those that they were
    RandomSource random(seed, static_cast<std::uint64_t>(number));
    const double cell = random.acrossScales(0.08, 0.5), dt = kPublishedStep * random.acrossScales(0.5, 20.0);
    RandomPile pile{.cell = cell, .duration = dt * random.whole(30, 80), .height = 0.5 * cell};
    const Composition cast = randomComposition(random);

    std::string text = fmt::format("drench: 1\nscene: {{name: {}}}\n", randomSceneName(seed, number));
    text += randomTime(random, pile, dt);
    text += fmt::format("grid: {{cell: {:.4g}}}\n", cell);
    const sim::Vec3 gravity = randomGravity(random);
    text += fmt::format("gravity: {}\n", listText(gravity));
    text += randomTransfer(random);
    RandomScene scene;
    std::string obstacles;
    if (cast.hasTank && random.chance(0.4)) obstacles = randomVessel(random, cell, scene.vessel.emplace());
    else if (cast.hasTank) obstacles = randomTank(random, cell);
    if (cast.hasObstacles) obstacles += randomObstacles(random, pile);
    if (!obstacles.empty()) text += "obstacles:\n" + obstacles;
    if (cast.hasFabric) {
        text += "materials:\n" + randomMaterial(random);
        text += randomFabricSettings(random);
        text += "fabrics:\n" + randomFabrics(random, pile);
    }
    const double far = 60.0 * cell;
    std::string domain = fmt::format("{{box: {{center: [0, 0, 0], half: {}}}}}", listText({far, far, far}));
    if (cast.hasLiquid) text += randomLiquid(random, pile, cast.hasTank);
    RandomSource ofOpenings(seed + kOpenings, static_cast<std::uint64_t>(number));
    const bool hasLevel = gravity.isZero(0.0) || gravity.cwiseAbs().maxCoeff() == gravity.norm();
    // A closed vessel has none: what comes in beside it or over it would count as escaped.
    if (cast.hasLiquid && hasLevel && !scene.vessel && ofOpenings.chance(0.25))
        text += randomOpenings(ofOpenings, pile, !gravity.isZero(0.0), domain);
    if (cast.hasFabric && cast.hasLiquid) text += randomCoupling(random);
    scene.text = text + pictures(pile, domain);
    return scene;
}

}  // namespace app

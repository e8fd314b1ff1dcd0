#include "app/lab/random/random_scene.h"

#include "app/lab/random/random_bodies.h"

#include <fmt/format.h>

namespace app {

namespace {

/// What a scene is about.
struct Cast {
    bool hasLiquid = true, hasFabric = true, hasObstacles = true, hasTank = true;
};

Cast randomCast(Dice& dice)
{
    const double what = dice.between(0.0, 1.0);
    Cast cast;
    cast.hasFabric = what > 0.35;
    cast.hasLiquid = what < 0.8;
    cast.hasObstacles = dice.chance(0.6);
    cast.hasTank = dice.chance(0.6);
    return cast;
}

/// Published steps are 2e-4 s.
std::string randomTime(Dice& dice, const RandomPile& pile, double dt)
{
    const std::string_view mode = dice.oneOf({"fixed", "cfl", "adaptive"});
    const std::string_view integrator = dice.oneOf({"plain", "plain", "reflected"});
    const double cfl = dice.acrossScales(0.2, 3.0);
    const std::string lifted = dice.chance(0.3) ? ", max_cfl: {liquid: 30, fabric: 30}" : "";
    return fmt::format("time: {{dt: {:.4g}, duration: {:.4g}, mode: {}, cfl: {:.3g}, dt_min: {:.3g}, integrator: {}{}}}\n", dt, pile.duration, mode,
                       cfl, dt / 300.0, integrator, lifted);
}

std::string randomGravity(Dice& dice)
{
    constexpr double kEarth = 981.0;
    const double size = dice.chance(0.1) ? 0.0 : dice.chance(0.7) ? kEarth : dice.acrossScales(1.0, 1.0e4);
    const sim::Vec3 direction = dice.chance(0.8) ? sim::Vec3(0.0, -1.0, 0.0) : dice.direction();
    return fmt::format("gravity: {}\n", listText(size * direction));
}

std::string randomTransfer(Dice& dice)
{
    const std::string_view method = dice.oneOf({"pic", "flip", "apic", "polypic", "polypic", "polypic"});
    const int modes = dice.chance(0.4) ? dice.whole(1, 27) : dice.chance(0.5) ? 8 : 27;
    const std::string_view xi = dice.oneOf({"translation", "affine", "affine_conservative"});
    std::string text = fmt::format("transfer: {{method: {}, modes: {}, xi: {}", method, modes, xi);
    if (dice.chance(0.3)) text += fmt::format(", flip_ratio: {:.3g}", dice.between(0.0, 1.0));
    if (dice.chance(0.3)) {
        const double affine = dice.between(0.9, 1.0), stretch = dice.between(0.0, 1.0), rotation = dice.between(0.9, 1.0);
        text += fmt::format(", keep: {{liquid_affine: {:.4g}, fabric_stretch: {:.4g}, fabric_rotation: {:.4g}}}, keep_dt: {}", affine, stretch,
                            rotation, dice.oneOf({"step", "2.0e-4"}));
    }
    return text + "}\n";
}

std::string randomLiquid(Dice& dice, RandomPile& pile, bool hasTank)
{
    std::string text = "liquid:\n";
    const bool isThick = dice.chance(0.35);
    text += fmt::format("  density: {:.3g}\n", dice.chance(0.5) ? 1.0 : dice.acrossScales(0.05, 20.0));
    text += fmt::format("  viscosity: {:.3g}\n", isThick ? dice.acrossScales(1.0e-2, 1.0e4) : 8.9e-3);
    text += fmt::format("  solve_viscosity: {}\n", isThick || dice.chance(0.1));
    text += fmt::format("  surface_tension: {:.3g}\n", dice.acrossScales(1.0, 1.0e3));
    text += fmt::format("  surface_tension_force: {}\n", dice.chance(0.2));
    text += fmt::format("  contact_angle: {:.3g}\n", dice.between(0.0, 180.0));
    text += fmt::format("  wall_friction: {:.3g}\n", dice.chance(0.5) ? 0.0 : dice.between(0.0, 1.0));
    if (dice.chance(0.4)) text += fmt::format("  particle_spacing: {:.3g}\n", dice.between(0.25, 0.7));
    if (dice.chance(0.3)) text += fmt::format("  volume: {{rate: {:.3g}}}\n", dice.acrossScales(1.0, 1.0e4));
    if (dice.chance(0.2)) text += fmt::format("  relax: {{rate: {:.3g}}}\n", dice.acrossScales(1.0, 1.0e4));
    return text + "  sources:\n" + randomSources(dice, pile, hasTank && dice.chance(0.5));
}

/// Stiffness and density reach far to both sides of cotton's and wool's.
std::string randomMaterial(Dice& dice)
{
    constexpr double kUsualYoung = 1.0e7;  // [dyn/cm^2]
    std::string text = fmt::format("  thread:\n    young: {:.3g}\n", kUsualYoung * dice.acrossScales(0.01, 100.0));
    text += fmt::format("    poisson: {:.3g}\n", dice.between(-0.3, 0.49));
    text += fmt::format("    density: {:.3g}\n", dice.acrossScales(0.05, 20.0));
    text += fmt::format("    damping_viscosity: {:.3g}\n", dice.chance(0.3) ? 0.0 : dice.acrossScales(1.0, 1.0e5));
    text += fmt::format("    friction_angle: {:.3g}\n", dice.chance(0.3) ? 0.0 : dice.between(0.0, 60.0));
    text += fmt::format("    contact_stiffness: {:.3g}\n", dice.acrossScales(1.0e-3, 1.0));
    text += fmt::format("    pin_stiffness: {:.3g}\n", dice.acrossScales(1.0e-3, 1.0));
    return text;
}

std::string randomFabricSettings(Dice& dice)
{
    const double fibre = dice.acrossScales(1.0e-3, 3.0e-2), fraction = dice.between(0.1, 0.9);
    std::string text = fmt::format("porous: {{fibre_diameter: {:.3g}, volume_fraction: {:.3g}}}\nfabric:\n", fibre, fraction);
    text += fmt::format("  solver: {}\n", dice.oneOf({"vertex", "vertex", "vertex", "grid", "grid", "grid", "off"}));
    text += fmt::format("  membrane: {}\n", dice.oneOf({"stvk", "neo_hookean"}));
    text += fmt::format("  bending: {}\n", dice.oneOf({"shape_operator", "hinge"}));
    text += fmt::format("  hinge: {{measure: {}}}\n", dice.oneOf({"angle", "sin", "tan"}));
    text += fmt::format("  torsion: {}\n", dice.oneOf({"ellipse", "polar"}));
    text += fmt::format("  twist: {}\n", dice.chance(0.8));
    text += fmt::format("  newton: {}\n", dice.whole(1, 4));
    text += fmt::format("  contact: {}\n", dice.chance(0.9));
    text += fmt::format("  max_halvings: {}\n", dice.whole(0, 6));
    return text;
}

std::string randomCoupling(Dice& dice)
{
    std::string text = fmt::format("coupling:\n  drag: {}\n", dice.oneOf({"nonlinear", "nonlinear", "linear", "off"}));
    text += fmt::format("  drag_exponent: {:.3g}\n", dice.between(1.0, 2.0));
    text += fmt::format("  pressure_on_fabric: {}\n", dice.chance(0.8));
    text += fmt::format("  capillary: {}\n", dice.chance(0.7));
    text += fmt::format("  capillary_reaction: {}\n", dice.chance(0.5));
    const double factor = dice.chance(0.3) ? 0.0 : dice.acrossScales(0.1, 10.0);
    const bool isPublished = dice.chance(0.3);
    text += fmt::format("  drag_fraction: {}\n", isPublished ? "cell" : "fabric");
    text += isPublished ? fmt::format("  capture: {{law: published, compat_factor: {:.3g}}}\n", factor)
                        : fmt::format("  capture: {{rate: {:.3g}}}\n", 25.0 * factor);
    text += fmt::format("  wicking: {{rate_scale: {:.3g}}}\n", dice.chance(0.2) ? 0.0 : dice.acrossScales(0.1, 10.0));
    text += fmt::format("  drip: {}\n", dice.chance(0.7));
    return text;
}

/// A box with walls of a tenth to one cell, not on the grid; `vessel`: all of it.
std::string randomVessel(Dice& dice, double cell, Eigen::AlignedBox3d& vessel)
{
    const sim::Vec3 half = cell * sim::Vec3{dice.between(6.0, 9.0), 20.0, dice.between(6.0, 9.0)};
    const double thickness = dice.acrossScales(0.1, 1.0) * cell;
    const sim::Vec3 center = sim::Vec3{dice.between(-0.5, 0.5) * cell, half.y(), dice.between(-0.5, 0.5) * cell};
    const auto box = [&](double out) {
        return fmt::format("{{box: {{center: {}, half: {}}}}}", listText(center), listText(half + sim::Vec3::Constant(out)));
    };
    vessel = {center - half - sim::Vec3::Constant(thickness), center + half + sim::Vec3::Constant(thickness)};
    return fmt::format("  - {{name: vessel, shape: {{subtract: [{}, {}]}}}}\n", box(thickness), box(0.0));
}

std::string randomTank(Dice& dice, double cell)
{
    const double half = dice.between(7.0, 10.0) * cell;
    constexpr double kHeight = 60.0;  // cells: nothing gets out at the top
    const double middle = 0.5 * kHeight * cell;
    const sim::Vec3 size(half, middle, half);
    const std::string box = fmt::format("center: [0, {:.4g}, 0]", middle);
    std::string shape = fmt::format("{{box: {{{}, half: {}}}}}", box, listText(size));
    if (dice.chance(0.3)) shape = fmt::format("{{cylinder: {{{}, radius: {:.4g}, half: {:.4g}}}}}", box, half, middle);
    return fmt::format("  - {{name: tank, inside: true, shape: {}}}\n", shape);
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
    constexpr double kPublishedStep = 2.0e-4;  // [s]
    Dice dice(seed, static_cast<std::uint64_t>(number));
    const double cell = dice.acrossScales(0.08, 0.5), dt = kPublishedStep * dice.acrossScales(0.5, 20.0);
    RandomPile pile{.cell = cell, .duration = dt * dice.whole(30, 80), .height = 0.5 * cell};
    const Cast cast = randomCast(dice);

    std::string text = fmt::format("drench: 1\nscene: {{name: {}}}\n", randomSceneName(seed, number));
    text += randomTime(dice, pile, dt);
    text += fmt::format("grid: {{cell: {:.4g}}}\n", cell);
    text += randomGravity(dice);
    text += randomTransfer(dice);
    RandomScene scene;
    std::string obstacles;
    if (cast.hasTank && dice.chance(0.4)) obstacles = randomVessel(dice, cell, scene.vessel.emplace());
    else if (cast.hasTank) obstacles = randomTank(dice, cell);
    if (cast.hasObstacles) obstacles += randomObstacles(dice, pile);
    if (!obstacles.empty()) text += "obstacles:\n" + obstacles;
    if (cast.hasFabric) {
        text += "materials:\n" + randomMaterial(dice);
        text += randomFabricSettings(dice);
        text += "fabrics:\n" + randomFabrics(dice, pile);
    }
    if (cast.hasLiquid) text += randomLiquid(dice, pile, cast.hasTank);
    if (cast.hasFabric && cast.hasLiquid) text += randomCoupling(dice);
    const double far = 60.0 * cell;
    scene.text = text + pictures(pile, fmt::format("{{box: {{center: [0, 0, 0], half: {}}}}}", listText({far, far, far})));
    return scene;
}

}  // namespace app

#include "app/import/read_reference.h"

#include "sim/scene/source_location.h"

#include <fmt/format.h>

namespace app {

using namespace reference;

namespace {

constexpr int kSkipped = -1;  // as params of a cloth: it is left out
constexpr std::size_t kMostYarnPoints = 20'000'000;

Particle readParticle(const XmlElement& element)
{
    Particle p;
    p.line = element.line();
    if (!element.has("x")) element.fail("particle@x is missing; it is the position, like x=\"0 1 0\"");
    p.x = element.vector("x", p.x);
    p.v = element.vector("v", p.v);
    const int held = element.integer("fixed", 0);
    if (held < 0 || held > 3) element.fail(fmt::format("particle@fixed: {} is unknown; 1 holds the place, 2 the twist, 3 both", held));
    p.isHeld = (held & 1) != 0;
    p.isTwistHeld = (held & 2) != 0;
    p.group = element.integer("group", 0);
    if (p.group < 0) element.fail(fmt::format("particle@group: {} must not be below 0", p.group));
    p.radius[0] = element.number("radius", 0.0);
    p.radius[1] = element.number("biradius", p.radius[0]);
    p.mass = element.number("m", 0.0);
    p.volume = element.number("vol", 0.0);
    element.number("fm", 0.0);  // density times fvol
    p.liquidVolume = element.number("fvol", 0.0);
    p.hasFraction = element.has("vf");
    element.number("vf", 1.0);
    p.isTwisted = element.number("theta", 0.0) != 0.0 || element.number("omega", 0.0) != 0.0;
    p.isLiquid = element.text("state") == "liquid";
    return p;
}

/// Refuses a number that is no particle's.
void requireParticle(const XmlElement& element, const char* what, long number, const Scene& scene)
{
    if (number >= 0 && number < static_cast<long>(scene.particles.size())) return;
    element.fail(scene.particles.empty()
                     ? fmt::format("{} names particle {}, but the file has no particles; add them, or remove this element", what, number)
                     : fmt::format("{} names particle {}, but the file has 0 to {} only; correct the number, or add the particles", what, number,
                                   scene.particles.size() - 1));
}

int readMaterialNumber(const XmlElement& element, const char* what, const Scene& scene)
{
    const double number = element.number("params");
    const int count = static_cast<int>(scene.materials.size());
    if (number == kSkipped) return kSkipped;
    if (number != std::floor(number) || number < 0.0 || number >= count)
        element.fail(fmt::format("{}@params: there is no material {}; the file has {} <ElasticParameters>, counted from 0", what, number, count));
    return static_cast<int>(number);
}

Cloth readCloth(const XmlElement& element, const Scene& scene)
{
    Cloth cloth;
    cloth.line = element.line();
    cloth.material = readMaterialNumber(element, "cloth", scene);
    for (const XmlElement& face : element.children("face")) {
        const std::vector<int> corners = face.integers("i");
        if (corners.size() != 3)
            face.fail(fmt::format("face@i: needs three numbers of particles like \"0 1 2\", not {}", sim::inQuotes(face.text("i"))));
        for (const int corner : corners) requireParticle(face, "face@i", corner, scene);
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            face.fail(fmt::format("face@i: {} names a particle twice; a face has three different ones", sim::inQuotes(face.text("i"))));
        cloth.faces.emplace_back(corners[0], corners[1], corners[2]);
    }
    return cloth;
}

/// Consecutive particles, or listed ones.
Yarn readYarn(const XmlElement& element, const Scene& scene)
{
    Yarn yarn;
    yarn.line = element.line();
    yarn.material = readMaterialNumber(element, "hair", scene);
    for (const XmlElement& p : element.children("p")) {
        const std::vector<int> number = p.integers("i");
        if (number.size() != 1) p.fail(fmt::format("p@i: needs the number of a particle, not {}", sim::inQuotes(p.text("i"))));
        requireParticle(p, "p@i", number[0], scene);
        yarn.particles.push_back(number[0]);
    }
    if (yarn.particles.empty()) {
        const double start = element.number("start", 0.0), count = element.number("count", 0.0);
        if (start != std::floor(start) || count != std::floor(count) || count < 0.0)
            element.fail("hair@start and hair@count must be whole numbers like start=\"0\" count=\"8\"");
        constexpr double kLargest = 1.0e15;
        requireParticle(element, "hair@start", static_cast<long>(std::clamp(start, -1.0, kLargest)), scene);
        if (count > 0.0) requireParticle(element, "hair@count", static_cast<long>(std::min(start + count - 1.0, kLargest)), scene);
        for (double i = 0.0; i < count; ++i) yarn.particles.push_back(static_cast<int>(start + i));
    }
    if (yarn.particles.size() < 2) element.fail("a hair of fewer than two particles has no edge; give it start and count, or <p i=\"…\"/> for each");
    for (std::size_t i = 1; i < yarn.particles.size(); ++i)
        if (yarn.particles[i] == yarn.particles[i - 1])
            element.fail(fmt::format("a hair goes from particle {} to itself; remove one of them", yarn.particles[i]));
    return yarn;
}

}  // namespace

void readReferenceFabric(const XmlElement& scene, Scene& out)
{
    for (const XmlElement& element : scene.children("particle")) out.particles.push_back(readParticle(element));
    for (const XmlElement& element : scene.children("cloth")) {
        Cloth cloth = readCloth(element, out);
        if (cloth.material != kSkipped && !cloth.faces.empty()) out.cloths.push_back(std::move(cloth));
    }
    std::size_t points = 0;
    for (const XmlElement& element : scene.children("hair")) {
        Yarn yarn = readYarn(element, out);
        points += yarn.particles.size();
        if (points > kMostYarnPoints)
            element.fail(
                fmt::format("the hairs up to this one have {} points together, at most {} are possible; remove some", points, kMostYarnPoints));
        if (yarn.material != kSkipped) out.yarns.push_back(std::move(yarn));
    }
}

}  // namespace app

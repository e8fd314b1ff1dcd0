#include "app/ensemble/vary.h"

#include "sim/core/check.h"
#include "sim/core/random.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace app {

namespace {

using Pattern = sim::FillSettings::Pattern;

[[noreturn]] void refuse(const std::string& text)
{
    throw sim::InputError(
        fmt::format("--vary {}: give seed, positions, or a key and the range it is drawn from, like liquid.viscosity=0.5..1.5", text));
}

double numberIn(const std::string& number, const std::string& text)
{
    double x = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), x);
    if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(x)) refuse(text);
    return x;
}

/// Other random numbers for the particles of all sources that have some, or are to get some.
std::vector<std::string> seedSets(bool alsoLattices, const sim::Scene& scene, std::uint64_t number)
{
    std::vector<std::string> sets;
    for (std::size_t n = 0; n < scene.sources.size(); ++n) {
        const sim::FillSettings& fill = scene.sources[n].fill;
        if (fill.pattern == Pattern::Lattice && !alsoLattices) continue;
        if (fill.pattern == Pattern::Lattice) sets.push_back(fmt::format("liquid.sources.{}.fill.pattern=jittered", n));
        sets.push_back(fmt::format("liquid.sources.{}.fill.seed={}", n, fill.seed + number));
    }
    if (!sets.empty()) return sets;
    if (scene.sources.empty())
        throw sim::InputError(
            fmt::format("{}: there is no liquid whose particles could be laid otherwise; vary a setting: --vary key=a..b", scene.file));
    throw sim::InputError(fmt::format("{}: particles of all sources lie on lattices, which have no seed; --vary positions moves them", scene.file));
}

}  // namespace

Vary readVary(const std::string& text)
{
    if (text == "seed") return {.what = Vary::What::Seed, .key = {}};
    if (text == "positions") return {.what = Vary::What::Positions, .key = {}};
    const std::size_t equals = text.find('='), dots = text.find("..", equals == std::string::npos ? 0 : equals);
    if (equals == 0 || equals == std::string::npos || dots == std::string::npos) refuse(text);
    const Vary vary = {.what = Vary::What::Key,
                       .key = text.substr(0, equals),
                       .low = numberIn(text.substr(equals + 1, dots - equals - 1), text),
                       .high = numberIn(text.substr(dots + 2), text)};
    if (!(vary.low < vary.high)) refuse(text);
    return vary;
}

std::vector<std::string> setsOfRun(const std::vector<Vary>& varied, const sim::Scene& scene, std::uint64_t number)
{
    constexpr std::uint64_t kStream = 0x656e73656d626c65u;  // numbers of their own
    std::vector<std::string> sets;
    for (std::size_t n = 0; n < varied.size(); ++n) {
        const Vary& vary = varied[n];
        if (vary.what == Vary::What::Key) {
            const double share = sim::CounterRandom(number, kStream).uniform(n);
            sets.push_back(fmt::format("{}={:.9g}", vary.key, std::lerp(vary.low, vary.high, share)));
        } else {
            const std::vector<std::string> seeds = seedSets(vary.what == Vary::What::Positions, scene, number);
            sets.insert(sets.end(), seeds.begin(), seeds.end());
        }
    }
    return sets;
}

}  // namespace app

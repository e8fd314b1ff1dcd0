#include "sim/scene/describe_fabric.h"
#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_list.h"
#include "sim/scene/section_reader.h"

#include <algorithm>

namespace sim {

void resolvePorous(const SectionReader& section, double poreRadius, double threads, double thickness, PorousSettings& porous)
{
    const bool byDiameter = section.has("fibre_diameter"), byFraction = section.has("volume_fraction");
    const bool byPores = section.has("pore_radius"), byThreads = section.has("thread_count");
    const auto refuse = [&](const std::string& what) { fail(section.location(), fmt::format("{}: {}", section.path(), what)); };
    if (byThreads != section.has("thickness")) refuse("thread_count and thickness need each other");
    if (byThreads) {
        if (!byDiameter || byFraction || byPores) refuse("thread_count needs fibre_diameter, and neither of the others");
        const double share = kPi * porous.fibreDiameter * porous.fibreDiameter * threads / (4.0 * thickness);
        porous.volumeFraction = std::min(share, 1.0);
        return;
    }
    if (byDiameter + byFraction + byPores != 2) refuse("needs two of fibre_diameter, volume_fraction, pore_radius");
    if (!byPores) return;
    if (byDiameter) {
        const double ratio = 2.0 * poreRadius / porous.fibreDiameter;
        porous.volumeFraction = 1.0 / (1.0 + ratio * ratio);
    } else {
        if (!(porous.volumeFraction < 1.0)) refuse("with volume_fraction 1 there are no pores; leave pore_radius out");
        porous.fibreDiameter = 2.0 * poreRadius * std::sqrt(porous.volumeFraction / (1.0 - porous.volumeFraction));
    }
}

std::vector<NamedMaterial> readMaterials(const Node& root, PorousSettings& porous)
{
    std::vector<NamedMaterial> materials;
    const Node* section = root.find("materials");
    if (!section) return materials;
    if (!section->isMap()) fail(section->location, fmt::format("materials: needs a map like {{wool: {{young: 6.6e+7}}}}, not {}", section->called()));
    for (std::size_t i = 0; i < section->keys.size(); ++i) {
        const Node& node = section->items[i];
        NamedMaterial& m = materials.emplace_back();
        m.name = section->keys[i];
        requireName(m.name, node.location, "materials");
        m.material.volumeFraction = porous.volumeFraction;
        const std::string path = joinPath("materials", m.name);
        SectionReader::read(&node, path, [&](auto& v) { visitFields(v, m.material); });
        if (const FabricPreset* preset = fabricPresetOf(SectionReader(node, path))) m.fibreDiameter = preset->fibreDiameter;
    }
    const auto first = std::ranges::find_if(materials, [](const NamedMaterial& m) { return m.fibreDiameter > 0.0; });
    if (!root.find("porous") && first != materials.end()) porous.fibreDiameter = first->fibreDiameter;
    return materials;
}

}  // namespace sim

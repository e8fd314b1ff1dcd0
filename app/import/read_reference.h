#pragma once

#include "app/import/reference_scene.h"
#include "app/import/xml_element.h"
#include "app/options.h"

namespace app {

/// Everything that a scene of libWetCloth says; `names` gets all the names that were asked for.
/// Throws InputError at the line of what is missing, no number, or out of range.
reference::Scene readReferenceScene(const XmlFile& file, const ImportOptions& options, NamesRead& names);

/// Parts of readReferenceScene.
reference::LiquidInfo readLiquidInfo(const XmlElement& scene, bool countsThreads);
std::vector<reference::Material> readReferenceMaterials(const XmlElement& scene, const ImportOptions& options);
void readReferenceFabric(const XmlElement& scene, reference::Scene& out);
std::vector<reference::Field> readReferenceFields(const XmlElement& scene);
std::vector<reference::Script> readReferenceScripts(const XmlElement& scene);

}  // namespace app

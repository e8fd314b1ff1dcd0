#include "app/schema/ask_reader.h"

#include "sim/core/check.h"

#include <memory>

namespace app {

std::vector<sim::DeclaredKey> keysReadBy(const std::string& text, const std::function<void(const sim::Node&)>& read)
{
    std::vector<sim::DeclaredKey> keys;
    const auto source = std::make_shared<sim::TextSource>();
    source->name = "schema";
    source->listener = [&](const sim::KeyList& asked) { keys = asked.keys; };
    const sim::Node node = sim::parseYaml(text, source);
    try {
        read(node);
    } catch (const sim::InputError&) {
        // An empty map lacks what is needed; by then its keys have been asked for.
    }
    SIM_CHECK(!keys.empty());
    return keys;
}

}  // namespace app

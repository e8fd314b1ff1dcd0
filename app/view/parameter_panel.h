#pragma once

#include "app/live/live_simulation.h"

#include <array>
#include <map>
#include <optional>
#include <string>

namespace app {

/// The settings of a scene with their values, units and help, to be changed while it is simulated.
class ParameterPanel {
 public:
    /// Into the window that is begun. What is entered goes to the simulation.
    void draw(LiveSimulation& live);
    /// Where the value of a setting was drawn last: its middle in the window [pixels]; nothing if it is not to be seen.
    std::optional<std::array<float, 2>> placeOf(const std::string& path) const;

 private:
    void drawWaiting(LiveSimulation& live, const LiveScene& scene) const;
    void drawGroups(LiveSimulation& live, const LiveScene& scene);
    void drawPresets(LiveSimulation& live) const;
    void drawParameter(LiveSimulation& live, const sim::Parameter& parameter);
    void drawText(LiveSimulation& live, const sim::Parameter& parameter);

    std::array<char, 64> wanted_{};  ///< show only settings with this in their names
    std::string entered_;            ///< text in the field that is being edited
    std::map<std::string, std::array<float, 2>> places_;
};

}  // namespace app

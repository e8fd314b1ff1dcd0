#pragma once

#include "app/frames/frame_snapshot.h"
#include "app/scene/picture_settings.h"
#include "render/look.h"
#include "sim/scene/parameters.h"

#include <array>
#include <optional>
#include <string>

namespace app {

/// How a scene is drawn in a window: begins as its file says, and is changed by the widgets of the part "Picture" of
/// the panel.
class LookPanel {
 public:
    explicit LookPanel(const PictureSettings& pictures);

    /// The widgets. True if snapshots are to show something else from now on: wanted().
    bool draw();
    const SnapshotExtras& wanted() const { return wanted_; }
    /// The setting of the scene's file that the pointer was on when the widgets were drawn last, with its unit and help; nothing if it was on none.
    const std::optional<sim::Parameter>& explained() const { return explained_; }
    /// For this snapshot: colour bars tell what its values are, be they those that are wanted or, for a moment, those
    /// that were wanted before, and liquid whose surface is not there yet is drawn as spheres.
    render::Look lookFor(const FrameSnapshot& snapshot) const;

 private:
    using Range = std::array<float, 2>;
    using FabricRanges = std::array<Range, 4>;  ///< ranges of values, by FabricColorBy

    void drawVisibility();
    void drawMarks();
    void drawLiquid();
    void drawFabric(const std::string& group, FabricColorBy& colorBy, FabricRanges& ranges, render::FabricLook& look);
    void chooseColors(const std::string& group, const char* rangeLabel, Range& range, render::ColorMap& map);
    void explainSetting(const std::string& path);

    const SceneContents contents_;
    LiquidStyle liquidStyle_;
    render::Look look_;  ///< look, but for what depends on the values of a snapshot
    SnapshotExtras wanted_;
    std::array<Range, 2> liquidRanges_;  ///< ranges of speeds and of pressures
    FabricRanges yarnRanges_, clothRanges_;
    std::optional<sim::Parameter> explained_;
};

}  // namespace app

#pragma once

#include <drench/simulation.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace drench {

/// Colours from the top row on, from the left, three bytes each.
struct Picture {
    int width = 0, height = 0;  ///< [pixels]
    std::vector<std::uint8_t> rgb;
};

/// Pictures of a simulation, without a window, as the scene's section `render` says. A camera that the scene does not place is put where it
/// sees all that the first picture shows, and stays there.
class Frames {
 public:
    /// @param shaders  folder with liquid.vert; left out: those installed with the library
    /// Throws InputError where the section is wrong, Error where nothing can be drawn.
#ifdef DRENCH_SHADERS
    explicit Frames(const Scene& scene, const std::string& shaders = DRENCH_SHADERS);
#else
    Frames(const Scene& scene, const std::string& shaders);
#endif
    Frames(Frames&&) noexcept;
    Frames& operator=(Frames&&) noexcept;
    ~Frames();

    /// Picture of a simulation of the same scene as it is.
    Picture draw(const Simulation& simulation);
    /// Writes that picture as a PNG, whole or not at all; its folder is made. Throws Error where that fails.
    void write(const Simulation& simulation, const std::string& file);

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// "folder/frame_00012.png": names that ffmpeg takes for a video, as folder/frame_%05d.png.
std::string frameFile(const std::string& folder, int number);

}  // namespace drench

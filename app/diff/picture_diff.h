#pragma once

#include "render/image_compare.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// Two pictures that are held against each other; one that is not there has an empty path.
struct PicturePair {
    std::string name;
    std::filesystem::path a, b;
};

struct PictureDiff {
    PicturePair pair;
    std::string problem;  ///< why there are no numbers: missing, or of another size; else empty
    render::ImageDifference difference;
    bool differs = false;  ///< whether they differ by more than the tolerance
};

/// Pictures of two folders by their names. Throws InputError where one of them has none.
/// @param subset  those that only b has do not count
std::vector<PicturePair> pairPictures(const std::filesystem::path& a, const std::filesystem::path& b, bool subset);

/// The worst first: those that differ before others, then by how much of them does. Throws std::runtime_error for a picture
/// that cannot be read, and InputError when stopped.
std::vector<PictureDiff> diffPictures(const std::vector<PicturePair>& pairs, const render::ImageTolerance& tolerance,
                                      const std::function<bool()>& stopWanted);

/// "frame_00012.png: mean SSIM 0.981, lowest 0.42 at (312, 188), …", with what was asked for where that is missed.
std::string wordsOf(const PictureDiff& diff, const render::ImageTolerance& tolerance);

/// A picture of three panels: A, B and what differs. Both must be there and of one size.
void drawPanels(const PicturePair& pair, const std::filesystem::path& target);

}  // namespace app

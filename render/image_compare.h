#pragma once

#include "render/image.h"

namespace render {

/// How alike two pictures look: 1 = the same. Local means, variances and covariance of the luminance under a Gaussian
/// window (sigma 1.5 pixels, 11 x 11). Source: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment".
struct Similarity {
    double mean = 0.0;                             ///< over all windows
    double lowest = 0.0;                           ///< of the worst window: catches a small thing that is missing
};

/// Throws std::invalid_argument if the pictures differ in size. At the border the window is cut and reweighted.
Similarity structuralSimilarity(const Image& a, const Image& b);

/// Mean over pixels and channels of |a − b|, in steps of 255: sees changes of hue that leave the luminance alone.
/// Throws std::invalid_argument if the pictures differ in size.
double meanColorDifference(const Image& a, const Image& b);

/// The expected picture in pale grey with every difference in red over it, darker where it is larger.
/// Throws std::invalid_argument if the pictures differ in size.
Image differenceImage(const Image& actual, const Image& expected);

}  // namespace render

#pragma once

#include "render/image.h"

namespace render {

/// How alike two pictures look: 1 = the same. Local means, variances and covariance of the luminance under a Gaussian
/// window (sigma 1.5 pixels, 11 x 11). Source: Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment".
struct Similarity {
    double mean = 0.0;    ///< over all windows
    double lowest = 0.0;  ///< lowest value of the worst window: catches a small thing that is missing
    int x = 0, y = 0;     ///< middle of the worst window [pixels]
};

/// Throws std::invalid_argument if the pictures differ in size. At the border the window is cut and reweighted.
Similarity structuralSimilarity(const Image& a, const Image& b);

/// A larger difference of a channel than this is one that counts, in steps of 255.
inline constexpr int kVisibleStep = 4;

/// How far the colours of two pictures are apart: sees changes of hue that leave the luminance alone.
struct ColorDifference {
    double share = 0.0;  ///< share of the pixels that differ by more than kVisibleStep in some channel, 0 … 1
    int largest = 0;     ///< largest difference of all channels, in steps of 255
    int x = 0, y = 0;    ///< the first pixel with the largest difference
};

/// Throws std::invalid_argument if the pictures differ in size.
ColorDifference colorDifference(const Image& a, const Image& b);

struct ImageDifference {
    Similarity similarity = {1.0, 1.0, 0, 0};
    ColorDifference color;
};

/// Throws std::invalid_argument if the pictures differ in size.
ImageDifference compareImages(const Image& a, const Image& b);

/// How far apart pictures may be that count as the same. Mesa's llvmpipe with vectors of 128 to 512 bits, with or without AVX,
/// leaves the goldens alike but for steps of 1 of 255; the rest is room for single samples at the edges of things. Another
/// rasteriser puts its samples elsewhere and goes below (softpipe: mean 0.951).
struct ImageTolerance {
    double meanSsim = 0.995;  ///< mean similarity, at least
    double lowestSsim = 0.9;  ///< lowest similarity, at least
    double pixels = 0.01;     ///< share of pixels that differ by more than kVisibleStep, at most
    int largest = 255;        ///< largest difference of a channel, at most; 0: the same to the last bit
};

bool isWithin(const ImageDifference& difference, const ImageTolerance& tolerance);

/// The expected picture in pale grey with every difference in red over it, darker where it is larger.
/// Throws std::invalid_argument if the pictures differ in size.
Image differenceImage(const Image& actual, const Image& expected);

}  // namespace render

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"

namespace inr {

/// Of a display of 3840 pixels that is as wide as it is far away: 3840 pi / 180.
constexpr double UsualPixelsPerDegree = 67.020643276582255;

/// How different two pictures look to someone who flips between them, from 0 (equal) to 1: the mean
/// over the pixels of LDR-FLIP (Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom and
/// Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on
/// Computer Graphics and Interactive Techniques 3(2), HPG 2020).
///
/// Values are those that a display gets (sRGB, which is what the window shows of ours), clamped to
/// [0, 1]; RGBA is premultiplied and laid over black. `pixelsPerDegree` of the viewer's visual
/// angle: 1 to 10,000. `map`, when given, receives each pixel's, in one channel. NaN where a
/// picture holds one. Throws Error(InvalidArgument) for pictures of different shapes, without
/// pixels, or of neither 3 nor 4 channels, and for other pixels per degree.
double ImageFlip(const Image& reference, const Image& test,
                 double pixelsPerDegree = UsualPixelsPerDegree, Image* map = nullptr);

} // namespace inr

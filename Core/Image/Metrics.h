// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"

namespace inr {

/// PSNR in dB of linear premultiplied RGBA, peak 1, over the pixels where either alpha is above 0;
/// infinity for equal images, NaN where such a pixel holds one. Throws Error(InvalidArgument)
/// unless both are RGBA of one size.
double ImagePsnr(const Image& a, const Image& b);

/// Mean structural similarity over channels and pixels (Wang et al., IEEE TIP 2004): uniform 7x7
/// window fully inside, K1 0.01, K2 0.03, data range 1, sample covariance. Throws
/// Error(InvalidArgument) when sizes or channels differ or a side is under 7.
double ImageSsim(const Image& a, const Image& b);

/// The largest difference of two values, over all pixels and channels; NaN where a picture holds
/// one. Throws Error(InvalidArgument) when sizes or channels differ.
double ImageMaximumError(const Image& a, const Image& b);

} // namespace inr

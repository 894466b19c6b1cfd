// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Training/Volume.h"

#include <cstdint>
#include <functional>

namespace inr {

/// Voxels around a macro-cell whose values its range holds too: as far as samples of cache level 1
/// reach, which most pictures of a volume take many of. More would make ranges looser for all.
constexpr std::int64_t MacroCellApron = 3;

/// What one pass over all decoded voxels gives.
struct DecodedReport
{
  Quality quality;
  MacroCells macroCells; ///< of the decoded values, with an apron of MacroCellApron voxels
};

/// Decodes every voxel of `volume` and compares: PSNR with the range as peak; SSIM in 3D (uniform
/// 7^3 window fully inside, K1 0.01, K2 0.03, sample covariance: scikit-image's
/// `structural_similarity(win_size=7, data_range=1)`); the largest difference. Windows and voxels
/// that hold a NaN or infinity are left out; where none is left, the figure is NaN. `info` gives
/// the value range, low < high; `keepGoing` receives the fraction done and returns false to stop
/// (Error(Cancelled)). It is asked after so many voxels as `bandSize` says, in whole rows; the last
/// bit of a position may depend on it.
DecodedReport MeasureQuality(const Evaluator& evaluator, const VolumeData& volume,
                             const VolumeInfo& info, int macroCellSize, const Arena& arena,
                             const std::function<bool(double)>& keepGoing,
                             std::int64_t bandSize = 1 << 20);

} // namespace inr

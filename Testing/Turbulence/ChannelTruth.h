// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Parallel.h"
#include "Testing/Turbulence/TurbulentChannel.h"

#include <cstdint>

namespace inr {

/// How far a model is from the field at random voxels.
struct ChannelError
{
  std::int64_t voxels = 0;
  double psnr = 0;     ///< dB, peak = high - low of the model; infinity when every voxel is exact
  double maxError = 0; ///< in data units
  double rootMeanSquare = 0;
  double low = 0; ///< smallest and largest value of the field that was met
  double high = 0;
};

/// Compares `model` with `field` at `voxels` random voxels of the model's grid: an equal number in
/// equal parts of z, uniform within. The field is rounded to the type the model was made of. The
/// result does not depend on the number of threads. Throws Error.
ChannelError MeasureChannelError(ModelPointer model, const TurbulentChannel& field,
                                 std::int64_t voxels, std::uint64_t seed, const Arena& arena);

} // namespace inr

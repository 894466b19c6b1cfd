// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Inference/DeviceModel.h"

#include <cstdint>
#include <limits>
#include <memory>

namespace inr {
namespace cuda {

/// A model in a GPU's memory with what one of its kernels is launched with again and again: the one
/// at points, or the one at bricks.
class PlannedModel
{
public:
  const ModelPointer& source() const { return this->Uploaded->source(); }
  std::int64_t bytes() const; ///< of scratch, beside the model

protected:
  static constexpr std::int64_t NoLimit = std::numeric_limits<std::int64_t>::max();

  /// `bytes`: that its scratch may take; it takes what one block needs where that is more.
  PlannedModel(std::shared_ptr<const DeviceModel> model, bool bricks, std::int64_t bytes);

  std::shared_ptr<const DeviceModel> Uploaded;
  LaunchPlan Plan;
  Array<float> Scratch;
};

} // namespace cuda
} // namespace inr

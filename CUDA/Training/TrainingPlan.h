// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Descent/TrainingAccelerator.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// How a training is laid out in a device's memory. All but `holdsVolume` depends on the task
/// alone, since sums do on it.
struct TrainingPlan
{
  /// Of whose memory `freeBytes` are to be had. Throws Error(Device), with figures, where that is
  /// too little without the volume.
  TrainingPlan(const TrainingTask& task, std::int64_t freeBytes);

  std::int64_t pieceSize; ///< samples that go through the network together
  std::int64_t shardSize; ///< samples whose weight gradients are added up first
  std::int64_t shards;    ///< of a piece
  std::int64_t bytes;     ///< of the device
  bool holdsVolume;
};

/// Floats that a layer's rows take for each sample of a piece: results, gradients and, where the
/// slope needs it, what went into the activation.
std::int64_t LayerFloats(const Description& description, const Layout& layout);

/// Floats of the largest of the first layers, so many, while TrainUpdateLayers updates them.
std::int64_t LargestUpdate(const Layout& layout, int layers);

} // namespace cuda
} // namespace inr

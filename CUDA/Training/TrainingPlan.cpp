// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Training/TrainingPlan.h"

#include "CUDA/Inference/Kernels/Activate.h"
#include "CUDA/Training/Kernels/TrainLayers.h"
#include "Core/Error.h"
#include "Core/Mebibytes.h"
#include "Core/Training/Descent/AdamSchedule.h"
#include "Core/Training/Descent/Optimiser.h"
#include "Core/Training/Descent/TrainKernel.h"

#include <algorithm>
#include <string>

namespace inr {
namespace cuda {

namespace {

/// Of what layers make of a piece: more would not stay in any cache.
constexpr std::int64_t MostLayerFloats = std::int64_t{1} << 26;

/// Samples of a shard at least; the more shards, the more warps share the weights' gradients.
constexpr std::int64_t LeastShard = 128;
constexpr std::int64_t MostShardFloats = std::int64_t{1} << 24;

std::int64_t BytesOf(const NormalisedVolume& volume)
{
  return volume.data.voxels() * static_cast<std::int64_t>(ScalarSize(volume.data.type));
}

} // namespace

std::int64_t LayerFloats(const Description& description, const Layout& layout)
{
  const std::int64_t hidden = SlopeFromResult(description.network.activation) ? 2 : 3;
  std::int64_t floats = 0;
  for (const LayerShape& layer : layout.layers) {
    const bool last = &layer == &layout.layers.back();
    floats += last ? 3 : hidden * layer.rows;
  }
  return floats;
}

std::int64_t LargestUpdate(const Layout& layout, int layers)
{
  std::int64_t floats = 0;
  for (int l = 0; l < layers; ++l) {
    const LayerShape& layer = layout.layers[static_cast<std::size_t>(l)];
    floats = std::max(floats, TallLayer(layer.rows, layer.columns).workspace());
  }
  return floats;
}

TrainingPlan::TrainingPlan(const TrainingTask& task, std::int64_t freeBytes)
{
  const Layout layout(task.description);
  const auto parameters = static_cast<std::int64_t>(layout.parameterCount);
  const auto weights = static_cast<std::int64_t>(layout.gridOffset);
  const std::int64_t grid = parameters - weights;
  const std::int64_t perSample = LayerFloats(task.description, layout);
  this->pieceSize = LeastShard;
  while (this->pieceSize < task.samples && 2 * this->pieceSize * perSample <= MostLayerFloats) {
    this->pieceSize *= 2;
  }
  this->pieceSize = std::min(this->pieceSize, task.samples);
  const auto shardsOf = [this](std::int64_t size) { return (this->pieceSize + size - 1) / size; };
  this->shardSize = LeastShard;
  while (shardsOf(this->shardSize) > 1 && shardsOf(this->shardSize) * weights > MostShardFloats) {
    this->shardSize *= 2;
  }
  this->shards = shardsOf(this->shardSize);
  const std::int64_t ofParameters = 12 * parameters + 10 * grid + grid / GradientLine;
  const std::int64_t ofBatch = task.samples * (16 + 8 * std::int64_t{layout.encodedWidth} + 12);
  const std::int64_t ofLosses = 8 * TilesOf(task.samples);
  const std::int64_t ofSums = 4 * (this->shards * weights + this->pieceSize * perSample);
  const int orthogonalised = OrthogonalisedLayers(task.description.network);
  const std::int64_t ofUpdates = 4 * orthogonalised * LargestUpdate(layout, orthogonalised);
  const std::int64_t ofTables = static_cast<std::int64_t>(sizeof(AdamStep)) * (LastAdamUpdate + 1);
  this->bytes = ofParameters + ofBatch + ofLosses + ofSums + ofUpdates + ofTables;
  if (this->bytes > freeBytes) {
    throw Error(ErrorCode::Device, "training this model takes " + InMebibytes(this->bytes) +
                                       " of the GPU's memory, and " +
                                       InMebibytes(std::max<std::int64_t>(freeBytes, 0)) +
                                       " are to be had");
  }
  this->holdsVolume = task.volume && this->bytes + BytesOf(*task.volume) <= freeBytes;
  this->bytes += this->holdsVolume ? BytesOf(*task.volume) : 0;
}

} // namespace cuda
} // namespace inr

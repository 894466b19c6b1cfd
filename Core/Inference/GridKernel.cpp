// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Lanes.h.
#include "Core/Inference/GridKernel.h"

#include "Core/Inference/EncodeGrid.h"
#include "Core/Inference/Network.h"

namespace inr {
namespace INR_ISA {

namespace {

std::int64_t Workspace(const ModelView& model)
{
  return static_cast<std::int64_t>(sizeof(LevelRow)) * model.levelCount +
         static_cast<std::int64_t>(sizeof(float)) * 2 * RowCapacity * model.widest;
}

template <int Features>
void EncodeLevels(const ModelView& model, float y, float z, LevelRow* rows, int count,
                  float* encoded)
{
  for (int l = 0; l < model.levelCount; ++l) {
    const LevelView& level = model.levels[l];
    EncodeRow<Features>(
        level, model.grid + level.offset, LocateOnAxis(level, model.interpolation, Spread(y)),
        LocateOnAxis(level, model.interpolation, Spread(z)), rows[l], count,
        encoded + static_cast<std::int64_t>(l) * Features * RowCapacity, RowCapacity);
  }
}

void EncodeRowOf(const ModelView& model, float y, float z, LevelRow* rows, int count,
                 float* encoded)
{
  switch (model.features) {
  case 1:
    EncodeLevels<1>(model, y, z, rows, count, encoded);
    break;
  case 2:
    EncodeLevels<2>(model, y, z, rows, count, encoded);
    break;
  case 4:
    EncodeLevels<4>(model, y, z, rows, count, encoded);
    break;
  default:
    EncodeLevels<8>(model, y, z, rows, count, encoded);
    break;
  }
}

/// Samples [first, first + count) of every row.
void EvaluateColumns(const ModelView& model, const LatticeAxis (&axes)[3], std::int64_t first,
                     int count, float* values, LevelRow* rows, float* layers)
{
  float* const encoded = layers;
  float* const other = layers + static_cast<std::int64_t>(RowCapacity) * model.widest;
  const std::int64_t samples = (count + LaneCount - 1) / LaneCount * LaneCount;
  for (std::int64_t k = 0; k < axes[2].count; ++k) {
    for (int l = 0; l < model.levelCount; ++l) {
      LocateRow(model.levels[l], model.interpolation, axes[0].u + first, count, rows[l]);
    }
    for (std::int64_t j = 0; j < axes[1].count; ++j) {
      EncodeRowOf(model, axes[1].u[j], axes[2].u[k], rows, count, encoded);
      for (int row = model.encodedWidth; row < model.inputWidth; ++row) {
        std::memset(encoded + row * RowCapacity, 0, RowCapacity * sizeof(float));
      }
      const float* const out = RunNetwork(model, encoded, other, RowCapacity, samples);
      std::memcpy(values + (k * axes[1].count + j) * axes[0].count + first, out,
                  static_cast<std::size_t>(count) * sizeof(float));
    }
  }
}

void EvaluateGrid(const ModelView& model, const LatticeAxis (&axes)[3], float* values,
                  void* workspace)
{
  auto* const rows = static_cast<LevelRow*>(workspace);
  auto* const layers = reinterpret_cast<float*>(rows + model.levelCount);
  std::memset(layers, 0, sizeof(float) * 2 * RowCapacity * static_cast<std::size_t>(model.widest));
  const std::int64_t width = axes[0].count;
  const std::int64_t pieces = (width + RowCapacity - 1) / RowCapacity;
  for (std::int64_t piece = 0; piece < pieces; ++piece) {
    const std::int64_t first = width * piece / pieces;
    const std::int64_t end = width * (piece + 1) / pieces;
    EvaluateColumns(model, axes, first, static_cast<int>(end - first), values, rows, layers);
  }
}

} // namespace

const GridKernel Grid = {Workspace, EvaluateGrid};

} // namespace INR_ISA
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
//
// A whole batch on one level of the grid, to the features and back; see Inference/Lanes.h for what
// may be in here. One level at a time, because its table then stays in the cache that is nearest of
// those it fits into.
#pragma once

#include "Core/Inference/Encode.h"
#include "Core/Inference/Prefetch.h"
#include "Core/Training/Descent/TrainKernel.h"

namespace inr {
namespace INR_ISA {

inline void PrefetchCorners(const float* table, int features, const Corners& corners)
{
  for (const auto& entries : corners.entry) {
    for (const std::uint32_t entry : entries) {
      __builtin_prefetch(table + entry * static_cast<std::uint64_t>(features), 0, 2);
    }
  }
}

/// Calls body(first, corners) for LaneCount samples after the other, while the next ones' entries
/// of `table` are on their way where it is large. Samples behind `count` repeat an earlier one.
template <class Body>
inline void ForEachGroup(const ModelView& model, int level, const float* table, const float* xyz,
                         std::int64_t count, const Body& body)
{
  const LevelView& grid = model.levels[level];
  const bool far = IsFarAway(grid, model.features);
  Corners corners[2];
  FindCorners(grid, model.interpolation, LoadPositions(xyz, count), corners[0]);
  int turn = 0;
  for (std::int64_t first = 0; first < count; first += LaneCount, turn = 1 - turn) {
    const std::int64_t next = first + LaneCount;
    if (next < count) {
      const Position position = LoadPositions(xyz + 3 * next, count - next);
      FindCorners(grid, model.interpolation, position, corners[1 - turn]);
      if (far) {
        PrefetchCorners(table, model.features, corners[1 - turn]);
      }
    }
    body(first, corners[turn]);
  }
}

/// Row 0 of a level's features for sample `first`, in the layout of TrainKernel.
inline std::int64_t EncodedOffset(const ModelView& model, int level, std::int64_t first)
{
  const std::int64_t block = first / TrainBlockSize;
  return (block * model.encodedWidth + level * model.features) * TrainRowSize +
         first % TrainBlockSize;
}

template <int Features>
inline void EncodeLevel(const ModelView& model, int level, const float* xyz, std::int64_t count,
                        float* encoded)
{
  const float* const table = model.grid + model.levels[level].offset;
  ForEachGroup(model, level, table, xyz, count, [&](std::int64_t first, const Corners& corners) {
    InterpolateLevel<Features>(table, corners, encoded + EncodedOffset(model, level, first),
                               TrainRowSize);
  });
}

/// Adds the gradients of some samples to their corners' entries. `Marks`: says where.
template <int Features, bool Marks>
inline void ScatterLanes(const Corners& corners, const float* gradient, int lanes,
                         const LevelGradient& table)
{
  float* const values = table.values; // what is written might be the struct, for all GCC knows
  std::uint8_t* const touched = table.touched;
  for (int k = 0; k < lanes; ++k) {
    Row<Features> own;
    for (int f = 0; f < Features; ++f) {
      own[f] = gradient[f * TrainRowSize + k];
    }
    for (int c = 0; c < 8; ++c) {
      const std::uint64_t at = static_cast<std::uint64_t>(corners.entry[c][k]) * Features;
      Row<Features> row;
      std::memcpy(&row, values + at, sizeof(row));
      row += corners.weight[c][k] * own;
      std::memcpy(values + at, &row, sizeof(row));
      if constexpr (Marks) {
        touched[at / GradientLine] = 1;
      }
    }
  }
}

template <int Features, bool Marks>
inline void ScatterGroups(const ModelView& model, int level, const float* xyz, std::int64_t count,
                          const float* encodedGradient, const LevelGradient& table)
{
  ForEachGroup(model, level, table.values, xyz, count,
               [&](std::int64_t first, const Corners& corners) {
                 const std::int64_t left = count - first;
                 const int lanes = left < LaneCount ? static_cast<int>(left) : LaneCount;
                 ScatterLanes<Features, Marks>(
                     corners, encodedGradient + EncodedOffset(model, level, first), lanes, table);
               });
}

template <int Features>
inline void ScatterLevel(const ModelView& model, int level, const float* xyz, std::int64_t count,
                         const float* encodedGradient, const LevelGradient& table)
{
  const std::int64_t size = static_cast<std::int64_t>(model.levels[level].entries) * Features;
  const std::int64_t lines = (size + GradientLine - 1) / GradientLine;
  if (lines > 2 * count) {
    ScatterGroups<Features, true>(model, level, xyz, count, encodedGradient, table);
  } else { // most lines are touched anyway
    std::memset(table.touched, 1, static_cast<std::size_t>(lines));
    ScatterGroups<Features, false>(model, level, xyz, count, encodedGradient, table);
  }
}

} // namespace INR_ISA
} // namespace inr

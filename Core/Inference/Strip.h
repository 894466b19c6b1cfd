// SPDX-License-Identifier: BSD-3-Clause
//
// Samples that go through the network together; see Lanes.h for what may be in here. A strip is as
// wide as a tile of results that stays in registers, and all its layers stay in the first-level
// cache, up to some 256 neurons. Tile registers take two in turn: while one's results are on their
// way through memory, the other's are made (with one alone, bricks of small networks took 1.15
// times as long).
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Inference/ModelView.h"

namespace inr {
namespace INR_ISA {

/// Registers hold a tile of results: rows of a layer by groups of LaneCount samples.
#ifdef INR_TILES
constexpr int StripRows = 32;
constexpr int StripGroups = 4;
#else
constexpr int StripRows = LaneCount == 16 ? PanelRows : 4;
static_assert(PanelRows % StripRows == 0, "a tile lies within a panel");
constexpr int StripGroups = LaneCount == 8 ? 3 : 2; // see RunStrip
#endif
constexpr int StripSize = StripGroups * LaneCount;

template <int Rows, int Groups> inline void SetZero(Floats (&sums)[Rows][Groups])
{
#pragma GCC unroll 8
  for (int r = 0; r < Rows; ++r) {
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      sums[r][g] = Floats{};
    }
  }
}

/// Inputs of a layer: those columns that are not zero for all samples.
struct Strip
{
  float* values;      ///< of the k-th such column: from k * StripSize on
  std::int32_t* from; ///< where its weights begin in a panel, in weights
  int count;
};

/// A strip's memory: `in` is to be filled with encoded samples, out is scratch.
struct StripPair
{
  Strip in;
  Strip out;
};

/// Rows that a strip has room for.
inline std::int64_t StripCapacity(const ModelView& model)
{
  return std::int64_t{(model.widest + StripRows - 1) / StripRows} * StripRows;
}

/// Scratch memory for strips, in floats.
inline std::int64_t StripWorkspace(const ModelView& model)
{
  return 2 * StripCapacity(model) * (StripSize + 1) + CacheLineFloats;
}

inline StripPair MakeStrips(const ModelView& model, float* workspace)
{
  float* const values = AlignToLine(workspace);
  const std::int64_t capacity = StripCapacity(model);
  const std::int64_t size = capacity * StripSize;
  auto* const from = reinterpret_cast<std::int32_t*>(values + 2 * size);
  return {{values, from, 0}, {values + size, from + capacity, 0}};
}

} // namespace INR_ISA
} // namespace inr

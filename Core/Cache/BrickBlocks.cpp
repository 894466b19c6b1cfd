// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickBlocks.h"

#include "Core/Cache/Hierarchy.h"
#include "Core/Cache/RangeOfValues.h"
#include "Core/GridBox.h"

#include <glm/common.hpp>

#include <algorithm>
#include <limits>

namespace inr {

namespace {

/// Normalised values: more than interpolation and the places of samples are rounded by.
constexpr float Margin = 0x1p-12f;

/// Extremes of the voxels of all columns along y and z through a row of blocks.
template <typename Stored> struct RowExtremes
{
  static constexpr int MostVoxels = Hierarchy::LargestBrick;
  Stored low[MostVoxels] = {};
  Stored high[MostVoxels] = {};

  void begin(const Stored* row, int count)
  {
    std::copy_n(row, count, this->low);
    std::copy_n(row, count, this->high);
  }
  void add(const Stored* row, int count)
  {
    for (int x = 0; x < count; ++x) {
      this->low[x] = row[x] < this->low[x] ? row[x] : this->low[x];
      this->high[x] = row[x] > this->high[x] ? row[x] : this->high[x];
    }
  }
};

/// Calls extremes(low, high) for all blocks, x fastest.
template <typename Stored, typename Extremes>
void ForEachBlock(const Stored* voxels, const glm::ivec3& dims, const BlockLattice& lattice,
                  const Extremes& extremes)
{
  RowExtremes<Stored> row;
  glm::ivec3 block(0);
  for (; block.z < lattice.count.z; ++block.z) {
    for (block.y = 0; block.y < lattice.count.y; ++block.y) {
      const glm::ivec3 first = block * lattice.edge;
      const glm::ivec3 last = glm::min(first + lattice.edge, dims - 1);
      row.begin(voxels + std::int64_t{dims.x} * (first.y + dims.y * first.z), dims.x);
      for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
          row.add(voxels + std::int64_t{dims.x} * (y + dims.y * z), dims.x);
        }
      }
      for (int x = 0; x < lattice.count.x; ++x) {
        const BlockLattice::Span voxels = lattice.voxelsOf({x, x}, 0);
        const int end = voxels.last + 1;
        extremes(*std::min_element(row.low + voxels.first, row.low + end),
                 *std::max_element(row.high + voxels.first, row.high + end));
      }
    }
  }
}

/// Of stored values of a type, to codes: value = low + step * code or more, by less than a step.
/// Integers stand for half a quantum less or more, too: where a sample is moved back into the range
/// of its macro-cell, it is by no more than that. What lies outside of `within` counts as its
/// limit.
template <typename Stored> struct Coding
{
  float low;
  float step;

  Coding(const BrickView& brick, const ValueRange& /*within*/, std::int64_t /*voxels*/)
      : low(brick.low - 0.5f * brick.step), step(brick.step * Quanta)
  {}
  std::uint8_t operator()(Stored stored) const
  {
    return static_cast<std::uint8_t>(stored / static_cast<Stored>(Quanta));
  }

private:
  static constexpr int Quanta = (std::numeric_limits<Stored>::max() >> 8) + 1; ///< in a code
};

template <> struct Coding<float>
{
  float low;
  float step;

  Coding(const BrickView& brick, const ValueRange& within, std::int64_t voxels)
      : Coding(within.empty() ? RangeOfValues(static_cast<const float*>(brick.voxels), voxels)
                              : within)
  {}
  explicit Coding(const ValueRange& range)
      : low(range.low), step((range.high - range.low) / 256),
        inverse(this->step > std::numeric_limits<float>::min() ? 1 / this->step : 0.0f)
  {}
  std::uint8_t operator()(float value) const
  {
    return static_cast<std::uint8_t>(std::clamp((value - this->low) * this->inverse, 0.0f, 255.0f));
  }

private:
  float inverse;
};

} // namespace

BrickBlocks::BrickBlocks(CachePrecision precision, const glm::ivec3& brickDims, std::int64_t room)
    : Precision(precision), Dims(brickDims), Lattice(brickDims), All(room * this->Lattice.blocks()),
      Scales(room), Known(room)
{}

std::int64_t BrickBlocks::bytesPerSlot(const glm::ivec3& brickDims)
{
  return BlockLattice(brickDims).blocks() * static_cast<std::int64_t>(sizeof(Codes)) +
         static_cast<std::int64_t>(sizeof(Scale) + sizeof(BlockSet));
}

void BrickBlocks::resize(std::int64_t slots)
{
  this->All.resize(slots * this->Lattice.blocks());
  this->Scales.resize(slots);
  this->Known.resize(slots);
}

void BrickBlocks::copy(std::int32_t from, std::int32_t to)
{
  this->Scales[to] = this->Scales[from];
  this->Known[to] = this->Known[from];
  std::copy_n(this->codes(from), this->Lattice.blocks(), this->codes(to));
}

template <typename Stored>
void BrickBlocks::findCodes(const BrickView& brick, const ValueRange& within, std::int32_t slot)
{
  const auto* voxels = static_cast<const Stored*>(brick.voxels);
  const std::int64_t count = GridCount(glm::i64vec3(this->Dims));
  const Coding<Stored> code(brick, within, count);
  this->Scales[slot] = {code.low, code.step};
  Codes* to = this->codes(slot);
  ForEachBlock(voxels, this->Dims, this->Lattice, [&](Stored low, Stored high) {
    *to++ = {code(low), code(high)};
  });
}

void BrickBlocks::store(std::int32_t slot, const BrickView& brick, const BlockSet& known,
                        const ValueRange& within)
{
  this->Known[slot] = known;
  switch (this->Precision) {
  case CachePrecision::Float32:
    this->findCodes<float>(brick, within, slot);
    break;
  case CachePrecision::Bits16:
    this->findCodes<std::uint16_t>(brick, within, slot);
    break;
  case CachePrecision::Bits8:
    this->findCodes<std::uint8_t>(brick, within, slot);
    break;
  }
}

void BrickBlocks::ranges(std::int32_t slot, ValueRange* ranges) const
{
  const Scale& scale = this->Scales[slot];
  const Codes* codes = this->codes(slot);
  for (std::int64_t k = 0; k < this->Lattice.blocks(); ++k) {
    const auto low = static_cast<float>(codes[k].low);
    const auto high = static_cast<float>(codes[k].high) + 1.0f;
    ranges[k] = {scale.low + scale.step * low - Margin, scale.low + scale.step * high + Margin};
  }
}

} // namespace inr

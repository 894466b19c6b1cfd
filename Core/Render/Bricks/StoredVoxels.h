// SPDX-License-Identifier: BSD-3-Clause
//
// Voxels of bricks as they are stored, and between them. Only for sources that are built once per
// instruction set; see Core/Inference/Lanes.h.
#pragma once

#include "Core/Inference/Lanes.h"

#include <cstring>

namespace inr {
namespace INR_ISA {

namespace {

struct AxisLocation
{
  Ints cell;
  Floats weight;
};

AxisLocation Locate(const float* places, int lastCell)
{
  const Floats place = Load(places);
  Ints cell = __builtin_convertvector(place, Ints); // not negative, so truncation is floor
  const Ints last = lastCell - Ints{};
  cell = cell < last ? cell : last;
  return {cell, place - __builtin_convertvector(cell, Floats)};
}

Floats Mix(Floats a, Floats b, Floats weight) { return MultiplyAdd(b - a, weight, a); }

struct FloatPair
{
  Floats first;
  Floats second;

  Floats mix(Floats weight) const { return Mix(this->first, this->second, weight); }
};

/// Voxels as they are stored: of each lane one and its neighbour along x.
struct FloatVoxels
{
  using Stored = float;
  float first[LaneCount];
  float second[LaneCount];

  void load(int lane, const float* from)
  {
    this->first[lane] = from[0];
    this->second[lane] = from[1];
  }
  FloatPair pair() const { return {Load(this->first), Load(this->second)}; }
};

/// Both voxels come in one load, which is what makes integers faster than floats.
template <typename Word, typename Voxel> struct PackedVoxels
{
  using Stored = Voxel;
  static constexpr int Bits = 8 * sizeof(Voxel);
  std::uint32_t both[LaneCount];

  void load(int lane, const Voxel* from)
  {
    Word word;
    std::memcpy(&word, from, sizeof(word));
    this->both[lane] = word;
  }
  FloatPair pair() const
  {
    Ints words;
    std::memcpy(&words, this->both, sizeof(words));
    const Ints mask = ((1 << Bits) - 1) - Ints{};
    return {__builtin_convertvector(words & mask, Floats),
            __builtin_convertvector((Ints)((UInts)words >> Bits), Floats)};
  }
};

using ShortVoxels = PackedVoxels<std::uint32_t, std::uint16_t>;
using ByteVoxels = PackedVoxels<std::uint16_t, std::uint8_t>;

} // namespace

} // namespace INR_ISA
} // namespace inr

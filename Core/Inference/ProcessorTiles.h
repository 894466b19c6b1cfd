// SPDX-License-Identifier: BSD-3-Clause
//
// The processor's tile registers (Intel's AMX); see Lanes.h for what may be in here, and TileSums.h
// for what is done with them. Tests put an imitation in this header's place.
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Inference/TileShapes.h"

namespace inr {
namespace INR_ISA {

/// What was written to memory before is there. GCC's intrinsics do not say that tiles read memory,
/// and of the shapes they mention the first eight bytes only.
inline void FinishStores() { __asm__ volatile("" ::: "memory"); }

inline void ConfigureTiles(const TileShapes& shapes)
{
  FinishStores();
  _tile_loadconfig(&shapes);
}

inline void ReleaseTiles() { _tile_release(); }

// The number of a tile is a part of the instruction: the intrinsics take nothing but a literal.

/// Tile = 0.
template <int Tile> inline void ZeroTile()
{
  static_assert(0 <= Tile && Tile < 4, "no tile of sums");
  if constexpr (Tile == 0) {
    _tile_zero(0);
  } else if constexpr (Tile == 1) {
    _tile_zero(1);
  } else if constexpr (Tile == 2) {
    _tile_zero(2);
  } else {
    _tile_zero(3);
  }
}

/// Tile = what is at `from`; the next row is `stride` bytes further on.
template <int Tile> inline void LoadTile(const void* from, std::int64_t stride)
{
  static_assert(4 <= Tile && Tile < 8, "no tile of factors");
  FinishStores();
  if constexpr (Tile == 4) {
    _tile_loadd(4, from, stride);
  } else if constexpr (Tile == 5) {
    _tile_loadd(5, from, stride);
  } else if constexpr (Tile == 6) {
    _tile_loadd(6, from, stride);
  } else {
    _tile_loadd(7, from, stride);
  }
}

template <int Tile> inline void StoreTile(void* to, std::int64_t stride)
{
  static_assert(0 <= Tile && Tile < 4, "no tile of sums");
  if constexpr (Tile == 0) {
    _tile_stored(0, to, stride);
  } else if constexpr (Tile == 1) {
    _tile_stored(1, to, stride);
  } else if constexpr (Tile == 2) {
    _tile_stored(2, to, stride);
  } else {
    _tile_stored(3, to, stride);
  }
}

/// Sums += Weights * Inputs, of pairs: see TileSums.h.
template <int Sums, int Weights, int Inputs> inline void MultiplyAddTiles()
{
  static_assert(Weights == 4 + Sums / 2 && Inputs == 6 + Sums % 2, "tiles that do not belong");
  if constexpr (Sums == 0) {
    _tile_dpbf16ps(0, 4, 6);
  } else if constexpr (Sums == 1) {
    _tile_dpbf16ps(1, 4, 7);
  } else if constexpr (Sums == 2) {
    _tile_dpbf16ps(2, 5, 6);
  } else {
    _tile_dpbf16ps(3, 5, 7);
  }
}

} // namespace INR_ISA
} // namespace inr

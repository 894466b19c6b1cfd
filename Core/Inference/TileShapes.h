// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// Rows of a tile register, and columns of 32 bits.
constexpr int TileSize = 16;
/// Inputs of a layer that a tile of weights holds, in pairs of bfloat16.
constexpr int TileColumns = 2 * TileSize;

/// What LDTILECFG reads. This header is included by code built for one instruction set and must
/// define no function.
struct alignas(64) TileShapes
{
  std::uint8_t palette;
  std::uint8_t startRow;
  std::uint8_t reserved[14];
  std::uint16_t bytesPerRow[16];
  std::uint8_t rows[16];
};

/// All eight tiles at their largest.
constexpr TileShapes WholeTiles = {
    1, 0, {}, {64, 64, 64, 64, 64, 64, 64, 64}, {16, 16, 16, 16, 16, 16, 16, 16}};

} // namespace inr

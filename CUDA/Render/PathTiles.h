// SPDX-License-Identifier: BSD-3-Clause
//
// The tiles of a round of paths: their pixels for a machine, and back.
#pragma once

#include "CUDA/Render/DevicePicture.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace inr {
namespace cuda {

/// The pixels of a round's tiles; none where these are all.
inline std::vector<std::uint32_t> PixelsOf(const PathRound& round)
{
  const auto width = static_cast<std::uint32_t>(round.output.rgba.width);
  const Tiling tiling(round.output.rgba.width, round.output.rgba.height);
  std::vector<std::uint32_t> pixels;
  if (round.whole) {
    return pixels;
  }
  for (const std::int64_t number : round.tiles) {
    const Tile tile = tiling.tile(number);
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        pixels.push_back(static_cast<std::uint32_t>(y) * width + static_cast<std::uint32_t>(x));
      }
    }
  }
  return pixels;
}

inline void CopyTile(const Image& from, const Tile& tile, Image& to)
{
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    std::copy_n(from.pixel(tile.x, y), std::int64_t{from.channels} * tile.width,
                to.pixel(tile.x, y));
  }
}

/// The tiles' pixels to the host, and what was counted: all of it with the first tile.
template <class Machine>
std::vector<FrameStatistics> TilesToHost(const PathRound& round,
                                         const DevicePicture<Machine>& picture)
{
  std::vector<FrameStatistics> tiles(round.tiles.size());
  if (!tiles.empty()) {
    tiles.front() = picture.statistics();
  }
  Image rgba(round.output.rgba.width, round.output.rgba.height, 4);
  Image depth(rgba.width, rgba.height, 1);
  picture.copyTo(rgba.pixels.data(), depth.pixels.data(), nullptr);
  const Tiling tiling(rgba.width, rgba.height);
  for (const std::int64_t number : round.tiles) {
    CopyTile(rgba, tiling.tile(number), round.output.rgba);
    if (round.output.depth != nullptr) {
      CopyTile(depth, tiling.tile(number), *round.output.depth);
    }
  }
  return tiles;
}

} // namespace cuda
} // namespace inr

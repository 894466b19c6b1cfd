// SPDX-License-Identifier: BSD-3-Clause
//
// A tile unit that is not there, in the place of Core/Inference/ProcessorTiles.h: what Intel's
// manual says of its instructions, on the host. Wrong use throws TileFault where the processor
// would raise an exception. Like the tile registers, it is each thread's own.
#pragma once

#include "Core/Inference/TileShapes.h"

#include <cstdint>

namespace imitation {

void Configure(const inr::TileShapes& shapes); ///< LDTILECFG
void Release();                                ///< TILERELEASE
void Zero(int tile);                           ///< TILEZERO
void Load(int tile, const void* from, std::int64_t stride);
void Store(int tile, void* to, std::int64_t stride);
void MultiplyAdd(int sums, int left, int right); ///< TDPBF16PS

} // namespace imitation

#ifdef INR_ISA

namespace inr {
namespace INR_ISA {

inline void ConfigureTiles(const TileShapes& shapes) { imitation::Configure(shapes); }
inline void ReleaseTiles() { imitation::Release(); }
template <int Tile> inline void ZeroTile() { imitation::Zero(Tile); }
template <int Tile> inline void LoadTile(const void* from, std::int64_t stride)
{
  imitation::Load(Tile, from, stride);
}
template <int Tile> inline void StoreTile(void* to, std::int64_t stride)
{
  imitation::Store(Tile, to, stride);
}
template <int Sums, int Weights, int Inputs> inline void MultiplyAddTiles()
{
  imitation::MultiplyAdd(Sums, Weights, Inputs);
}

} // namespace INR_ISA
} // namespace inr

#endif

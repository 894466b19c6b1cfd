// SPDX-License-Identifier: BSD-3-Clause
//
// Extents of images as VTK has them: six numbers, the first and the last point along each axis.
#pragma once

#include <array>

/// Whether there are no points in it.
bool IsEmpty(const int* extent);

/// Whether an extent holds another one.
bool Contains(const int* outer, const int* inner);

/// The block number `piece` of `pieces` that VTK cuts an extent into, with so many layers of ghost
/// cells around it, all of it for a single piece; empty for those that are too many.
std::array<int, 6> PieceExtent(const int* whole, int piece, int pieces, int ghostLevels);

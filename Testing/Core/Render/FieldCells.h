// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Testing/Core/Render/VoxelScene.h"

/// With the ranges of a field that is linear between voxels.
inline inr::MacroCells CellsOf(const FieldEvaluator::Function& field, const glm::i64vec3& dims,
                               int edge = 16)
{
  inr::MacroCells cells = inr::MakeMacroCells(dims, edge);
  const int across = edge + 2;
  for (std::int64_t k = 0; k < static_cast<std::int64_t>(cells.ranges.size()); ++k) {
    const glm::i64vec3 cell = inr::GridPlace(k, cells.dims);
    for (int voxel = 0; voxel < across * across * across; ++voxel) {
      const glm::i64vec3 within(voxel % across, voxel / across % across, voxel / (across * across));
      const glm::i64vec3 at = glm::clamp(cell * std::int64_t{edge} + within - std::int64_t{1},
                                         glm::i64vec3(0), dims - std::int64_t{1});
      cells.ranges[static_cast<std::size_t>(k)].extend(
          field(glm::vec3((glm::dvec3(at) + 0.5) / glm::dvec3(dims))));
    }
  }
  cells.apron = 1.0 / glm::dvec3(dims);
  cells.provenance = inr::MacroCellProvenance::Decoded;
  return cells;
}

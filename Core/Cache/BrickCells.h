// SPDX-License-Identifier: BSD-3-Clause
//
// Which macro-cells a brick lies in. By their ranges integers divide its values: what a voxel is
// rounded to does not depend on which others of its brick are known.
#pragma once

#include "Core/Cache/HierarchyView.h"
#include "Core/GridBox.h"
#include "Core/HostDevice.h"
#include "Core/Model/MacroCells.h"

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Ranges of macro-cells as plain data, in the memory of whoever reads them.
struct CellTable
{
  glm::i64vec3 dims{0}; ///< of no cells by default
  glm::dvec3 spacing{0};
  const ValueRange* ranges = nullptr; ///< x fastest

  INR_HOST_DEVICE bool empty() const { return this->ranges == nullptr; }
  INR_HOST_DEVICE const ValueRange& at(const glm::i64vec3& cell) const
  {
    return this->ranges[GridNumber(cell, this->dims)];
  }
};

/// All cells that a brick's voxels reach into. `cells`: not empty.
INR_HOST_DEVICE inline GridBox CellsOfBrick(const CellTable& cells, const HierarchyView& hierarchy,
                                            const BrickId& id)
{
  const glm::i64vec3& size = hierarchy.level(id.level).size;
  const glm::i64vec3 begin = hierarchy.firstVoxel(id);
  const glm::i64vec3 end = glm::min(begin + glm::i64vec3(hierarchy.brickDims()), size);
  const glm::dvec3 perVoxel = 1.0 / (glm::dvec3(size) * cells.spacing);
  const glm::i64vec3 most = cells.dims - std::int64_t{1};
  const glm::i64vec3 first = glm::min(glm::i64vec3(glm::dvec3(begin) * perVoxel), most);
  const glm::i64vec3 last = glm::min(glm::i64vec3(glm::dvec3(end) * perVoxel), most);
  return {first, last - first + std::int64_t{1}};
}

} // namespace inr

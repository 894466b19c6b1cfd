// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/StratifiedPositions.h"

#include "Core/Training/SampleSource.h"

#include <cmath>

namespace inr {

namespace {

/// The longest axis of more than one voxel, or x where there is none.
int LongestAxis(const glm::i64vec3& dims, const glm::dvec3& size)
{
  int longest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] > 1 && (longest < 0 || size[axis] > size[longest])) {
      longest = axis;
    }
  }
  return longest < 0 ? 0 : longest;
}

} // namespace

StratifiedPositions::StratifiedPositions(const glm::i64vec3& dims, std::int64_t count)
    : Dims(dims), Corners(static_cast<std::size_t>(count), glm::vec3(0.0f))
{
  glm::dvec3 size(dims);
  // From the largest halves down: bit k of a box's number says in which half it is. All corners are
  // multiples of powers of two, and exact.
  for (std::int64_t bit = count / 2; bit > 0; bit /= 2) {
    const int axis = LongestAxis(dims, size);
    size[axis] /= 2;
    this->Extent[axis] /= 2;
    for (std::int64_t k = 0; k < count; ++k) {
      this->Corners[static_cast<std::size_t>(k)][axis] +=
          (k & bit) != 0 ? this->Extent[axis] : 0.0f;
    }
  }
}

glm::vec3 StratifiedPositions::at(std::int64_t k, std::uint64_t stream, std::uint64_t drawn) const
{
  const glm::vec3 within = RandomPosition(stream, drawn, this->Dims);
  glm::vec3 position = this->Corners[static_cast<std::size_t>(k)] + within * this->Extent;
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = this->Dims[axis] > 1 ? position[axis] : 0.5f;
  }
  // By turns: a box gets both kinds from batch to batch.
  const bool free = (drawn + drawn / this->Corners.size()) % 2 == 0;
  return free ? position : this->inVoxelCentre(position);
}

glm::vec3 StratifiedPositions::inVoxelCentre(const glm::vec3& position) const
{
  const glm::vec3 size(this->Dims);
  glm::vec3 centre;
  for (int axis = 0; axis < 3; ++axis) {
    const float voxel = std::fmin(std::floor(position[axis] * size[axis]), size[axis] - 1.0f);
    centre[axis] = (voxel + 0.5f) / size[axis];
  }
  return centre;
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/LevelVoxels.h"

#include <algorithm>
#include <cstddef>

namespace inr {

namespace {

/// Means over 2 x 2 x 2 points of each of `size` voxels; along an axis that has one for each, that
/// counts twice.
std::vector<float> MeansOf(const std::vector<float>& points, const glm::i64vec3& size,
                           const glm::i64vec3& perVoxel)
{
  std::vector<float> means;
  means.reserve(static_cast<std::size_t>(GridCount(size)));
  for (std::int64_t k = 0; k < GridCount(size); ++k) {
    const glm::i64vec3 first = perVoxel * GridPlace(k, size);
    float sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::i64vec3 within(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::i64vec3 at = first + glm::min(within, perVoxel - std::int64_t{1});
      sum += points[static_cast<std::size_t>(GridNumber(at, perVoxel * size))];
    }
    means.push_back(sum / 8);
  }
  return means;
}

} // namespace

std::vector<float> LevelVoxels::coordinates(int axis, const GridBox& box) const
{
  std::vector<float> coordinates;
  for (std::int64_t k = 0; k < box.size[axis] * this->Points[axis]; ++k) {
    const double within = (static_cast<double>(k) + 0.5) / static_cast<double>(this->Points[axis]);
    const double u =
        (static_cast<double>(box.first[axis]) + within) / static_cast<double>(this->Size[axis]);
    coordinates.push_back(static_cast<float>(u));
  }
  return coordinates;
}

std::vector<float> LevelVoxels::in(const GridBox& box, const Evaluator& field) const
{
  const std::vector<float> axes[3] = {this->coordinates(0, box), this->coordinates(1, box),
                                      this->coordinates(2, box)};
  std::vector<float> values(axes[0].size() * axes[1].size() * axes[2].size());
  field.evaluateGrid(axes, values.data());
  std::transform(values.begin(), values.end(), values.begin(), NormalisedOutput);
  if (this->Points == glm::i64vec3(1)) {
    return values;
  }
  return MeansOf(values, box.size, this->Points);
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/LevelPoints.h"
#include "Core/GridBox.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/Model.h"

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vector_relational.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// The voxels of a level of a volume: values of a field at them or, as PointsPerAxis says, means
/// over 2 x 2 x 2 points of each. Along an axis of a single voxel there is one point, its middle,
/// which takes the place of two.
class LevelVoxels
{
public:
  /// Of a volume of `dims` voxels, each of `points` per axis: 1 or 2.
  LevelVoxels(const glm::i64vec3& dims, int level, int points)
      : Size(VoxelsAtLevel(dims, level)),
        Points(glm::mix(glm::i64vec3(points), glm::i64vec3(1), glm::equal(dims, glm::i64vec3(1))))
  {}
  /// Of a model's, as it is drawn.
  LevelVoxels(const Model& model, int level)
      : LevelVoxels(model.volume.dims, level,
                    PointsPerAxis(model.volume.dims, level, ResolutionOf(model)))
  {}

  std::int64_t pointsPerVoxel() const { return GridCount(this->Points); }
  /// Of those in a box, x fastest, in [0, 1] as NormalisedOutput makes them. Neither the box around
  /// a voxel nor the thread makes a difference to it. Means take eight floats more for each voxel.
  std::vector<float> in(const GridBox& box, const Evaluator& field) const;

private:
  std::vector<float> coordinates(int axis, const GridBox& box) const;

  glm::i64vec3 Size;
  glm::i64vec3 Points; ///< per axis
};

} // namespace inr

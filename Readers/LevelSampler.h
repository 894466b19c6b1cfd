// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Model/Model.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

/// Voxels per axis of a level: each has half as many as the one before, rounded up.
inline glm::i64vec3 LevelDims(glm::i64vec3 dims, int level)
{
  for (; level > 0; --level) {
    dims = (dims + std::int64_t{1}) / std::int64_t{2};
  }
  return dims;
}

/// The samples of a row-major run of voxels: one per voxel on level 0, else two per axis, which
/// `Average` joins.
struct LevelSampler
{
  LevelSampler(const inr::VolumeInfo& volume, int level)
      : Dims(LevelDims(volume.dims, level)), PerAxis(1)
  {
    for (int axis = 0; axis < 3; ++axis) {
      this->PerAxis[axis] = level > 0 && volume.dims[axis] > 1 ? 2 : 1;
    }
  }

  inr::Lattice Row(const glm::i64vec3& first, std::int64_t count) const
  {
    inr::Lattice lattice;
    lattice.step = 1.0 / (glm::dvec3(this->Dims) * glm::dvec3(this->PerAxis));
    lattice.first = (glm::dvec3(first * this->PerAxis) + 0.5) * lattice.step;
    lattice.points = glm::i64vec3(count, 1, 1) * this->PerAxis;
    return lattice;
  }

  float Average(const std::vector<float>& samples, const inr::Lattice& row, std::int64_t x) const
  {
    double sum = 0;
    for (std::int64_t k = 0; k < row.points.z; ++k) {
      for (std::int64_t j = 0; j < row.points.y; ++j) {
        for (std::int64_t i = 0; i < this->PerAxis.x; ++i) {
          const std::int64_t at = x * this->PerAxis.x + i + row.points.x * (j + row.points.y * k);
          sum += inr::NormalisedOutput(samples[static_cast<std::size_t>(at)]);
        }
      }
    }
    return static_cast<float>(
        sum / static_cast<double>(this->PerAxis.x * this->PerAxis.y * this->PerAxis.z));
  }

  glm::i64vec3 Dims;
  glm::i64vec3 PerAxis;
};

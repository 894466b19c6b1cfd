// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/LevelPoints.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/Model.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

/// The voxels of a level, as the renderer has them.
struct LevelSampler
{
  LevelSampler(const inr::Model& model, int level)
      : Dims(inr::VoxelsAtLevel(model.volume.dims, level)), PerAxis(1)
  {
    const int points = inr::PointsPerAxis(model.volume.dims, level, inr::ResolutionOf(model));
    for (int axis = 0; axis < 3; ++axis) {
      this->PerAxis[axis] = model.volume.dims[axis] > 1 ? points : 1;
    }
  }

  /// Normalised values of the voxels [first, first + size), x fastest. A value does not depend on
  /// the box around it.
  std::vector<float> Box(const inr::Evaluator& evaluator, const glm::i64vec3& first,
                         const glm::i64vec3& size) const
  {
    std::vector<float> axes[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double samples = static_cast<double>(this->Dims[axis] * this->PerAxis[axis]);
      for (std::int64_t k = 0; k < size[axis] * this->PerAxis[axis]; ++k) {
        const auto sample = static_cast<double>(first[axis] * this->PerAxis[axis] + k);
        axes[axis].push_back(static_cast<float>((sample + 0.5) / samples));
      }
    }
    std::vector<float> samples(axes[0].size() * axes[1].size() * axes[2].size());
    evaluator.evaluateGrid(axes, samples.data());
    for (float& sample : samples) {
      sample = inr::NormalisedOutput(sample);
    }
    return this->PerAxis == glm::i64vec3(1) ? samples : this->Means(samples, size);
  }

  glm::i64vec3 Dims;
  glm::i64vec3 PerAxis;

private:
  std::vector<float> Means(const std::vector<float>& samples, const glm::i64vec3& size) const
  {
    std::vector<float> means;
    means.reserve(static_cast<std::size_t>(size.x * size.y * size.z));
    for (std::int64_t z = 0; z < size.z; ++z) {
      for (std::int64_t y = 0; y < size.y; ++y) {
        for (std::int64_t x = 0; x < size.x; ++x) {
          means.push_back(this->Mean(samples, size, {x, y, z}));
        }
      }
    }
    return means;
  }

  float Mean(const std::vector<float>& samples, const glm::i64vec3& size,
             const glm::i64vec3& voxel) const
  {
    const glm::i64vec3 points = size * this->PerAxis;
    const glm::i64vec3 begin = voxel * this->PerAxis;
    const glm::i64vec3 end = begin + this->PerAxis;
    double sum = 0;
    for (std::int64_t z = begin.z; z < end.z; ++z) {
      for (std::int64_t y = begin.y; y < end.y; ++y) {
        for (std::int64_t x = begin.x; x < end.x; ++x) {
          sum += samples[static_cast<std::size_t>(x + points.x * (y + points.y * z))];
        }
      }
    }
    return static_cast<float>(
        sum / static_cast<double>(this->PerAxis.x * this->PerAxis.y * this->PerAxis.z));
  }
};

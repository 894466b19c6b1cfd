// SPDX-License-Identifier: BSD-3-Clause
//
// Voxels as a field of their own, for pictures of the data that a model was made of.
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Training/Quality/Quality.h"
#include "Core/Training/Volume/Scalars.h"

#include <glm/common.hpp>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

/// Voxels, x fastest, interpolated linearly between their centres.
class VoxelField : public inr::Evaluator
{
public:
  VoxelField(const glm::i64vec3& dims, std::vector<float> values)
      : Dims(dims), Values(std::move(values))
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    for (std::int64_t k = 0; k < count; ++k) {
      values[k] = static_cast<float>(this->at(glm::dvec3(positions[k])));
    }
  }
  std::string kernel() const override { return "voxels"; }

private:
  double at(const glm::dvec3& u) const
  {
    const glm::dvec3 last(this->Dims - std::int64_t{1});
    const glm::dvec3 c = glm::clamp(u * glm::dvec3(this->Dims) - 0.5, glm::dvec3(0), last);
    const glm::i64vec3 low(glm::floor(c));
    const glm::i64vec3 high = glm::min(low + std::int64_t{1}, this->Dims - std::int64_t{1});
    const glm::dvec3 part = c - glm::dvec3(low);
    const auto row = [&](std::int64_t y, std::int64_t z) {
      const std::int64_t start = this->Dims.x * (y + this->Dims.y * z);
      return glm::mix(this->value(start + low.x), this->value(start + high.x), part.x);
    };
    const auto plane = [&](std::int64_t z) {
      return glm::mix(row(low.y, z), row(high.y, z), part.y);
    };
    return glm::mix(plane(low.z), plane(high.z), part.z);
  }
  double value(std::int64_t k) const { return this->Values[static_cast<std::size_t>(k)]; }

  glm::i64vec3 Dims;
  std::vector<float> Values;
};

/// The voxels that a model is of, in its normalised values.
inline std::vector<float> Normalised(const inr::VolumeData& voxels, const inr::VolumeInfo& info)
{
  return inr::VisitScalars(voxels, [&](const auto* values) {
    std::vector<float> normalised;
    normalised.reserve(static_cast<std::size_t>(voxels.voxels()));
    for (std::int64_t k = 0; k < voxels.voxels(); ++k) {
      const auto value = static_cast<double>(values[k * voxels.stride]);
      normalised.push_back(static_cast<float>((value - info.low) / (info.high - info.low)));
    }
    return normalised;
  });
}

/// What the model says of its own voxels.
inline std::vector<float>
Decoded(const inr::ModelPointer& model, const inr::Arena& arena,
        inr::InferencePrecision precision = inr::InferencePrecision::Float32)
{
  const glm::i64vec3& dims = model->volume.dims;
  std::vector<float> values(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  inr::EvaluateLattice(*inr::MakeEvaluator(model, "", precision), arena,
                       inr::VoxelLattice(dims, glm::i64vec3(0), dims), values.data());
  for (float& value : values) {
    value = inr::NormalisedOutput(value);
  }
  return values;
}

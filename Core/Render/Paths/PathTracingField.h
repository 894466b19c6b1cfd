// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Render/Paths/FieldPoint.h"

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace inr {

/// Where paths get the field's values from. One for each thread and tile.
class FieldSampler
{
public:
  /// Not a number: instead of a value that nobody knows but that is invisible.
  static constexpr float Hidden = std::numeric_limits<float>::quiet_NaN();

  virtual ~FieldSampler() = default;

  /// Normalised values at `count` points inside the volume, or Hidden. A value must not depend on
  /// its neighbours in the batch.
  virtual void sample(const FieldPoint* points, std::int64_t count, float* values) = 0;
};

/// The continuous field itself, whatever level is asked for.
class EvaluatorSampler : public FieldSampler
{
public:
  /// `evaluator` must outlive the sampler.
  EvaluatorSampler(const Evaluator& evaluator, const glm::i64vec3& dims)
      : Field(evaluator), Dims(dims)
  {}

  void sample(const FieldPoint* points, std::int64_t count, float* values) override;

private:
  const Evaluator& Field;
  glm::dvec3 Dims;
  std::vector<glm::vec3> Positions;
};

} // namespace inr

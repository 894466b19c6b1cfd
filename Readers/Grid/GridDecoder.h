// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Model/Model.h"
#include "Core/Parallel.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <atomic>
#include <cstdint>
#include <memory>

/// Evaluates an INR at the points of a presented grid (see PresentedGrid.h). Any number of threads
/// may use one at once.
class GridDecoder
{
public:
  /// Throws inr::Error(InvalidModel) when the parameters do not fit the description.
  GridDecoder(inr::ModelPointer model, const glm::ivec3& presentedDims);

  const inr::ModelPointer& GetModel() const { return this->Model; }
  const glm::ivec3& GetPresentedDimensions() const { return this->Dims; }
  std::int64_t GetNumberOfEvaluations() const { return this->Evaluations; }

  /// Normalised values, in [0, 1], at the points [first, first + size), x fastest.
  void Decode(const glm::i64vec3& first, const glm::i64vec3& size, float* values) const;

private:
  inr::ModelPointer Model;
  glm::ivec3 Dims;
  glm::dvec3 FirstPoint; ///< of the grid, in the unit cube
  glm::dvec3 Step;
  std::shared_ptr<const inr::Evaluator> Evaluator;
  inr::Arena Arena;
  mutable std::atomic<std::int64_t> Evaluations{0};
};

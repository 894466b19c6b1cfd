// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Grid/GridDecoder.h"

#include "Core/GridBox.h"

#include <algorithm>

GridDecoder::GridDecoder(inr::ModelPointer model, const glm::ivec3& presentedDims)
    : Model(std::move(model)), Dims(presentedDims), Evaluator(inr::MakeEvaluator(this->Model))
{
  const glm::dvec3 native(this->Model->volume.dims);
  this->FirstPoint = 0.5 / native;
  for (int axis = 0; axis < 3; ++axis) {
    this->Step[axis] = presentedDims[axis] > 1
                           ? (native[axis] - 1) / ((presentedDims[axis] - 1) * native[axis])
                           : 0.0;
  }
}

void GridDecoder::Decode(const glm::i64vec3& first, const glm::i64vec3& size, float* values) const
{
  inr::Lattice lattice;
  lattice.first = this->FirstPoint + glm::dvec3(first) * this->Step;
  lattice.step = this->Step;
  lattice.points = size;
  inr::EvaluateLattice(*this->Evaluator, this->Arena, lattice, values);
  std::transform(values, values + inr::GridCount(size), values, inr::NormalisedOutput);
  this->Evaluations += inr::GridCount(size);
}

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/PathTracingField.h"

namespace inr {

void EvaluatorSampler::sample(const FieldPoint* points, std::int64_t count, float* values)
{
  this->Positions.resize(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) {
    const glm::dvec3 index = glm::dvec3(points[k].voxel) + glm::dvec3(points[k].fraction);
    this->Positions[static_cast<std::size_t>(k)] = glm::vec3((index + 0.5) / this->Dims);
  }
  this->Field.evaluate(this->Positions.data(), count, values);
}

} // namespace inr

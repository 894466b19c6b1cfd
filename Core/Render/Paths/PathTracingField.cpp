// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/PathTracingField.h"

namespace inr {

void EvaluatorSampler::sample(const FieldPoint* points, std::int64_t count, float* values)
{
  this->Positions.resize(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) {
    this->Positions[static_cast<std::size_t>(k)] = NetworkPosition(points[k], this->Dims);
  }
  this->Field.evaluate(this->Positions.data(), count, values);
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/BatchSource.h"

namespace inr {

const char* TrainingPipelineName(TrainingPipeline pipeline)
{
  switch (pipeline) {
  case TrainingPipeline::DeviceMemory:
    return "device memory";
  case TrainingPipeline::HostMemory:
    return "host memory";
  default:
    return "storage";
  }
}

void StratifiedBatches::draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin,
                             std::int64_t end, glm::vec3* positions, float* targets) const
{
  for (std::int64_t k = begin; k < end; ++k) {
    const std::uint64_t drawn = step * BatchSize + static_cast<std::uint64_t>(k);
    positions[k - begin] = this->Boxes.at(k, stream, drawn);
  }
  this->Source.sample(positions, end - begin, targets);
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/Overflow.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inr {
namespace cuda {

namespace {

bool IsMarked(float value) { return std::isnan(value); }

} // namespace

std::int64_t RepairPoints(const Evaluator& core, const glm::vec3* positions, std::int64_t count,
                          float* values)
{
  std::vector<std::int64_t> marked;
  std::vector<glm::vec3> places;
  for (std::int64_t k = 0; k < count; ++k) {
    if (IsMarked(values[k])) {
      marked.push_back(k);
      places.push_back(positions[k]);
    }
  }
  std::vector<float> repaired(marked.size());
  core.evaluate(places.data(), static_cast<std::int64_t>(places.size()), repaired.data());
  for (std::size_t k = 0; k < marked.size(); ++k) {
    values[marked[k]] = repaired[k];
  }
  return static_cast<std::int64_t>(marked.size());
}

std::int64_t RepairLayers(const BrickSource& core, BrickKey key, std::int64_t z,
                          std::int64_t layers, float* values)
{
  const glm::ivec3& dims = core.hierarchy().brickDims();
  const std::int64_t size = std::int64_t{dims.x} * dims.y;
  std::vector<float> repaired;
  std::int64_t all = 0;
  for (std::int64_t k = 0; k < layers; ++k) {
    float* const layer = values + k * size;
    const std::int64_t marked = std::count_if(layer, layer + size, IsMarked);
    if (marked == 0) {
      continue;
    }
    all += marked;
    repaired.resize(static_cast<std::size_t>(size));
    core.inferLayer(key, z + k, repaired.data());
    std::transform(layer, layer + size, repaired.begin(), layer,
                   [](float value, float again) { return IsMarked(value) ? again : value; });
  }
  return all;
}

} // namespace cuda
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/TranslucentLayers.h"

namespace inr {

bool TranslucentLayers::fits(std::int64_t pixels) const
{
  const auto size = static_cast<std::size_t>(pixels);
  for (std::size_t k = 0; k < this->layers.size(); ++k) {
    const Layer& layer = this->layers[k];
    if (layer.depth.size() != size || layer.colors.size() != size) {
      return false;
    }
    for (std::size_t pixel = 0; k > 0 && pixel < size; ++pixel) {
      if (!(layer.depth[pixel] >= this->layers[k - 1].depth[pixel])) {
        return false;
      }
    }
  }
  return true;
}

} // namespace inr

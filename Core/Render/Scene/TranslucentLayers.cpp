// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/TranslucentLayers.h"

#include "Core/Render/Scene/SameBits.h"

#include <cstddef>
#include <limits>

namespace inr {

bool TranslucentLayers::Layer::operator==(const Layer& other) const
{
  return this->depth.size() == other.depth.size() && this->colors.size() == other.colors.size() &&
         HaveSameBits(this->depth.data(), other.depth.data(), this->depth.size()) &&
         HaveSameBits(this->colors.data(), other.colors.data(), this->colors.size());
}

bool TranslucentLayers::fits(std::int64_t pixels) const
{
  const auto size = static_cast<std::size_t>(pixels);
  for (std::size_t k = 0; k < this->layers.size(); ++k) {
    const Layer& layer = this->layers[k];
    if (layer.depth.size() != size || layer.colors.size() != size) {
      return false;
    }
    for (std::size_t pixel = 0; pixel < size; ++pixel) {
      const float before =
          k > 0 ? this->layers[k - 1].depth[pixel] : -std::numeric_limits<float>::infinity();
      if (!(layer.depth[pixel] >= before)) { // or it is no number
        return false;
      }
    }
  }
  return true;
}

} // namespace inr

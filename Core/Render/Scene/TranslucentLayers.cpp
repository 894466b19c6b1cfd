// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/TranslucentLayers.h"

#include <cstddef>
#include <cstring>
#include <limits>

namespace inr {

namespace {

template <class T> bool HaveSameBits(const std::vector<T>& a, const std::vector<T>& b)
{
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

} // namespace

// By their bits, as what is no number would equal nothing.
bool TranslucentLayers::Layer::operator==(const Layer& other) const
{
  return HaveSameBits(this->depth, other.depth) && HaveSameBits(this->colors, other.colors);
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

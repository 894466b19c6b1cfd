// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace inr {

/// A float image; row 0 is the bottom row, channels interleaved.
struct Image
{
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> pixels;

  Image() = default;
  Image(int w, int h, int c)
      : width(w), height(h), channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(c))
  {}

  float* pixel(int x, int y) { return this->pixels.data() + this->offset(x, y); }
  const float* pixel(int x, int y) const { return this->pixels.data() + this->offset(x, y); }

private:
  std::size_t offset(int x, int y) const
  {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(this->width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(this->channels);
  }
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Random.h"

inline inr::Image RandomImage(int width, int height, int channels, std::uint64_t seed)
{
  inr::Image image(width, height, channels);
  for (std::size_t k = 0; k < image.pixels.size(); ++k) {
    image.pixels[k] = inr::RandomUnit(seed, k);
  }
  return image;
}

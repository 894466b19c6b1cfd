// SPDX-License-Identifier: BSD-3-Clause
//
// What a tolerance is about: by how much the pixels of two pictures differ.
#pragma once

#include "Core/Image/Image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

/// The largest difference of a channel, in 1/255, of each pixel where either of two RGBA pictures
/// of a size shows something; rising. Infinite where a channel is not a number.
inline std::vector<float> PixelDifferences(const inr::Image& a, const inr::Image& b)
{
  std::vector<float> differences;
  for (std::size_t k = 0; k < a.pixels.size(); k += 4) {
    if (!(a.pixels[k + 3] <= 0 && b.pixels[k + 3] <= 0)) {
      float largest = 0;
      for (std::size_t channel = k; channel < k + 4; ++channel) {
        const float difference = std::abs(a.pixels[channel] - b.pixels[channel]);
        largest = std::isnan(difference) ? std::numeric_limits<float>::infinity()
                                         : std::max(largest, difference);
      }
      differences.push_back(255 * largest);
    }
  }
  std::sort(differences.begin(), differences.end());
  return differences;
}

/// How many of such differences are no larger than a tolerance, as a part of all; 0 of none.
inline double ShareWithin(double tolerance, const std::vector<float>& differences)
{
  const auto end =
      std::upper_bound(differences.begin(), differences.end(), static_cast<float>(tolerance));
  return static_cast<double>(end - differences.begin()) /
         std::max(1.0, static_cast<double>(differences.size()));
}

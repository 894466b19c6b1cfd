// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

inline std::vector<float> Evaluate(const inr::Evaluator& evaluator,
                                   const std::vector<glm::vec3>& positions)
{
  std::vector<float> values(positions.size());
  evaluator.evaluate(positions.data(), static_cast<std::int64_t>(positions.size()), values.data());
  return values;
}

/// Lattices of few points along x have the values of a wider one that they are part of.
inline void ExpectThinLatticesAreParts(const inr::Evaluator& evaluator)
{
  constexpr std::size_t width = 11;
  constexpr std::size_t height = 75; // with one point a row, more than a strip
  std::vector<float> axes[3] = {{}, {}, {0.3f}};
  for (std::size_t k = 0; k < height; ++k) {
    axes[1].push_back(static_cast<float>(k) / height);
  }
  for (std::size_t k = 0; k < width; ++k) {
    axes[0].push_back(static_cast<float>(k) / width);
  }
  std::vector<float> whole(width * height);
  evaluator.evaluateGrid(axes, whole.data());
  constexpr std::size_t first = 2;
  for (const std::size_t count : {1, 2, 3, 9}) {
    const std::vector<float> part[3] = {
        {axes[0].begin() + first, axes[0].begin() + first + static_cast<std::ptrdiff_t>(count)},
        axes[1],
        axes[2]};
    std::vector<float> values(count * height);
    evaluator.evaluateGrid(part, values.data());
    for (std::size_t k = 0; k < values.size(); ++k) {
      ASSERT_EQ(values[k], whole[k / count * width + first + k % count])
          << evaluator.kernel() << ", " << count << " along x, value " << k;
    }
  }
}

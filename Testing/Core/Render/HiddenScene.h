// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes in which most of a volume is hidden, and the same with all samples taken.
#pragma once

#include "Testing/Core/Render/ToleranceScene.h"

#include <gtest/gtest.h>

/// No picture shows it, but all samples of it are taken.
constexpr float Invisible = 1e-30f;

/// Opaque for values from 0.6 to 0.75, for the others as `otherwise` says.
inline inr::TransferFunction Shell(float otherwise, float opacity = 0.3f)
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    const bool isShown = x > 0.6f && x < 0.75f;
    function.table.emplace_back(x, 1 - x, 0.5f, isShown ? opacity : otherwise);
  }
  function.below = function.above = function.table.front();
  return function;
}

/// But for what nobody can see.
inline void ExpectSame(const inr::Image& a, const inr::Image& b)
{
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    ASSERT_NEAR(a.pixels[k], b.pixels[k], 100 * Invisible) << k;
  }
}

// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes in which most of a volume is hidden, and the same with all samples taken.
#pragma once

#include "Testing/Core/Render/ToleranceScene.h"

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

// SPDX-License-Identifier: BSD-3-Clause
//
// How the values of a brick, from `low` on, become integers: value = low + step * stored.
#pragma once

#include "Core/HostDevice.h"

namespace inr {

/// Zero for a constant brick, else at least the smallest step whose inverse is finite. `steps`: the
/// greatest integer.
INR_HOST_DEVICE inline float StepOf(float low, float high, float steps)
{
  constexpr float smallest = 0x1p-126f; // of normal numbers
  const float width = high - low;
  const float step = width / steps;
  return width > 0 ? (step < smallest ? smallest : step) : 0.0f;
}

INR_HOST_DEVICE inline float InverseOf(float step) { return step > 0 ? 1.0f / step : 0.0f; }

/// `Stored`: unsigned. What lies below or above all that integers stand for becomes the first or
/// the last one.
template <class Stored>
INR_HOST_DEVICE inline Stored Quantised(float value, float low, float inverse)
{
  constexpr auto most = static_cast<float>(static_cast<Stored>(~Stored{0}));
  const float scaled = (value - low) * inverse + 0.5f;
  // By way of int, which vectors convert to.
  const float limited = scaled < most ? scaled : most;
  return static_cast<Stored>(static_cast<int>(limited > 0.0f ? limited : 0.0f));
}

} // namespace inr

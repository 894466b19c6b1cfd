// SPDX-License-Identifier: BSD-3-Clause
//
// Activations and their derivatives on a run of floats; see Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Model/Description.h"

#include <cmath>

namespace inr {
namespace INR_ISA {

inline float ActivateOne(Activation activation, float x)
{
  switch (activation) {
  case Activation::Exponential:
    return __builtin_expf(x);
  case Activation::Sigmoid: { // without overflow
    const float e = __builtin_expf(-__builtin_fabsf(x));
    return (x < 0.0f ? e : 1.0f) / (1.0f + e);
  }
  case Activation::Sine:
    return __builtin_sinf(x);
  case Activation::Squareplus: {
    const float y = 10.0f * x; // here, not above: what overflows is to be what was asked for
    return 0.05f * (y + __builtin_sqrtf(y * y + 4.0f));
  }
  case Activation::Softplus: { // ln(1 + e^y) without overflow
    const float y = 10.0f * x;
    return 0.1f * ((y > 0.0f ? y : 0.0f) + __builtin_log1pf(__builtin_expf(-__builtin_fabsf(y))));
  }
  case Activation::Tanh:
    return __builtin_tanhf(x);
  default:
    return x;
  }
}

/// values <- activation(values), `count` a multiple of LaneCount.
inline void Activate(Activation activation, float* values, std::int64_t count)
{
  switch (activation) {
  case Activation::None:
    return;
  case Activation::ReLU:
    for (std::int64_t k = 0; k < count; k += LaneCount) {
      Store(values + k, Maximum(Floats{}, Load(values + k))); // a NaN stays one
    }
    return;
  case Activation::LeakyReLU:
    for (std::int64_t k = 0; k < count; k += LaneCount) {
      const Floats value = Load(values + k);
      Store(values + k, value > Floats{} ? value : value * Spread(0.01f));
    }
    return;
  default:
    for (std::int64_t k = 0; k < count; ++k) {
      values[k] = ActivateOne(activation, values[k]);
    }
  }
}

/// values <- activation(sums). Any but the first two goes through memory as a whole: were sums live
/// across its calls, they would be in memory all the time, also while they are summed up.
template <int Rows, int Groups>
inline void ActivateTile(Activation activation, const Floats (&sums)[Rows][Groups],
                         Floats (&values)[Rows][Groups])
{
  constexpr int size = Rows * Groups;
  if (activation == Activation::ReLU || activation == Activation::None) {
    const Floats lowest = Spread(activation == Activation::ReLU ? 0.0f : -__builtin_inff());
#pragma GCC unroll 16
    for (int k = 0; k < size; ++k) { // a NaN stays one
      values[k / Groups][k % Groups] = Maximum(lowest, sums[k / Groups][k % Groups]);
    }
    return;
  }
  float activated[size * LaneCount];
#pragma GCC unroll 16
  for (int k = 0; k < size; ++k) {
    Store(activated + k * LaneCount, sums[k / Groups][k % Groups]);
  }
  Activate(activation, activated, size * LaneCount);
#pragma GCC unroll 16
  for (int k = 0; k < size; ++k) {
    values[k / Groups][k % Groups] = Load(activated + k * LaneCount);
  }
}

/// Derivative at x, where the activation gave h.
inline float ActivationSlope(Activation activation, float x, float h)
{
  switch (activation) {
  case Activation::ReLU:
    return x > 0.0f ? 1.0f : 0.0f;
  case Activation::LeakyReLU:
    return x > 0.0f ? 1.0f : 0.01f;
  case Activation::Exponential:
    return h;
  case Activation::Sigmoid:
    return h * (1.0f - h);
  case Activation::Sine:
    return __builtin_cosf(x);
  case Activation::Squareplus: {
    const float y = 10.0f * x;
    return 0.5f * (1.0f + y / __builtin_sqrtf(y * y + 4.0f));
  }
  case Activation::Softplus:
    return 1.0f / (1.0f + __builtin_expf(-10.0f * x));
  case Activation::Tanh:
    return 1.0f - h * h;
  default:
    return 1.0f;
  }
}

} // namespace INR_ISA
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Model/Description.h"

#include <cmath>

namespace inr {
namespace cuda {

/// The activations that cost more than an instruction. Not inlined on the device: 64 copies of nine
/// functions would be most of a kernel.
#ifdef __CUDACC__
__noinline__
#endif
    INR_HOST_DEVICE inline float
    ActivateSlowly(Activation activation, float x)
{
  const float y = 10.0f * x;
  switch (activation) {
  case Activation::Exponential:
    return expf(x);
  case Activation::Sigmoid: { // without overflow
    const float e = expf(-fabsf(x));
    return (x < 0.0f ? e : 1.0f) / (1.0f + e);
  }
  case Activation::Sine:
    return sinf(x);
  case Activation::Squareplus:
    return 0.05f * (y + sqrtf(y * y + 4.0f));
  case Activation::Softplus: // ln(1 + e^y) without overflow
    return 0.1f * ((y < 0.0f ? 0.0f : y) + log1pf(expf(-fabsf(y))));
  case Activation::Tanh:
    return tanhf(x);
  default:
    return x;
  }
}

/// A NaN stays one.
INR_HOST_DEVICE inline float Activate(Activation activation, float x)
{
  switch (activation) {
  case Activation::None:
    return x;
  case Activation::ReLU:
    return x < 0.0f ? 0.0f : x;
  case Activation::LeakyReLU:
    return x < 0.0f ? 0.01f * x : x;
  default:
    return ActivateSlowly(activation, x);
  }
}

} // namespace cuda
} // namespace inr

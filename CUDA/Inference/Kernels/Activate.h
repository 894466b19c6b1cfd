// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Model/Description.h"

#include <cmath>

namespace inr {
namespace cuda {

/// NaN where a number is infinite: so that an overflow cannot hide behind an activation.
INR_HOST_DEVICE inline float Sticky(float value) { return fmaf(value, 0.0f, value); }

/// The activations that cost more than an instruction. 64 copies of nine functions would be most of
/// a kernel.
INR_HOST_DEVICE INR_CALLED inline float ActivateSlowly(Activation activation, float x)
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

/// Activations as functions, of which loops are made that do not choose again for each number. A
/// NaN stays one.
struct Unchanged
{
  INR_HOST_DEVICE float operator()(float x) const { return x; }
};
struct Rectified
{
  INR_HOST_DEVICE float operator()(float x) const { return x < 0.0f ? 0.0f : x; }
};
struct LeakilyRectified
{
  INR_HOST_DEVICE float operator()(float x) const { return x < 0.0f ? 0.01f * x : x; }
};
struct SlowlyActivated
{
  Activation activation;

  INR_HOST_DEVICE float operator()(float x) const { return ActivateSlowly(this->activation, x); }
};

/// Calls function(activate) with one of these.
template <class Function>
INR_HOST_DEVICE inline void WithActivation(Activation activation, const Function& function)
{
  switch (activation) {
  case Activation::None:
    return function(Unchanged());
  case Activation::ReLU:
    return function(Rectified());
  case Activation::LeakyReLU:
    return function(LeakilyRectified());
  default:
    return function(SlowlyActivated{activation});
  }
}

INR_HOST_DEVICE inline float Activate(Activation activation, float x)
{
  float result = 0.0f;
  WithActivation(activation, [&](const auto& activate) { result = activate(x); });
  return result;
}

/// Whether the slope can be told from the result, so that nobody has to keep what it came from.
INR_HOST_DEVICE inline bool SlopeFromResult(Activation activation)
{
  return activation != Activation::Sine && activation != Activation::Squareplus &&
         activation != Activation::Softplus;
}

INR_HOST_DEVICE INR_CALLED inline float SlopeSlowly(Activation activation, float x, float h)
{
  const float y = 10.0f * x;
  switch (activation) {
  case Activation::Exponential:
    return h;
  case Activation::Sigmoid:
    return h * (1.0f - h);
  case Activation::Sine:
    return cosf(x);
  case Activation::Squareplus:
    return 0.5f * (1.0f + y / sqrtf(y * y + 4.0f));
  case Activation::Softplus:
    return 1.0f / (1.0f + expf(-y));
  case Activation::Tanh:
    return 1.0f - h * h;
  default:
    return 1.0f;
  }
}

/// Derivative at x, where the activation gave h; see SlopeFromResult for where x is of no matter.
INR_HOST_DEVICE inline float ActivationSlope(Activation activation, float x, float h)
{
  switch (activation) {
  case Activation::None:
    return 1.0f;
  case Activation::ReLU:
    return h > 0.0f ? 1.0f : 0.0f;
  case Activation::LeakyReLU:
    return h > 0.0f ? 1.0f : 0.01f;
  default:
    return SlopeSlowly(activation, x, h);
  }
}

} // namespace cuda
} // namespace inr

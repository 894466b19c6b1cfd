// SPDX-License-Identifier: BSD-3-Clause
//
// Adding up samples front to back. Only for sources that are built once per instruction set; see
// Core/Inference/Lanes.h.
#pragma once

#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/RgbaVectors.h"

namespace inr {
namespace INR_ISA {

namespace {

/// A sample, which adds weight * color of the light that would come through, and lets through all
/// but `opacity` of what comes from behind.
struct ShownSample
{
  Rgba color;
  float weight;
  float opacity;
};

/// With sums of type Vector, four of Number.
template <typename Number, typename Vector, typename Sample>
int AddUpAs(int count, float opaque, const Sample& sampleAt, float* before, RayColor& color)
{
  const auto number = [](double value) { return static_cast<Number>(value); };
  Vector sum = {number(color.rgb[0]), number(color.rgb[1]), number(color.rgb[2]), 0};
  Number transmittance = number(color.transmittance);
  int used = 0;
  while (used < count && transmittance > opaque) {
    const ShownSample sample = sampleAt(used);
    before[used] = static_cast<float>(1 - transmittance);
    sum += __builtin_convertvector(sample.color, Vector) * (transmittance * sample.weight);
    transmittance *= 1 - static_cast<Number>(sample.opacity); // one step after another: shorter
    ++used;
  }
  color.rgb[0] = sum[0];
  color.rgb[1] = sum[1];
  color.rgb[2] = sum[2];
  color.transmittance = transmittance;
  return used;
}

/// The samples that `sampleAt` returns for 0 to count - 1, until transmittance falls to `opaque`;
/// how many these are. `before`: the opacity accumulated before each; out.
template <typename Sample>
int AddUp(int count, float opaque, const Sample& sampleAt, float* before, RayColor& color)
{
  return color.ofMany ? AddUpAs<double, ExactRgba>(count, opaque, sampleAt, before, color)
                      : AddUpAs<float, Rgba>(count, opaque, sampleAt, before, color);
}

} // namespace

} // namespace INR_ISA
} // namespace inr

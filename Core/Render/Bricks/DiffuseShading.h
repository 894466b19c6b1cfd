// SPDX-License-Identifier: BSD-3-Clause
//
// What DiffuseLights multiply samples' colours with. Only for sources that are built once per
// instruction set; see Core/Inference/Lanes.h.
#pragma once

#include "Core/Render/Bricks/BrickKernel.h"

namespace inr {
namespace INR_ISA {

namespace {

Floats Absolute(Floats value) { return Maximum(value, -value); }

Floats DotProduct(const Floats (&vector)[3], const float (&with)[3])
{
  const Floats first = vector[0] * Spread(with[0]);
  return MultiplyAdd(vector[2], Spread(with[2]), MultiplyAdd(vector[1], Spread(with[1]), first));
}

/// Divides by the largest component, so that squares neither vanish nor overflow. Without one it
/// makes them NaN.
void Scale(Floats (&vector)[3])
{
  const Floats largest =
      Maximum(Maximum(Absolute(vector[0]), Absolute(vector[1])), Absolute(vector[2]));
  for (Floats& component : vector) {
    component /= largest;
  }
}

void LightAt(const DiffuseLights& lights, const GradientBatch& gradients, int k, LightBatch& light)
{
  Floats gradient[3];
  for (int axis = 0; axis < 3; ++axis) {
    gradient[axis] = Load(gradients.along[axis] + k);
  }
  Scale(gradient);
  Floats across[3];
  for (int axis = 0; axis < 3; ++axis) {
    across[axis] = DotProduct(gradient, lights.gradientToWorld[axis]);
  }
  Scale(across);
  const Floats squared =
      MultiplyAdd(across[2], across[2], MultiplyAdd(across[1], across[1], across[0] * across[0]));
  const Floats toUnit = Spread(1.0f) / SquareRoot(squared);
  Floats sum[3] = {};
  for (int number = 0; number < lights.count; ++number) {
    const DiffuseLight& from = lights.lights[number];
    const Floats facing = Absolute(DotProduct(across, from.toLight));
    for (int channel = 0; channel < 3; ++channel) {
      sum[channel] = MultiplyAdd(facing, Spread(from.rgb[channel]), sum[channel]);
    }
  }
  const Floats ambient = Spread(lights.ambient);
  for (int channel = 0; channel < 3; ++channel) {
    const Floats lit = MultiplyAdd(sum[channel], toUnit, ambient);
    Store(light.rgb[channel] + k, squared > 0.0f ? lit : ambient); // NaN is not above 0
  }
}

void Light(const DiffuseLights& lights, const GradientBatch& gradients, int count,
           LightBatch& light)
{
  for (int k = 0; k < count; k += LaneCount) {
    LightAt(lights, gradients, k, light);
  }
}

} // namespace

} // namespace INR_ISA
} // namespace inr

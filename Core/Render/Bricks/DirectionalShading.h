// SPDX-License-Identifier: BSD-3-Clause
//
// What DirectionalLights make of samples' colours. Only for sources that are built once per
// instruction set; see Core/Inference/Lanes.h.
#pragma once

#include "Core/Inference/Lanes.h"
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

/// NaN where the gradients have no direction.
void FindNormals(const DirectionalLights& lights, const GradientBatch& gradients, int k,
                 Floats (&normal)[3])
{
  Floats gradient[3];
  for (int axis = 0; axis < 3; ++axis) {
    gradient[axis] = Load(gradients.along[axis] + k);
  }
  Scale(gradient);
  for (int axis = 0; axis < 3; ++axis) {
    normal[axis] = DotProduct(gradient, lights.gradientToWorld[axis]);
  }
  Scale(normal);
  const Floats squared =
      MultiplyAdd(normal[2], normal[2], MultiplyAdd(normal[1], normal[1], normal[0] * normal[0]));
  const Floats toUnit = Spread(1.0f) / SquareRoot(squared);
  for (Floats& component : normal) {
    component *= toUnit;
  }
}

Floats Power(Floats base, int exponent)
{
  Floats power = Spread(1.0f);
  while (exponent > 0) {
    if ((exponent & 1) != 0) {
      power *= base;
    }
    exponent >>= 1;
    if (exponent > 0) {
      base *= base;
    }
  }
  return power;
}

void LightAt(const DirectionalLights& lights, const float (&toEye)[3],
             const GradientBatch& gradients, int k, LightBatch& light)
{
  Floats normal[3];
  FindNormals(lights, gradients, k, normal);
  const Floats twice = DotProduct(normal, toEye) * 2.0f;
  Floats diffuse[3] = {};
  Floats specular[3] = {};
  for (int number = 0; number < lights.count; ++number) {
    const DirectionalLight& from = lights.lights[number];
    const Floats facing = DotProduct(normal, from.toLight);
    Floats shine{};
    if (lights.specular > 0.0f) {
      const float eyeToLight =
          from.toLight[0] * toEye[0] + from.toLight[1] * toEye[1] + from.toLight[2] * toEye[2];
      const Floats mirrored = MultiplyAdd(twice, facing, Spread(-eyeToLight));
      const Floats shown = Maximum(mirrored, Spread(lights.leastMirrored));
      shine = mirrored > 0.0f ? Power(shown, lights.specularPower) : Floats{};
    }
    for (int channel = 0; channel < 3; ++channel) {
      const Floats color = Spread(from.rgb[channel]);
      diffuse[channel] = MultiplyAdd(Absolute(facing), color, diffuse[channel]);
      specular[channel] = MultiplyAdd(shine, color, specular[channel]);
    }
  }
  const Floats ambient = Spread(lights.ambient);
  const Ints hasNormal = normal[0] == normal[0]; // not NaN
  for (int channel = 0; channel < 3; ++channel) {
    const Floats factor = MultiplyAdd(diffuse[channel], Spread(lights.diffuse), ambient);
    Store(light.factor[channel] + k, hasNormal ? factor : ambient);
    Store(light.added[channel] + k, specular[channel] * lights.specular); // 0 without a normal
  }
}

void Light(const DirectionalLights& lights, const float (&toEye)[3], const GradientBatch& gradients,
           int count, LightBatch& light)
{
  for (int k = 0; k < count; k += LaneCount) {
    LightAt(lights, toEye, gradients, k, light);
  }
}

} // namespace

} // namespace INR_ISA
} // namespace inr

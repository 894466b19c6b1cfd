// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

/// How a volume answers light; see Shading. As vtkVolumeProperty has them.
struct Material
{
  float ambient = 0.1f;
  float diffuse = 0.7f;
  float specular = 0.2f;
  float specularPower = 10.0f;

  bool operator==(const Material& other) const
  {
    return this->ambient == other.ambient && this->diffuse == other.diffuse &&
           this->specular == other.specular && this->specularPower == other.specularPower;
  }
};

} // namespace inr

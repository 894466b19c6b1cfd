// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/SceneLights.h"

#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkRenderer.h>
#include <vtkVolumeProperty.h>

#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace inr {
namespace {

LightKind KindOf(vtkLight* light)
{
  constexpr double everywhere = 90; // degrees from the axis, from which on VTK knows no cone
  if (!light->GetPositional()) {
    return LightKind::Directional;
  }
  return light->GetConeAngle() >= everywhere ? LightKind::Point : LightKind::Spot;
}

Light ToLight(vtkLight* light)
{
  double position[3];
  double focus[3];
  light->GetTransformedPosition(position);
  light->GetTransformedFocalPoint(focus);
  Light result;
  result.kind = KindOf(light);
  result.position = glm::make_vec3(position);
  result.direction = glm::make_vec3(focus) - glm::make_vec3(position);
  result.color = glm::max(
      glm::vec3(glm::make_vec3(light->GetDiffuseColor()) * light->GetIntensity()), glm::vec3(0.0f));
  result.attenuation = glm::make_vec3(light->GetAttenuationValues());
  result.coneAngle = light->GetConeAngle();
  result.exponent = light->GetExponent();
  return result;
}

/// A black light, one that shines nowhere and an empty cone change no picture.
bool GivesLight(const Light& light)
{
  const bool aimed = light.kind == LightKind::Point || glm::length(light.direction) > 0;
  const bool open = light.kind != LightKind::Spot || light.coneAngle > 0;
  return light.color != glm::vec3(0.0f) && aimed && open;
}

} // namespace

std::vector<Light> SceneLights(vtkRenderer* renderer)
{
  std::vector<Light> result;
  vtkCollectionSimpleIterator iterator;
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal(iterator);
  while (vtkLight* light = lights->GetNextLight(iterator)) {
    const Light converted = ToLight(light);
    if (light->GetSwitch() && GivesLight(converted)) {
      result.push_back(converted);
    }
  }
  return result;
}

std::optional<Material> MaterialOf(vtkVolumeProperty* property)
{
  if (!property->GetShade()) {
    return std::nullopt;
  }
  return Material{static_cast<float>(property->GetAmbient()),
                  static_cast<float>(property->GetDiffuse()),
                  static_cast<float>(property->GetSpecular()),
                  static_cast<float>(property->GetSpecularPower())};
}

} // namespace inr

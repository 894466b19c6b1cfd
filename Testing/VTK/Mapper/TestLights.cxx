// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's lights as Core gets them: kinds, places, colours, and which are left out.
#include "Representations/Mapper/Scene/SceneLights.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace {

struct Lights : testing::Test
{
  Lights()
  {
    vtkCamera* camera = this->renderer->GetActiveCamera();
    camera->SetPosition(1, 2, 10);
    camera->SetFocalPoint(1, 2, 4);
    camera->SetViewUp(0, 1, 0);
  }

  std::vector<inr::Light> convert() const { return inr::SceneLights(this->renderer); }
  /// What the only light becomes.
  inr::Light only() const
  {
    const std::vector<inr::Light> lights = this->convert();
    EXPECT_EQ(lights.size(), 1u);
    return lights.empty() ? inr::Light{} : lights.front();
  }
  vtkLight* add()
  {
    vtkNew<vtkLight> light;
    light->SetPosition(3, 0, 0);
    light->SetFocalPoint(1, 0, 4);
    this->renderer->AddLight(light);
    return light;
  }

  vtkNew<vtkRenderer> renderer;
};

void ExpectNear(const glm::dvec3& a, const glm::dvec3& b) { EXPECT_LT(glm::distance(a, b), 1e-6); }

TEST_F(Lights, SceneLightsAreDirectionalUnlessPositional)
{
  vtkLight* light = this->add();
  light->SetDiffuseColor(1, 0.5, 0.25);
  light->SetIntensity(2);
  const inr::Light converted = this->only();
  EXPECT_EQ(converted.kind, inr::LightKind::Directional);
  ExpectNear(converted.direction, {-2, 0, 4});
  ExpectNear(converted.color, {2, 1, 0.5});
}

TEST_F(Lights, PointsAndSpotsKeepPlaceConeAndAttenuation)
{
  vtkLight* light = this->add();
  light->SetPositional(1);
  light->SetAttenuationValues(0.5, 0.25, 0.125);
  light->SetExponent(3);
  light->SetConeAngle(25);
  inr::Light converted = this->only();
  EXPECT_EQ(converted.kind, inr::LightKind::Spot);
  EXPECT_EQ(converted.coneAngle, 25);
  EXPECT_EQ(converted.exponent, 3);
  ExpectNear(converted.position, {3, 0, 0});
  ExpectNear(converted.direction, {-2, 0, 4});
  ExpectNear(converted.attenuation, {0.5, 0.25, 0.125});
  for (const double angle : {90.0, 180.0}) {
    light->SetConeAngle(angle);
    converted = this->only();
    EXPECT_EQ(converted.kind, inr::LightKind::Point);
    ExpectNear(converted.position, {3, 0, 0});
  }
}

TEST_F(Lights, HeadlightsAndCameraLightsFollowTheCamera)
{
  vtkLight* light = this->add();
  light->SetLightTypeToHeadlight();
  this->renderer->UpdateLightsGeometryToFollowCamera();
  ExpectNear(this->only().position, {1, 2, 10});
  ExpectNear(glm::normalize(this->only().direction), {0, 0, -1});

  light->SetLightTypeToCameraLight(); // its camera is at (0, 0, 1) and looks at the origin
  light->SetPosition(1, 0, 1);
  light->SetFocalPoint(0, 0, 0);
  this->renderer->UpdateLightsGeometryToFollowCamera();
  ExpectNear(this->only().position, {7, 2, 10}); // one distance to the right
  ExpectNear(glm::normalize(this->only().direction), glm::normalize(glm::dvec3(-1, 0, -1)));
}

TEST_F(Lights, WhatGivesNoLightIsLeftOut)
{
  this->add()->SwitchOff();
  this->add()->SetIntensity(0);
  this->add()->SetDiffuseColor(0, 0, 0);
  this->add()->SetFocalPoint(3, 0, 0);
  vtkLight* closed = this->add();
  closed->SetPositional(1);
  closed->SetConeAngle(0);
  EXPECT_TRUE(this->convert().empty());
  this->add();
  EXPECT_EQ(this->convert().size(), 1u);
}

} // namespace

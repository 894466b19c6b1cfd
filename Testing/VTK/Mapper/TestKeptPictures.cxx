// SPDX-License-Identifier: BSD-3-Clause
// A picture that is complete is kept until something changes that it depends on.
#include "OneVolume.h"

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkLight.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace {

using test::OneVolume;

using Blend = vtkVolumeMapper::BlendModes;

/// What comes of a change.
enum class Then {
  Kept, ///< the picture that is there
  Made, ///< another one, which may look the same
  Different,
  Skipped ///< it cannot be made
};

struct Change
{
  const char* name;
  Then marching;
  Then tracing;
  std::function<void(OneVolume&)> make;
};

void AddBlueLight(vtkRenderer* renderer)
{
  vtkNew<vtkLight> light;
  light->SetLightTypeToSceneLight();
  light->SetColor(0, 0, 1);
  light->SetPosition(1000, 0, 0);
  renderer->AddLight(light);
}

void Crop(OneVolume& one)
{
  const double* bounds = one.mapper->GetBounds();
  double planes[6];
  for (int k = 0; k < 6; ++k) {
    planes[k] = 0.8 * bounds[k] + 0.2 * bounds[k ^ 1];
  }
  one.mapper->SetCroppingRegionPlanes(planes);
  one.mapper->CroppingOn();
}

void Clip(OneVolume& one)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(one.volume->GetCenter());
  plane->SetNormal(1, 2, 0);
  one.mapper->AddClippingPlane(plane);
}

/// One after the other, each on top of those before.
std::vector<Change> Changes()
{
  using One = OneVolume&;
  return {
      {"camera", Then::Different, Then::Different,
       [](One one) { one.renderer->GetActiveCamera()->Azimuth(3); }},
      {"colours", Then::Different, Then::Different,
       [](One one) {
         one.volume->GetProperty()->GetRGBTransferFunction()->AddRGBPoint(0.4, 0.1, 0.9, 0.3);
       }},
      {"opacity", Then::Different, Then::Different,
       [](One one) { one.volume->GetProperty()->GetScalarOpacity()->AddPoint(0.4, 0.35); }},
      {"unit distance", Then::Different, Then::Different,
       [](One one) { one.volume->GetProperty()->SetScalarOpacityUnitDistance(0.7); }},
      {"sample distance", Then::Different, Then::Kept,
       [](One one) { one.mapper->SetSampleDistance(0.8); }},
      {"adaptive sampling", Then::Made, Then::Kept,
       [](One one) { one.mapper->AdaptiveSamplingOff(); }},
      {"pre-integration", Then::Different, Then::Kept,
       [](One one) { one.mapper->PreIntegrationOn(); }},
      {"no pre-integration", Then::Different, Then::Kept,
       [](One one) { one.mapper->PreIntegrationOff(); }},
      {"levels", Then::Different, Then::Different,
       [](One one) { one.mapper->SetLevelOfDetailScale(4); }},
      {"samples per pixel", Then::Kept, Then::Different,
       [](One one) { one.mapper->SetSamplesPerPixel(3); }},
      {"seed", Then::Different, Then::Different, [](One one) { one.mapper->SetSeed(7); }},
      {"albedo", Then::Kept, Then::Different,
       [](One one) { one.mapper->SetScatteringAlbedo(0.5); }},
      {"anisotropy", Then::Kept, Then::Different, [](One one) { one.mapper->SetAnisotropy(0.5); }},
      {"bounces", Then::Kept, Then::Different, [](One one) { one.mapper->SetMaximumBounces(1); }},
      {"ambient light", Then::Kept, Then::Different,
       [](One one) { one.mapper->SetAmbientLight(0.2, 0.5, 0.3); }},
      {"shading", Then::Different, Then::Kept,
       [](One one) { one.volume->GetProperty()->ShadeOn(); }},
      {"material", Then::Different, Then::Kept,
       [](One one) { one.volume->GetProperty()->SetDiffuse(0.3); }},
      {"lights", Then::Different, Then::Different, [](One one) { AddBlueLight(one.renderer); }},
      {"cropping", Then::Different, Then::Different, Crop},
      {"cropped regions", Then::Different, Then::Skipped,
       [](One one) { one.mapper->SetCroppingRegionFlags(0x7ffffff ^ VTK_CROP_SUBVOLUME); }},
      {"no cropping", Then::Different, Then::Different, [](One one) { one.mapper->CroppingOff(); }},
      {"clipping", Then::Different, Then::Different, Clip},
      {"samples counted", Then::Made, Then::Kept, [](One one) { one.mapper->SampleChannelsOn(); }},
      {"cache", Then::Made, Then::Made, [](One one) { one.mapper->SetCachePrecision(0); }},
      {"inference", Then::Made, Then::Made,
       [](One one) { one.mapper->SetInferencePrecision(vtkINRVolumeMapper::BFLOAT16); }},
      {"threads", Then::Made, Then::Made, [](One one) { one.mapper->SetNumberOfThreads(3); }},
      {"still time", Then::Kept, Then::Kept, [](One one) { one.mapper->SetStillTimeLimit(60); }},
      {"surface in it", Then::Different, Then::Different, [](One one) { one.addCube(); }},
      {"place", Then::Different, Then::Different,
       [](One one) { one.volume->AddPosition(1, 2, 3); }},
      {"window", Then::Different, Then::Different,
       [](One one) { one.scene.window->SetSize(100, 80); }},
      {"no shading", Then::Different, Then::Kept,
       [](One one) { one.volume->GetProperty()->ShadeOff(); }},
      {"tolerance", Then::Different, Then::Different, // the full resolution, of paths
       [](One one) { one.mapper->SetErrorTolerance(100); }},
      {"other tolerance", Then::Made, Then::Made,
       [](One one) { one.mapper->SetErrorTolerance(0.5); }},
      {"no tolerance", Then::Different, Then::Different,
       [](One one) { one.mapper->SetErrorTolerance(-1); }},
      {"projection", Then::Different, Then::Skipped,
       [](One one) { one.mapper->SetBlendMode(Blend::AVERAGE_INTENSITY_BLEND); }},
      {"averaged values", Then::Different, Then::Skipped,
       [](One one) { one.mapper->SetAverageIPScalarRange(20, 60); }},
      {"projection's light", Then::Kept, Then::Skipped,
       [](One one) { one.volume->GetProperty()->ShadeOn(); }},
      {"projection's sampling", Then::Kept, Then::Skipped,
       [](One one) { one.mapper->AdaptiveSamplingOn(); }},
      {"maximum", Then::Different, Then::Skipped,
       [](One one) { one.mapper->SetBlendMode(Blend::MAXIMUM_INTENSITY_BLEND); }},
      {"maximum's unit distance", Then::Kept, Then::Skipped,
       [](One one) { one.volume->GetProperty()->SetScalarOpacityUnitDistance(0.3); }},
      {"isosurface", Then::Different, Then::Skipped,
       [](One one) {
         one.volume->GetProperty()->GetIsoSurfaceValues()->SetValue(0, 60);
         one.mapper->SetBlendMode(Blend::ISOSURFACE_BLEND);
       }},
      {"other isosurface", Then::Different, Then::Skipped,
       [](One one) { one.volume->GetProperty()->GetIsoSurfaceValues()->SetValue(0, 90); }},
      {"isosurface's unit distance", Then::Kept, Then::Skipped,
       [](One one) { one.volume->GetProperty()->SetScalarOpacityUnitDistance(0.6); }},
      {"isosurface's sampling", Then::Kept, Then::Skipped,
       [](One one) { one.mapper->AdaptiveSamplingOff(); }},
      {"no cache", Then::Made, Then::Skipped,
       [](One one) { one.mapper->SetCacheMode(vtkINRVolumeMapper::NETWORK_ONLY); }},
      {"levels without a cache", Then::Kept, Then::Skipped,
       [](One one) { one.mapper->SetLevelOfDetailScale(0.3); }},
      {"bricks without a cache", Then::Kept, Then::Skipped,
       [](One one) { one.mapper->SetBrickSize(16); }},
  };
}

TEST(Frames, AreNotMadeAgainWhileNothingChanges)
{
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    OneVolume one;
    one.scene.window->SetSize(96, 72);
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(2);
    one.mapper->SetBrickSize(8); // so that there are levels
    inr::Image shown = one.scene.capture();
    EXPECT_TRUE(one.mapper->GetConverged());
    EXPECT_GT(one.mapper->GetNumberOfVisitedCells(), 0);
    for (const Change& change : Changes()) {
      const Then then = mode == vtkINRVolumeMapper::RAY_MARCHING ? change.marching : change.tracing;
      if (then == Then::Skipped) {
        continue;
      }
      SCOPED_TRACE(change.name + std::string(mode == 0 ? ", marching" : ", tracing"));
      const vtkIdType samples = one.mapper->GetNumberOfSamples();
      EXPECT_EQ(one.scene.capture().pixels, shown.pixels);
      EXPECT_EQ(one.mapper->GetNumberOfVisitedCells(), 0);
      EXPECT_EQ(one.mapper->GetNumberOfNetworkSamples(), 0);
      EXPECT_EQ(one.mapper->GetNumberOfDecodedBricks(), 0);
      EXPECT_EQ(one.mapper->GetNumberOfSamples(), samples); // the picture's, as before
      EXPECT_TRUE(one.mapper->GetConverged());
      change.make(one);
      const inr::Image next = one.scene.capture();
      EXPECT_EQ(one.mapper->GetNumberOfVisitedCells() > 0, then != Then::Kept);
      EXPECT_TRUE(then != Then::Different || next.pixels != shown.pixels);
      EXPECT_TRUE(then != Then::Kept || next.pixels == shown.pixels);
      shown = next;
    }
  }
}

TEST(Frames, AreTheStillOnesWhileNothingMoves)
{
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    OneVolume one;
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(2);
    const inr::Image shown = one.scene.capture();
    EXPECT_TRUE(one.mapper->GetConverged());
    one.scene.window->SetDesiredUpdateRate(1e6); // as while somebody drags what is no volume
    for (int picture = 0; picture < 2; ++picture) {
      EXPECT_EQ(one.scene.capture().pixels, shown.pixels);
      EXPECT_EQ(one.mapper->GetNumberOfVisitedCells(), 0);
      EXPECT_EQ(one.mapper->GetImageReduction(), 1);
      EXPECT_TRUE(one.mapper->GetConverged());
    }
    one.addCube();
    EXPECT_NE(one.scene.capture().pixels, shown.pixels);
    EXPECT_GT(one.mapper->GetNumberOfVisitedCells(), 0);
  }
}

TEST(Frames, GoOnAfterOthersThatPass)
{
  OneVolume one;
  vtkCamera* camera = one.renderer->GetActiveCamera();
  const double angle = camera->GetViewAngle();
  one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  one.mapper->SetSamplesPerPixel(1000);
  one.mapper->SetStillTimeLimit(1e-3);
  one.mapper->ShownElsewhereOn();
  vtkIdType paths = 0;
  for (int turn = 0; turn < 3; ++turn) {
    const vtkIdType before = paths;
    for (int pictures = 0; paths < before + 2; ++pictures) {
      ASSERT_LT(pictures, 500);
      one.scene.capture();
      EXPECT_GE(one.mapper->GetNumberOfPaths(), paths);
      paths = one.mapper->GetNumberOfPaths();
    }
    ASSERT_FALSE(one.mapper->GetConverged());
    one.scene.window->SetDesiredUpdateRate(1e6);
    camera->SetViewAngle(0.9 * angle);
    one.scene.capture();
    camera->SetViewAngle(angle);
    one.scene.window->SetDesiredUpdateRate(0.002);
  }
}

} // namespace

// SPDX-License-Identifier: BSD-3-Clause
// Frames for which there is little time, and such as are stopped.
#include "Core/Image/Metrics.h"
#include "OneVolume.h"
#include "Representations/Mapper/Pictures/ImageReduction.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

namespace {

using test::OneVolume;

TEST(Frames, GiveWayToCoarserOnesWhenTheyComeTooLate)
{
  for (const int mode : {0, 1}) { // ray marching, path tracing
    OneVolume one;
    one.mapper->SetRenderMode(mode);
    one.mapper->SetAdaptiveSampling(false);
    one.mapper->SetSampleDistance(0.001);
    one.volume->GetProperty()->SetScalarOpacityUnitDistance(mode == 0 ? 1000 : 0.01);
    one.scene.window->SetDesiredUpdateRate(200);
    const inr::Image first = one.scene.capture();
    EXPECT_GT(one.mapper->GetImageReduction(),
              mode == 0 ? inr::ImageReduction::Unmeasured : inr::ImageReduction::UnmeasuredPaths);
    EXPECT_GT(*std::max_element(first.pixels.begin(), first.pixels.end()), 0.0f) << mode;
  }
}

/// Pixels that show something in the one picture and nothing in the other.
int CountHoles(const inr::Image& whole, const inr::Image& other)
{
  int holes = 0;
  for (std::size_t k = 3; k < whole.pixels.size(); k += 4) {
    holes += whole.pixels[k] > 0.9f && other.pixels[k] == 0 ? 1 : 0;
  }
  return holes;
}

TEST(Frames, ShowAllOfThePictureWhileThereIsNoTimeForAllOfItsPixels)
{
  for (const int mode : {0, 1}) { // ray marching, path tracing
    OneVolume one;
    one.mapper->SetRenderMode(mode);
    one.mapper->SetAmbientLight(1, 1, 1);
    one.mapper->ShownElsewhereOn();
    one.volume->GetProperty()->SetScalarOpacityUnitDistance(mode == 0 ? 1 : 0.01);
    one.scene.window->SetSize(400, 400);
    const inr::Image whole = one.scene.capture();
    EXPECT_GT(CountHoles(whole, inr::Image(400, 400, 4)), 10000);
    one.renderer->GetActiveCamera()->Zoom(1.0001); // as good as the same
    one.mapper->SetStillTimeLimit(1e-3);
    inr::Image before;
    for (int picture = 0; picture < 3; ++picture) {
      one.slowDown();
      const inr::Image first = one.scene.capture();
      ASSERT_FALSE(one.mapper->GetConverged());
      EXPECT_GT(one.mapper->GetImageReduction(), 1) << mode;
      EXPECT_EQ(CountHoles(whole, first), 0) << mode << ", " << picture;
      EXPECT_TRUE(picture == 0 || first.pixels == before.pixels) << "another one, which flickers";
      before = first;
    }
  }
}

TEST(Frames, AreCoarserWhileInteracting)
{
  OneVolume one;
  const inr::Image still = one.scene.capture();
  one.scene.window->SetDesiredUpdateRate(1e6);
  const double angle = one.renderer->GetActiveCamera()->GetViewAngle();
  one.renderer->GetActiveCamera()->SetViewAngle(1.0001 * angle); // as good as the same
  const inr::Image moving = one.scene.capture();
  EXPECT_EQ(one.mapper->GetImageReduction(), inr::ImageReduction::Largest);
  EXPECT_GT(inr::ImageMaximumError(still, moving), 0);
  EXPECT_GT(inr::ImagePsnr(still, moving), 13); // a dozen pixels
  one.scene.window->SetDesiredUpdateRate(0.002);
  one.renderer->GetActiveCamera()->SetViewAngle(angle);
  EXPECT_EQ(inr::ImageMaximumError(still, one.scene.capture()), 0);
  EXPECT_EQ(one.mapper->GetImageReduction(), 1);
}

/// A complete picture without any clock, of a window whose size is divided by `divisor`.
vtkIdType SamplesOf(OneVolume& one, int divisor)
{
  one.mapper->DeterministicOn();
  one.mapper->SetBrickSize(8);
  one.scene.window->SetSize(test::Scene::Width / divisor, test::Scene::Height / divisor);
  for (int frame = 0; frame < 100 && !one.mapper->GetConverged(); ++frame) {
    one.scene.capture();
  }
  EXPECT_TRUE(one.mapper->GetConverged());
  return one.mapper->GetNumberOfSamples();
}

TEST(Frames, HaveTwiceTheSampleDistanceWhileInteracting)
{
  OneVolume moving;
  moving.scene.window->SetDesiredUpdateRate(5);
  moving.mapper->SetSampleDistance(0.4);
  const vtkIdType samples = SamplesOf(moving, 1);
  const int reduction = moving.mapper->GetImageReduction();
  EXPECT_EQ(reduction, inr::ImageReduction::Unmeasured);
  OneVolume still;
  still.mapper->SetSampleDistance(0.8);
  EXPECT_EQ(SamplesOf(still, reduction), samples);
  OneVolume dense;
  dense.mapper->SetSampleDistance(0.4);
  EXPECT_GT(SamplesOf(dense, reduction), samples + samples / 2);
}

TEST(Frames, AreCoarserAtFirstWhileSomebodyDragsWhatTheyFollow)
{
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    OneVolume one;
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(1);
    one.mapper->DeterministicOn();
    one.mapper->ShownElsewhereOn();
    one.mapper->HurriedOn();
    vtkVolumeProperty* property = one.volume->GetProperty();
    const auto drawChanged = [&] {
      property->SetScalarOpacityUnitDistance(0.9 * property->GetScalarOpacityUnitDistance());
      one.scene.capture();
      return one.mapper->GetImageReduction();
    };
    EXPECT_GT(drawChanged(), 1);
    EXPECT_FALSE(one.mapper->GetConverged());
    EXPECT_GE(one.mapper->TakeRefinementPause(), 0.3);
    EXPECT_GT(drawChanged(), 1);
    for (int picture = 0; picture < 100 && !one.mapper->GetConverged(); ++picture) {
      one.scene.capture();
      EXPECT_EQ(one.mapper->GetImageReduction(), 1);
    }
    EXPECT_TRUE(one.mapper->GetConverged());
    one.addCube(); // what is around the volume is not what it follows
    one.scene.capture();
    EXPECT_EQ(one.mapper->GetImageReduction(), 1);
    one.mapper->HurriedOff();
    EXPECT_EQ(drawChanged(), 1);
    one.mapper->HurriedOn();
    one.mapper->ShownElsewhereOff(); // nobody would draw the rest
    EXPECT_EQ(drawChanged(), 1);
    EXPECT_TRUE(one.mapper->GetConverged());
  }
}

/// Where they take longer than was expected, they are still ones, or go on.
TEST(Frames, AreNeverLeftCoarserThanTheyAre)
{
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    OneVolume one;
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(1);
    one.mapper->ShownElsewhereOn();
    one.mapper->HurriedOn();
    vtkVolumeProperty* property = one.volume->GetProperty();
    for (int picture = 0; picture < 6; ++picture) {
      if (picture == 3) {
        one.slowDown();
      }
      property->SetScalarOpacityUnitDistance(0.9 * property->GetScalarOpacityUnitDistance());
      one.scene.capture();
      EXPECT_EQ(one.mapper->GetConverged(), one.mapper->TakeRefinementPause() == 0);
      EXPECT_TRUE(one.mapper->GetImageReduction() == 1 || !one.mapper->GetConverged()) << picture;
    }
  }
}

TEST(Frames, RespectOpaqueDepthWhileInteracting)
{
  OneVolume one;
  one.addCube();
  const inr::Image still = one.scene.capture();
  one.scene.window->SetDesiredUpdateRate(1e6);
  one.renderer->GetActiveCamera()->Zoom(1.0001); // as good as the same
  EXPECT_GT(inr::ImagePsnr(still, one.scene.capture()), 13);
  EXPECT_EQ(one.mapper->GetImageReduction(), inr::ImageReduction::Largest);
}

TEST(Frames, CanBeAborted)
{
  OneVolume one;
  test::Messages messages(one.mapper);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* window, unsigned long, void*, void*) {
    static_cast<vtkRenderWindow*>(window)->SetAbortRender(1);
  });
  const unsigned long tag = one.scene.window->AddObserver(vtkCommand::AbortCheckEvent, abort);
  const inr::Image aborted = one.scene.capture();
  EXPECT_EQ(*std::max_element(aborted.pixels.begin(), aborted.pixels.end()), 0);
  EXPECT_FALSE(one.mapper->GetConverged());
  EXPECT_EQ(one.mapper->GetNumberOfSamples(), 0);
  EXPECT_EQ(messages.errors, 0);

  one.scene.window->RemoveObserver(tag);
  const inr::Image whole = one.scene.capture();
  EXPECT_GT(*std::max_element(whole.pixels.begin(), whole.pixels.end()), 0);
}

TEST(ImageReduction, KeepsStillFramesWhole)
{
  inr::ImageReduction reduction;
  reduction.record(100, 1);
  EXPECT_EQ(reduction.factor(0.002, 1000000), 1);
}

TEST(ImageReduction, IsAsSmallAsTheRateAllows)
{
  inr::ImageReduction reduction;
  EXPECT_EQ(reduction.factor(5, 1000), inr::ImageReduction::Unmeasured);
  reduction.record(1.0, 1000); // 1 ms per pixel, so three quarters of 0.2 s are 150 pixels
  EXPECT_EQ(reduction.factor(5, 150), 1);
  EXPECT_EQ(reduction.factor(5, 151), 2);
  EXPECT_EQ(reduction.factor(5, 601), 4);
  EXPECT_EQ(reduction.factor(5, 9600), 8);
  EXPECT_EQ(reduction.factor(5, 9601), 16);
  EXPECT_EQ(reduction.factor(5, 1000000), inr::ImageReduction::Largest);
}

TEST(ImageReduction, ExpectsFinerPicturesToCostMoreForEachPixel)
{
  inr::ImageReduction reduction;
  reduction.record(0.1, 1000); // four times the pixels: eight times as long
  EXPECT_EQ(reduction.factor(0.75 / 0.81, 4000), 1);
  EXPECT_EQ(reduction.factor(0.75 / 0.79, 4000), 2);
}

TEST(ImageReduction, FallsAtOnceAndRisesByAndBy)
{
  inr::ImageReduction reduction;
  reduction.record(0.1, 1000);
  EXPECT_EQ(reduction.factor(5, 1000), 1);
  reduction.record(1.6, 1000);
  EXPECT_EQ(reduction.factor(5, 1000), 4);
  int frames = 0;
  while (reduction.factor(5, 1000) > 1 && frames < 100) {
    reduction.record(0.1, 1000);
    ++frames;
  }
  EXPECT_GT(frames, 2);
  EXPECT_LT(frames, 10);
}

} // namespace

// SPDX-License-Identifier: BSD-3-Clause
// What happens around a frame: what it reads, what it tells, what it leaves behind.
#include "Core/Image/Exr.h"
#include "Core/Image/Metrics.h"
#include "Core/Inference/InferenceKernels.h"
#include "OneVolume.h"
#include "Testing/Core/RandomModel.h"

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkCullerCollection.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkProperty.h>
#include <vtkTransform.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

namespace {

using test::OneVolume;

/// What is behind the eye may be in front of it as the camera turns it, or on another wall of a
/// cave.
TEST(Frames, ShowWhatTheCameraTurnsToTheFront)
{
  OneVolume front;
  const inr::Image seen = front.scene.capture();
  OneVolume turned;
  vtkCamera* camera = turned.renderer->GetActiveCamera();
  camera->Yaw(180);
  turned.renderer->GetCullers()->RemoveAllItems(); // as processes that draw together do
  camera->SetClippingRange(front.renderer->GetActiveCamera()->GetClippingRange());
  const inr::Image away = turned.scene.capture();
  EXPECT_EQ(*std::max_element(away.pixels.begin(), away.pixels.end()), 0);
  EXPECT_TRUE(turned.mapper->GetConverged());
  const double* eye = camera->GetPosition();
  vtkNew<vtkTransform> about;
  about->Translate(eye);
  about->RotateWXYZ(180, camera->GetViewUp());
  about->Translate(-eye[0], -eye[1], -eye[2]);
  camera->SetModelTransformMatrix(about->GetMatrix());
  EXPECT_GT(inr::ImagePsnr(turned.scene.capture(), seen), 60);
}

TEST(Frames, SayWhatTheyTook)
{
  OneVolume one;
  EXPECT_STREQ(one.mapper->GetBackendInUse(), "");
  one.scene.capture();
  EXPECT_GT(one.mapper->GetFrameTime(), 0);
  EXPECT_GT(one.mapper->GetNumberOfSamples(), 10000);
  EXPECT_EQ(one.mapper->GetImageReduction(), 1);
  EXPECT_EQ(std::string(one.mapper->GetBackendInUse()).substr(0, 4), "CPU ");
}

TEST(Frames, CountWhatFalseRangesTakeAway)
{
  inr::Model model = *test::MakeModel();
  model.macroCells = inr::MakeMacroCells(model.volume.dims, 16);
  std::fill(model.macroCells.ranges.begin(), model.macroCells.ranges.end(),
            inr::ValueRange{0.4f, 0.5f});
  OneVolume falsely(test::InrMapper(test::Write(model, "false-ranges.inr")));
  falsely.scene.capture();
  EXPECT_GT(falsely.mapper->GetNumberOfClampedSamples(),
            0.2 * falsely.mapper->GetNumberOfSamples());

  OneVolume truly;
  truly.scene.capture();
  EXPECT_EQ(truly.mapper->GetNumberOfClampedSamples(), 0);
}

/// Whether the network computes with sums of two bfloat16 numbers, for a model that is wide enough.
bool Splits(const std::function<void(vtkINRVolumeMapper&)>& change)
{
  static const std::string file = [] {
    inr::Description description = SmallDescription();
    description.network.neurons = 64;
    const auto model = CalmModel(description); // 16 bits are off by little
    model->volume.dims = glm::i64vec3(20);
    model->volume.high = 1;
    return test::Write(*model, "wide.inr");
  }();
  OneVolume one(test::InrMapper(file));
  change(*one.mapper);
  one.scene.capture();
  return std::string(one.mapper->GetBackendInUse()).find("split") != std::string::npos;
}

TEST(Frames, RoundNoMoreThanTheCacheUnlessAsked)
{
  const bool tiles = inr::IsTileKernelUsable();
  EXPECT_EQ(Splits([](auto&) {}), tiles);
  EXPECT_EQ(Splits([](auto& mapper) { mapper.SetCachePrecision(mapper.BITS8); }), tiles);
  EXPECT_FALSE(Splits([](auto& mapper) { mapper.SetCachePrecision(mapper.FLOAT32); }));
  EXPECT_FALSE(Splits([](auto& mapper) { mapper.SetCacheMode(mapper.NETWORK_ONLY); }));
  EXPECT_FALSE(Splits([](auto& mapper) { mapper.SetErrorTolerance(0); }));
  EXPECT_FALSE(Splits([](auto& mapper) { mapper.SetErrorTolerance(1); }));
  EXPECT_FALSE(Splits([](auto& mapper) { mapper.SetInferencePrecision(mapper.SINGLE); }));
  EXPECT_FALSE(Splits([](auto& mapper) { mapper.SetInferencePrecision(mapper.BFLOAT16); }));
}

TEST(Frames, ReadDepthOnlyWhenSomethingOpaqueIsVisible)
{
  OneVolume one;
  vtkNew<vtkActor2D> overlay;
  one.renderer->AddActor(overlay);
  one.scene.capture();
  EXPECT_FALSE(one.mapper->GetOpaqueDepthRead());

  const auto cube = one.addCube();
  one.scene.capture();
  EXPECT_TRUE(one.mapper->GetOpaqueDepthRead());

  cube->GetProperty()->SetOpacity(0.5);
  one.scene.capture();
  EXPECT_FALSE(one.mapper->GetOpaqueDepthRead());

  cube->GetProperty()->SetOpacity(1);
  cube->VisibilityOff();
  one.scene.capture();
  EXPECT_FALSE(one.mapper->GetOpaqueDepthRead());
}

TEST(Frames, AreBehindWhatAnEarlierRendererHasLeft)
{
  OneVolume one;
  const auto cube = one.addCube();
  const inr::Image expected = one.scene.capture();
  one.renderer->RemoveActor(cube);
  vtkNew<vtkRenderer> before;
  before->AddActor(cube);
  before->SetActiveCamera(one.renderer->GetActiveCamera());
  const vtkSmartPointer<vtkRenderer> kept = one.renderer;
  one.scene.window->RemoveRenderer(one.renderer);
  one.scene.window->AddRenderer(before);
  one.scene.window->AddRenderer(one.renderer);
  one.renderer->EraseOff();
  EXPECT_GT(inr::ImagePsnr(one.scene.capture(), expected), 40);
  EXPECT_TRUE(one.mapper->GetOpaqueDepthRead());
}

TEST(Frames, SeeMultisampledDepth)
{
  OneVolume plain, smooth;
  plain.addCube();
  smooth.addCube();
  smooth.scene.window->SetMultiSamples(4);
  EXPECT_GT(inr::ImageSsim(plain.scene.capture(), smooth.scene.capture()), 0.97);
}

TEST(Frames, DoNotDependOnThePresentedGrid)
{
  const std::string file = test::ModelFile();
  OneVolume native(test::InrMapper(file, 0));
  OneVolume coarse(test::InrMapper(file, 1000));
  EXPECT_LT(inr::ImageMaximumError(native.scene.capture(), coarse.scene.capture()), 2.5f / 255);
}

/// As where several arrays of one name share their colours.
TEST(Frames, DoNotDependOnColorsThatNoValueHas)
{
  OneVolume one;
  const inr::Image shown = one.scene.capture();
  vtkVolumeProperty* property = one.volume->GetProperty();
  property->GetRGBTransferFunction()->AddRGBPoint(1e9, 1, 1, 1);
  property->GetScalarOpacity()->AddPoint(1e9, 1);
  EXPECT_GT(one.mapper->GetNumberOfVisitedCells(), 0);
  EXPECT_GT(inr::ImagePsnr(one.scene.capture(), shown), 40);
}

TEST(Frames, DoNotDependOnThreads)
{
  OneVolume one;
  one.mapper->SetNumberOfThreads(1);
  const inr::Image first = one.scene.capture();
  one.mapper->SetNumberOfThreads(3);
  EXPECT_EQ(inr::ImageMaximumError(first, one.scene.capture()), 0);
}

TEST(Frames, AreWrittenExactly)
{
  OneVolume one;
  const inr::Image window = one.scene.capture();
  const std::string file = std::string(INR_TEST_OUTPUT) + "/Frames.exr";
  ASSERT_TRUE(one.mapper->WriteEXR(file.c_str()));
  inr::Image depth;
  const inr::Image exact = inr::ReadExr(file, &depth);
  EXPECT_LT(inr::ImageMaximumError(window, exact), 1.0f / 255); // 8 bits against float
  ASSERT_EQ(depth.width, exact.width);
  const float nearest = *std::min_element(depth.pixels.begin(), depth.pixels.end());
  EXPECT_GT(nearest, 0);
  EXPECT_LT(nearest, 1);
}

TEST(Frames, SayWhatLevelsTheyShow)
{
  OneVolume one;
  EXPECT_EQ(one.mapper->GetFinestLevel(), -1);
  EXPECT_EQ(one.mapper->GetFrameMTime(), 0U);
  one.mapper->SetBrickSize(8);
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(2);
    one.mapper->SetLevelOfDetailScale(0);
    one.scene.capture();
    const vtkMTimeType drawn = one.mapper->GetFrameMTime();
    EXPECT_EQ(one.mapper->GetFinestLevel(), 0);
    EXPECT_EQ(one.mapper->GetCoarsestLevel(), 0);
    EXPECT_EQ(one.mapper->GetNumberOfPaths(), mode == vtkINRVolumeMapper::PATH_TRACING ? 2 : 0);
    one.mapper->SetLevelOfDetailScale(12);
    one.scene.capture();
    EXPECT_GT(one.mapper->GetFinestLevel(), 0);
    EXPECT_GE(one.mapper->GetCoarsestLevel(), one.mapper->GetFinestLevel());
    EXPECT_GT(one.mapper->GetFrameMTime(), drawn);
  }
  int size[2];
  one.mapper->GetFrameSize(size);
  EXPECT_EQ(size[0], one.scene.window->GetSize()[0]);
  EXPECT_EQ(size[1], one.scene.window->GetSize()[1]);
  one.mapper->SetRenderMode(vtkINRVolumeMapper::RAY_MARCHING);
  one.mapper->SetCacheMode(vtkINRVolumeMapper::NETWORK_ONLY);
  one.scene.capture();
  EXPECT_EQ(one.mapper->GetFinestLevel(), -1);
  EXPECT_EQ(one.mapper->GetCoarsestLevel(), -1);
}

TEST(Frames, KeepWithinATolerance)
{
  OneVolume one;
  EXPECT_EQ(one.mapper->GetErrorTolerance(), -1);
  one.mapper->SetBrickSize(8);
  one.mapper->SetErrorTolerance(0);
  const inr::Image exact = one.scene.capture();
  const auto samples = one.mapper->GetNumberOfSamples();
  EXPECT_EQ(one.mapper->GetCoarsestLevel(), 0);
  one.mapper->SetErrorTolerance(200);
  const inr::Image rough = one.scene.capture();
  EXPECT_LT(one.mapper->GetNumberOfSamples(), samples);
  EXPECT_LT(255 * inr::ImageMaximumError(exact, rough), 200);
  // The precision of the cache follows from it, too.
  one.mapper->SetCachePrecision(vtkINRVolumeMapper::BITS8);
  EXPECT_EQ(one.scene.capture().pixels, rough.pixels);
  one.mapper->SetErrorTolerance(0);
  EXPECT_EQ(one.scene.capture().pixels, exact.pixels);
  one.mapper->SetErrorTolerance(-7); // as it was
  EXPECT_EQ(one.mapper->GetErrorTolerance(), -1);
}

TEST(Frames, CountSamplesAndLevelsOfEachPixel)
{
  OneVolume one;
  one.mapper->SampleChannelsOn();
  one.mapper->SetBrickSize(8);
  const std::string file = std::string(INR_TEST_OUTPUT) + "/FramesSamples.exr";
  inr::Image samples;
  for (const double scale : {0.0, 1.5}) {
    for (const bool shade : {false, true}) {
      one.mapper->SetLevelOfDetailScale(scale);
      one.volume->GetProperty()->SetShade(shade);
      one.scene.capture();
      ASSERT_TRUE(one.mapper->WriteEXR(file.c_str()));
      const inr::Image rgba = inr::ReadExr(file, nullptr, &samples);
      ASSERT_EQ(samples.channels, 2);
      double sum = 0;
      for (std::size_t k = 0; 2 * k < samples.pixels.size(); ++k) {
        const float count = samples.pixels[2 * k];
        const float level = samples.pixels[2 * k + 1];
        sum += count;
        EXPECT_TRUE(count > 0 || rgba.pixels[4 * k + 3] == 0);
        EXPECT_TRUE(count > 0 ? level >= static_cast<float>(one.mapper->GetFinestLevel()) &&
                                    level <= static_cast<float>(one.mapper->GetCoarsestLevel())
                              : level == -1);
      }
      EXPECT_EQ(sum, static_cast<double>(one.mapper->GetNumberOfSamples()));
    }
  }
  one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  one.mapper->SetSamplesPerPixel(1);
  one.scene.capture();
  ASSERT_TRUE(one.mapper->WriteEXR(file.c_str())); // and warns
  inr::ReadExr(file, nullptr, &samples);
  EXPECT_TRUE(samples.pixels.empty());
}

TEST(Frames, CannotBeWrittenBeforeTheFirstOrToNowhere)
{
  OneVolume one;
  test::Messages messages(one.mapper);
  EXPECT_FALSE(one.mapper->WriteEXR("early.exr"));
  EXPECT_EQ(messages.errors, 1);
  one.scene.capture();
  EXPECT_FALSE(one.mapper->WriteEXR("/nonexistent-folder/late.exr"));
  EXPECT_EQ(messages.errors, 2);
  EXPECT_NE(messages.last.find("/nonexistent-folder/late.exr"), std::string::npos);
}

TEST(Frames, AreNotConvergedBeforeThereIsOne)
{
  OneVolume one;
  EXPECT_FALSE(one.mapper->GetConverged());
  EXPECT_EQ(one.mapper->GetCacheHitRate(), 0);
}

TEST(Frames, MissNothingWhereThereIsNothingToSee)
{
  OneVolume one;
  vtkNew<vtkPlane> beyond;
  beyond->SetOrigin(1e6, 0, 0);
  beyond->SetNormal(1, 0, 0);
  one.mapper->AddClippingPlane(beyond);
  one.scene.capture();
  EXPECT_EQ(one.mapper->GetNumberOfSamples(), 0);
  EXPECT_TRUE(one.mapper->GetConverged());
  EXPECT_EQ(one.mapper->GetCacheHitRate(), 1);
}

TEST(Frames, MoveToAnotherWindow)
{
  const auto mapper = test::InrMapper(test::ModelFile());
  inr::Image first;
  {
    OneVolume one(mapper);
    first = one.scene.capture();
  }
  OneVolume two(mapper);
  EXPECT_EQ(inr::ImageMaximumError(first, two.scene.capture()), 0);
}

TEST(Frames, ShareAWindowWithTwoOfTheSameMapper)
{
  OneVolume one;
  vtkNew<vtkVolume> again;
  again->SetMapper(one.mapper);
  again->SetProperty(one.volume->GetProperty());
  again->SetPosition(30, 0, 0);
  one.renderer->AddVolume(again);
  const inr::Image both = one.scene.capture();
  again->VisibilityOff();
  EXPECT_GT(inr::ImageMaximumError(both, one.scene.capture()), 0.1f);
}

} // namespace

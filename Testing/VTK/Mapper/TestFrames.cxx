// SPDX-License-Identifier: BSD-3-Clause
// What happens around a frame: how it is scheduled, what it reads, what it leaves behind.
#include "Core/Image/Exr.h"
#include "Core/Image/Metrics.h"
#include "ImageReduction.h"
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkCubeSource.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

namespace {

std::string ModelFile() { return test::Write(*test::MakeModel(), "Frames.inr"); }

/// One volume seen in perspective; what most tests here start from.
struct OneVolume
{
  OneVolume() : OneVolume(test::InrMapper(ModelFile())) {}
  explicit OneVolume(vtkSmartPointer<vtkINRVolumeMapper> inr) : mapper(inr)
  {
    this->renderer = this->scene.addRenderer();
    this->volume = this->scene.addVolume(this->renderer, this->mapper);
    test::Scene::look(this->renderer);
  }

  vtkSmartPointer<vtkActor> addCube()
  {
    vtkNew<vtkCubeSource> cube;
    cube->SetCenter(this->volume->GetCenter());
    cube->SetXLength(20);
    cube->SetYLength(20);
    cube->SetZLength(20);
    vtkNew<vtkPolyDataMapper> polygons;
    polygons->SetInputConnection(cube->GetOutputPort());
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(polygons);
    this->renderer->AddActor(actor);
    return actor;
  }

  test::Scene scene;
  vtkSmartPointer<vtkINRVolumeMapper> mapper;
  vtkRenderer* renderer = nullptr;
  vtkVolume* volume = nullptr;
};

float LargestDifference(const inr::Image& a, const inr::Image& b)
{
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  float largest = 0;
  for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
    largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
  }
  return largest;
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

/// Something that makes for another picture.
struct Change
{
  const char* name;
  std::function<void(OneVolume&)> make;
};

TEST(Frames, AreNotMadeAgainWhileNothingChanges)
{
  const Change changes[] = {
      {"camera", [](OneVolume& one) { one.renderer->GetActiveCamera()->Azimuth(3); }},
      {"colours",
       [](OneVolume& one) {
         one.volume->GetProperty()->GetRGBTransferFunction()->AddRGBPoint(0.4, 0.1, 0.9, 0.3);
       }},
      {"opacity",
       [](OneVolume& one) { one.volume->GetProperty()->GetScalarOpacity()->AddPoint(0.4, 0.35); }},
      {"unit distance",
       [](OneVolume& one) { one.volume->GetProperty()->SetScalarOpacityUnitDistance(0.7); }},
      {"sample distance", [](OneVolume& one) { one.mapper->SetSampleDistance(0.8); }},
      {"samples per pixel", [](OneVolume& one) { one.mapper->SetSamplesPerPixel(3); }},
      {"cache", [](OneVolume& one) { one.mapper->SetCachePrecision(0); }},
      {"surface in it", [](OneVolume& one) { one.addCube(); }},
      {"place", [](OneVolume& one) { one.volume->AddPosition(1, 2, 3); }},
      {"window", [](OneVolume& one) { one.scene.window->SetSize(200, 160); }}};
  for (const int mode : {0, 1}) { // ray marching, path tracing
    OneVolume one;
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(2);
    inr::Image shown = one.scene.capture();
    EXPECT_TRUE(one.mapper->GetConverged());
    EXPECT_GT(one.mapper->GetNumberOfVisitedCells(), 0);
    for (const Change& change : changes) {
      SCOPED_TRACE(change.name);
      const vtkIdType samples = one.mapper->GetNumberOfSamples();
      EXPECT_EQ(one.scene.capture().pixels, shown.pixels);
      EXPECT_EQ(one.mapper->GetNumberOfVisitedCells(), 0);
      EXPECT_EQ(one.mapper->GetNumberOfNetworkSamples(), 0);
      EXPECT_EQ(one.mapper->GetNumberOfDecodedBricks(), 0);
      EXPECT_EQ(one.mapper->GetNumberOfSamples(), samples); // the picture's, as before
      EXPECT_TRUE(one.mapper->GetConverged());
      change.make(one);
      const inr::Image next = one.scene.capture();
      const std::string name = change.name;
      const bool matters = mode == 1 || name != "samples per pixel";
      const bool shows = name != "cache" && (mode == 0 || name != "sample distance");
      EXPECT_EQ(one.mapper->GetNumberOfVisitedCells() > 0, matters);
      EXPECT_TRUE(!matters || !shows || next.pixels != shown.pixels);
      shown = next;
    }
  }
}

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
  const std::string file = ModelFile();
  OneVolume native(test::InrMapper(file, 0));
  OneVolume coarse(test::InrMapper(file, 1000));
  EXPECT_LT(LargestDifference(native.scene.capture(), coarse.scene.capture()), 2.5f / 255);
}

TEST(Frames, DoNotDependOnThreads)
{
  OneVolume one;
  one.mapper->SetNumberOfThreads(1);
  const inr::Image first = one.scene.capture();
  one.mapper->SetNumberOfThreads(3);
  EXPECT_EQ(LargestDifference(first, one.scene.capture()), 0);
}

TEST(Frames, AreWrittenExactly)
{
  OneVolume one;
  const inr::Image window = one.scene.capture();
  const std::string file = std::string(INR_TEST_OUTPUT) + "/Frames.exr";
  ASSERT_TRUE(one.mapper->WriteEXR(file.c_str()));
  inr::Image depth;
  const inr::Image exact = inr::ReadExr(file, &depth);
  EXPECT_LT(LargestDifference(window, exact), 1.0f / 255); // 8 bits against float
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
    one.mapper->SetLevelOfDetailScale(6);
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
  EXPECT_GT(one.mapper->GetCoarsestLevel(), 0);
  EXPECT_LT(one.mapper->GetNumberOfSamples(), samples);
  EXPECT_LT(255 * LargestDifference(exact, rough), 200);
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

TEST(Frames, AreCoarserWhileInteracting)
{
  OneVolume one;
  const inr::Image still = one.scene.capture();
  one.scene.window->SetDesiredUpdateRate(1e6);
  const inr::Image moving = one.scene.capture();
  EXPECT_EQ(one.mapper->GetImageReduction(), inr::ImageReduction::Largest);
  EXPECT_GT(LargestDifference(still, moving), 0);
  EXPECT_GT(inr::ImagePsnr(still, moving), 13); // a dozen pixels
  one.scene.window->SetDesiredUpdateRate(0.002);
  EXPECT_EQ(LargestDifference(still, one.scene.capture()), 0);
  EXPECT_EQ(one.mapper->GetImageReduction(), 1);
}

TEST(Frames, RespectOpaqueDepthWhileInteracting)
{
  OneVolume one;
  one.addCube();
  const inr::Image still = one.scene.capture();
  one.scene.window->SetDesiredUpdateRate(1e6);
  EXPECT_GT(inr::ImagePsnr(still, one.scene.capture()), 13);
  EXPECT_EQ(one.mapper->GetImageReduction(), inr::ImageReduction::Largest);
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

TEST(Frames, MoveToAnotherWindow)
{
  const auto mapper = test::InrMapper(ModelFile());
  inr::Image first;
  {
    OneVolume one(mapper);
    first = one.scene.capture();
  }
  OneVolume two(mapper);
  EXPECT_EQ(LargestDifference(first, two.scene.capture()), 0);
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
  EXPECT_GT(LargestDifference(both, one.scene.capture()), 0.1f);
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

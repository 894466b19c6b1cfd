// SPDX-License-Identifier: BSD-3-Clause
// Path tracing in a window: the same medium as ray marching, lit by VTK's lights.
#include "Core/Image/Exr.h"
#include "Core/Image/Metrics.h"
#include "Representations/Mapper/Pictures/ImageReduction.h"
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkCubeSource.h>
#include <vtkLight.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace {

/// One volume, dark until somebody switches on a light.
struct Traced
{
  Traced() : mapper(test::InrMapper(test::Write(*test::MakeModel(), "PathTracing.inr")))
  {
    this->renderer = this->scene.addRenderer();
    this->renderer->AutomaticLightCreationOff();
    this->volume = this->scene.addVolume(this->renderer, this->mapper);
    test::Scene::look(this->renderer);
    this->mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
    this->mapper->SetSamplesPerPixel(4);
    this->mapper->SetAmbientLight(0, 0, 0);
  }

  vtkSmartPointer<vtkLight> addLight()
  {
    auto light = vtkSmartPointer<vtkLight>::New();
    light->SetPosition(1000, 0, 0);
    light->SetFocalPoint(0, 0, 0);
    this->renderer->AddLight(light);
    return light;
  }

  void addCube()
  {
    vtkNew<vtkCubeSource> cube;
    cube->SetCenter(this->volume->GetCenter());
    cube->SetXLength(9);
    cube->SetYLength(25);
    cube->SetZLength(9);
    vtkNew<vtkPolyDataMapper> polygons;
    polygons->SetInputConnection(cube->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(polygons);
    this->renderer->AddActor(actor);
  }

  /// The volume's own picture, in floats.
  inr::Image exact()
  {
    this->scene.window->Render();
    const std::string file = std::string(INR_TEST_OUTPUT) + "/PathTracing.exr";
    EXPECT_TRUE(this->mapper->WriteEXR(file.c_str()));
    return inr::ReadExr(file);
  }

  test::Scene scene;
  vtkSmartPointer<vtkINRVolumeMapper> mapper;
  vtkRenderer* renderer = nullptr;
  vtkVolume* volume = nullptr;
};

double Sum(const inr::Image& image, std::size_t channel)
{
  double sum = 0;
  for (std::size_t k = channel; k < image.pixels.size(); k += 4) {
    sum += image.pixels[k];
  }
  return sum;
}

TEST(PathTracing, WhiteInWhiteLightIsTheMarchersPictureOfWhite)
{
  for (const bool cube : {false, true}) {
    Traced one;
    if (cube) {
      one.addCube();
    }
    vtkNew<vtkColorTransferFunction> white;
    white->AddRGBPoint(0, 1, 1, 1);
    one.volume->GetProperty()->SetColor(white);
    constexpr int paths = 16;
    one.mapper->SetSamplesPerPixel(paths);
    one.mapper->SetMaximumBounces(VTK_INT_MAX);
    one.mapper->SetAmbientLight(1, 1, 1);
    const inr::Image traced = one.exact();
    EXPECT_TRUE(one.mapper->GetConverged());
    EXPECT_EQ(one.mapper->GetOpaqueDepthRead(), cube);
    one.mapper->SetRenderMode(vtkINRVolumeMapper::RAY_MARCHING);
    one.mapper->SetSampleDistance(0.1);
    const inr::Image marched = one.exact();
    double variance = 0;
    for (std::size_t k = 0; k < traced.pixels.size(); k += 4) {
      const double alpha = marched.pixels[k + 3];
      variance += alpha * (1 - alpha) / paths;
      EXPECT_EQ(traced.pixels[k], traced.pixels[k + 3]);
      EXPECT_EQ(traced.pixels[k + 2], traced.pixels[k + 3]);
    }
    // What the marcher's steps and its end at 99.9 % opacity cost adds up over the picture.
    const double difference = Sum(traced, 3) - Sum(marched, 3);
    EXPECT_LT(std::abs(difference), 5 * std::sqrt(variance) + 2e-3 * Sum(marched, 3));
    EXPECT_GT(inr::ImagePsnr(traced, marched), 18);
  }
}

TEST(PathTracing, LightAddsUpAndCanBeSwitchedOff)
{
  Traced one;
  const auto light = one.addLight();
  light->SetDiffuseColor(1, 0.5, 0);
  const inr::Image once = one.exact();
  EXPECT_GT(Sum(once, 0), 0);
  EXPECT_EQ(Sum(once, 2), 0);
  light->SetIntensity(2);
  EXPECT_NEAR(Sum(one.exact(), 0), 2 * Sum(once, 0), 1e-3 * Sum(once, 0));
  light->SwitchOff();
  const inr::Image dark = one.exact();
  EXPECT_EQ(Sum(dark, 0), 0);
  EXPECT_EQ(Sum(dark, 3), Sum(once, 3)); // light changes no opacity
}

TEST(PathTracing, LightComesFromWhereItIs)
{
  Traced one;
  const auto light = one.addLight();
  light->SetPositional(1);
  light->SetConeAngle(120); // a point, as everywhere in VTK
  const double* center = one.volume->GetCenter();
  light->SetPosition(center[0] - 200, center[1], center[2]);
  const inr::Image left = one.exact();
  light->SetPosition(center[0] + 200, center[1], center[2]);
  const inr::Image right = one.exact();
  EXPECT_LT(inr::ImagePsnr(left, right), 25);
  EXPECT_EQ(Sum(left, 3), Sum(right, 3));
  light->SetFocalPoint(center[0], center[1], center[2]);
  light->SetConeAngle(1);
  const double spot = Sum(one.exact(), 0);
  EXPECT_GT(spot, 0);
  EXPECT_LT(spot, 0.9 * Sum(right, 0));
  light->SetFocalPoint(center[0] + 400, center[1], center[2]);
  EXPECT_EQ(Sum(one.exact(), 0), 0);
}

TEST(PathTracing, AlbedoAndBouncesDarken)
{
  Traced one;
  one.mapper->SetAmbientLight(1, 1, 1);
  const double bright = Sum(one.exact(), 0);
  one.mapper->SetScatteringAlbedo(0.5);
  const double grey = Sum(one.exact(), 0);
  EXPECT_LT(grey, 0.6 * bright);
  one.mapper->SetScatteringAlbedo(0);
  EXPECT_EQ(Sum(one.exact(), 0), 0);
  one.mapper->SetScatteringAlbedo(1);
  one.mapper->SetMaximumBounces(1);
  EXPECT_LT(Sum(one.exact(), 0), 0.95 * bright);
}

TEST(PathTracing, IsReproducibleAndSeeded)
{
  Traced one;
  Traced two;
  const inr::Image first = one.exact();
  EXPECT_EQ(first.pixels, one.exact().pixels); // nothing is added to a converged picture
  two.mapper->SetNumberOfThreads(1);
  EXPECT_EQ(first.pixels, two.exact().pixels);
  two.mapper->SetSeed(1);
  EXPECT_NE(first.pixels, two.exact().pixels);
}

TEST(PathTracing, DoesNotGoByWhatRaysCost)
{
  Traced one;
  one.scene.window->SetDesiredUpdateRate(5);
  const auto reduction = [&](int mode) {
    one.mapper->SetRenderMode(mode);
    one.scene.capture();
    return one.mapper->GetImageReduction();
  };
  EXPECT_EQ(reduction(vtkINRVolumeMapper::RAY_MARCHING), inr::ImageReduction::Unmeasured);
  EXPECT_EQ(reduction(vtkINRVolumeMapper::PATH_TRACING), inr::ImageReduction::UnmeasuredPaths);
  one.mapper->DeterministicOn(); // always the same
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(reduction(vtkINRVolumeMapper::PATH_TRACING), inr::ImageReduction::Unmeasured);
    EXPECT_EQ(reduction(vtkINRVolumeMapper::RAY_MARCHING), inr::ImageReduction::Unmeasured);
  }
}

TEST(PathTracing, InteractiveFramesClearUp)
{
  Traced one;
  one.mapper->SetAmbientLight(1, 1, 1);
  one.mapper->SetSamplesPerPixel(3);
  one.scene.window->SetDesiredUpdateRate(1e6);
  one.scene.capture();
  EXPECT_FALSE(one.mapper->GetConverged());
  int frames = 1;
  while (!one.mapper->GetConverged() && frames < 3000) {
    one.scene.capture();
    ++frames;
  }
  EXPECT_GE(frames, 3);
  EXPECT_TRUE(one.mapper->GetConverged());
  one.scene.window->SetDesiredUpdateRate(0.002);
  one.scene.capture();
  EXPECT_TRUE(one.mapper->GetConverged());
  EXPECT_EQ(one.mapper->GetImageReduction(), 1);
}

/// The window's event loop, in which alone VTK 9.1 fires timers; for a minute at most.
void RunUntilConverged(vtkRenderWindowInteractor* interactor, vtkINRVolumeMapper* mapper)
{
  struct Watch
  {
    vtkINRVolumeMapper* mapper;
    std::chrono::steady_clock::time_point end;
  } watch{mapper, std::chrono::steady_clock::now() + std::chrono::seconds(60)};
  vtkNew<vtkCallbackCommand> look;
  look->SetClientData(&watch);
  look->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const auto* watched = static_cast<Watch*>(data);
    if (watched->mapper->GetConverged() || std::chrono::steady_clock::now() > watched->end) {
      static_cast<vtkRenderWindowInteractor*>(caller)->TerminateApp();
    }
  });
  interactor->AddObserver(vtkCommand::TimerEvent, look);
  interactor->CreateRepeatingTimer(20);
  interactor->Start();
  interactor->RemoveObserver(look);
}

TEST(PathTracing, WindowsClearUpWhileTheyAreIdle)
{
  Traced one;
  one.mapper->SetAmbientLight(1, 1, 1);
  one.mapper->SetSamplesPerPixel(6);
  one.mapper->SetStillTimeLimit(1e-3); // a sample, or what there is of one, for each frame
  one.scene.window->SetOffScreenRendering(0);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(one.scene.window);
  interactor->Initialize();
  one.scene.window->Render();
  EXPECT_FALSE(one.mapper->GetConverged());
  RunUntilConverged(interactor, one.mapper);
  EXPECT_TRUE(one.mapper->GetConverged());
}

TEST(PathTracing, PicturesShownElsewhereGoOnWhenThatIsAskedFor)
{
  Traced one;
  one.mapper->SetAmbientLight(1, 1, 1);
  one.mapper->SetSamplesPerPixel(6);
  one.mapper->SetStillTimeLimit(1e-3);
  one.mapper->ShownElsewhereOn();
  EXPECT_EQ(one.mapper->TakeRefinementPause(), 0);
  int pictures = 0;
  double pause = 0;
  do {
    one.scene.window->Render();
    pause = one.mapper->TakeRefinementPause();
    EXPECT_EQ(one.mapper->TakeRefinementPause(), 0) << "asked for again";
    EXPECT_EQ(pause > 0, !one.mapper->GetConverged());
    ++pictures;
  } while (pause > 0 && pictures < 1000);
  EXPECT_GT(pictures, 1);
  EXPECT_TRUE(one.mapper->GetConverged());
  EXPECT_EQ(one.mapper->GetNumberOfPaths(), 6);

  one.mapper->SetSamplesPerPixel(12);
  one.mapper->ShownElsewhereOff(); // for a screenshot
  one.scene.window->Render();
  EXPECT_TRUE(one.mapper->GetConverged());
  EXPECT_EQ(one.mapper->TakeRefinementPause(), 0);
}

TEST(PathTracing, WindowsOfBusyApplicationsClearUpLater)
{
  Traced one;
  one.mapper->SetAmbientLight(1, 1, 1);
  one.mapper->SetSamplesPerPixel(6);
  one.mapper->SetStillTimeLimit(1e-3);
  one.scene.window->SetOffScreenRendering(0);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(one.scene.window);
  interactor->Initialize();
  struct Application
  {
    int asked = 0;
    int refined = 0;
    int refinedWhileBusy = 0;
    bool isBusy() const { return this->asked < 3; }
  } application;
  vtkNew<vtkCallbackCommand> answer;
  answer->SetClientData(&application);
  answer->SetCallback([](vtkObject*, unsigned long, void* data, void* mayRefine) {
    auto* asked = static_cast<Application*>(data);
    *static_cast<bool*>(mayRefine) = !asked->isBusy();
    ++asked->asked;
  });
  one.mapper->AddObserver(vtkINRVolumeMapper::RefineEvent, answer);
  one.scene.window->Render();
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&application);
  count->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
    auto* counted = static_cast<Application*>(data);
    ++counted->refined;
    counted->refinedWhileBusy += counted->asked > 0 && counted->isBusy();
  });
  one.scene.window->AddObserver(vtkCommand::EndEvent, count);
  RunUntilConverged(interactor, one.mapper);
  EXPECT_TRUE(one.mapper->GetConverged());
  EXPECT_GT(application.asked, 3);
  EXPECT_GT(application.refined, 0);
  EXPECT_EQ(application.refinedWhileBusy, 0);
}

TEST(PathTracing, EqualsItsBaseline)
{
  Traced one;
  one.addCube();
  one.volume->GetProperty()->SetScalarOpacityUnitDistance(2);
  one.renderer->SetBackground(0.4, 0.4, 0.5);
  one.renderer->SetBackgroundAlpha(1);
  one.mapper->SetSamplesPerPixel(32);
  one.mapper->SetAmbientLight(0.3, 0.3, 0.4);
  one.addLight()->SetIntensity(2);
  const inr::Image drawn = one.scene.capture();
  const std::string file = std::string(INR_TEST_OUTPUT) + "/PathTracing.png";
  test::WritePng(file, drawn);
  const inr::Image baseline =
      test::ReadPng(std::string(INR_TEST_BASELINES) + "/MapperPathTracing.png");
  EXPECT_GT(inr::ImageSsim(drawn, baseline), 0.9) << "see " << file;
}

TEST(PathTracing, RefusesNegativeLight)
{
  Traced one;
  one.mapper->SetAmbientLight(-1, 0, 0);
  test::Messages messages(one.mapper);
  one.scene.capture();
  EXPECT_EQ(messages.errors, 1);
  EXPECT_NE(messages.last.find("ambient"), std::string::npos);
}

} // namespace

// SPDX-License-Identifier: BSD-3-Clause
// Render passes that have a framebuffer of their own, of another size than the window's.
#include "Core/Image/Metrics.h"
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderStepsPass.h>
#include <vtkSSAAPass.h>
#include <vtkSphereSource.h>

#include <gtest/gtest.h>

namespace {

/// A volume with an opaque ball half in it.
struct BallInVolume
{
  BallInVolume()
  {
    this->renderer = this->scene.addRenderer();
    const auto mapper = test::InrMapper(test::Write(*test::MakeModel(), "RenderPasses.inr"));
    vtkVolume* volume = this->scene.addVolume(this->renderer, mapper);
    test::Scene::look(this->renderer);
    vtkNew<vtkSphereSource> ball;
    const double* bounds = volume->GetBounds();
    ball->SetCenter(bounds[0], bounds[2], bounds[4]);
    ball->SetRadius(0.4 * (bounds[1] - bounds[0]));
    ball->SetThetaResolution(64);
    ball->SetPhiResolution(64);
    vtkNew<vtkPolyDataMapper> surface;
    surface->SetInputConnection(ball->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(surface);
    this->renderer->AddActor(actor);
  }

  test::Scene scene;
  vtkRenderer* renderer;
};

} // namespace

TEST(RenderPasses, SupersamplingLeavesAVolumeWhereItIs)
{
  BallInVolume made;
  const inr::Image plain = made.scene.capture();
  vtkNew<vtkSSAAPass> pass;
  vtkNew<vtkRenderStepsPass> steps;
  pass->SetDelegatePass(steps);
  made.renderer->SetPass(pass);
  const inr::Image smooth = made.scene.capture();
  test::WritePng(std::string(INR_TEST_OUTPUT) + "/passes-plain.png", plain);
  test::WritePng(std::string(INR_TEST_OUTPUT) + "/passes-ssaa.png", smooth);
  EXPECT_GT(inr::ImagePsnr(plain, smooth), 28.0); // edges are smoother
  made.renderer->SetPass(nullptr);
  EXPECT_GT(inr::ImagePsnr(plain, made.scene.capture()), 60.0);
}

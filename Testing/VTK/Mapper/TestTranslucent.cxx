// SPDX-License-Identifier: BSD-3-Clause
// Translucent surfaces in front of, inside and behind a volume, in every way in which a renderer
// may draw them. Truth: pictures of the parts, drawn apart and laid over each other by hand, and
// VTK's own volume rendering of the voxels, which takes part in VTK's peeling.
#include "Core/Image/Metrics.h"
#include "Representations/Mapper/Window/TranslucentPeeler.h"
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkPlane.h>
#include <vtkPlaneSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkSphereSource.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace {

struct Peeling
{
  const char* name;
  bool surfaces;
  bool volumes;
};

std::string ModelFile() { return test::Write(*test::MakeModel(), "Translucent.inr"); }

/// A volume, its camera and surfaces that face it.
struct Glasses
{
  explicit Glasses(const Peeling& peeling,
                   vtkSmartPointer<vtkVolumeMapper> drawing = test::InrMapper(ModelFile()))
      : mapper(drawing)
  {
    this->renderer = this->scene.addRenderer();
    this->renderer->SetUseDepthPeeling(peeling.surfaces);
    this->renderer->SetUseDepthPeelingForVolumes(peeling.volumes);
    this->renderer->SetMaximumNumberOfPeels(20);
    this->renderer->SetOcclusionRatio(0);
    this->volume = this->scene.addVolume(this->renderer, this->mapper);
    test::Scene::look(this->renderer);
    if (auto* inr = vtkINRVolumeMapper::SafeDownCast(this->mapper)) {
      inr->SetSampleDistance(0.2); // the parts' samples are not the whole's
      inr->SetAdaptiveSampling(false);
    }
  }

  /// A sheet that faces the camera, `offset` of the volume's length towards it from the middle.
  vtkActor* addSheet(double offset, double opacity, double size = 40)
  {
    vtkCamera* camera = this->renderer->GetActiveCamera();
    const double* normal = camera->GetViewPlaneNormal();
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(-size, -size, 0);
    plane->SetPoint1(size, -size, 0);
    plane->SetPoint2(-size, size, 0);
    plane->SetNormal(normal[0], normal[1], normal[2]);
    plane->SetCenter(this->place(offset).data());
    return this->add(plane->GetOutputPort(), opacity);
  }

  vtkActor* addSphere(double radius, double opacity)
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(this->volume->GetCenter());
    sphere->SetRadius(radius);
    sphere->SetThetaResolution(48);
    sphere->SetPhiResolution(48);
    return this->add(sphere->GetOutputPort(), opacity);
  }

  /// Keeps the volume on one side of a sheet: 1 towards the camera, -1 behind it.
  void keep(double offset, double side)
  {
    const double* normal = this->renderer->GetActiveCamera()->GetViewPlaneNormal();
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(this->place(offset).data());
    plane->SetNormal(side * normal[0], side * normal[1], side * normal[2]);
    this->mapper->AddClippingPlane(plane);
  }

  inr::Image capture()
  {
    this->renderer->ResetCameraClippingRange(-200, 300, -200, 300, -200, 300); // whatever is shown
    return this->scene.capture();
  }

  /// Premultiplied RGBA of what is shown, from captures before black and white: VTK's ways to draw
  /// translucent surfaces do not agree in a window's alpha.
  inr::Image rgba()
  {
    this->renderer->SetBackgroundAlpha(1);
    inr::Image result = this->capture();
    this->renderer->SetBackground(1, 1, 1);
    const inr::Image white = this->capture();
    this->renderer->SetBackground(0, 0, 0);
    for (std::size_t k = 0; k < white.pixels.size(); k += 4) {
      float passes = 0;
      for (std::size_t channel = k; channel < k + 3; ++channel) {
        passes += (white.pixels[channel] - result.pixels[channel]) / 3;
      }
      result.pixels[k + 3] = 1 - passes;
    }
    return result;
  }

  std::array<double, 3> place(double offset)
  {
    const double* normal = this->renderer->GetActiveCamera()->GetViewPlaneNormal();
    const double* center = this->volume->GetCenter();
    const double length = offset * this->volume->GetLength();
    return {center[0] + length * normal[0], center[1] + length * normal[1],
            center[2] + length * normal[2]};
  }

  vtkActor* add(vtkAlgorithmOutput* port, double opacity)
  {
    vtkNew<vtkPolyDataMapper> polygons;
    polygons->SetInputConnection(port);
    vtkNew<vtkActor> actor;
    actor->SetMapper(polygons);
    actor->GetProperty()->SetColor(0.2, 0.9, 0.4);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetOpacity(opacity);
    this->renderer->AddActor(actor);
    return actor;
  }

  test::Scene scene;
  vtkRenderer* renderer = nullptr;
  vtkVolume* volume = nullptr;
  vtkSmartPointer<vtkVolumeMapper> mapper;
};

constexpr double Clear = 0.45; ///< opacity of a sheet

inr::Image Over(const inr::Image& front, const inr::Image& back)
{
  inr::Image result = front;
  for (std::size_t k = 0; k < result.pixels.size(); ++k) {
    result.pixels[k] += (1.0f - front.pixels[k / 4 * 4 + 3]) * back.pixels[k];
  }
  return result;
}

inr::Image VolumeAlone(double offset = 0, double side = 0)
{
  Glasses parts({"", false, false});
  if (side != 0) {
    parts.keep(offset, side);
  }
  return parts.rgba();
}

inr::Image SheetAlone(double offset)
{
  Glasses parts({"", false, false});
  parts.volume->VisibilityOff();
  parts.addSheet(offset, Clear);
  return parts.rgba();
}

double MeanDifference(const inr::Image& a, const inr::Image& b)
{
  double sum = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    sum += std::abs(a.pixels[k] - b.pixels[k]);
  }
  return sum / static_cast<double>(a.pixels.size());
}

void Write(const inr::Image& image, const std::string& name)
{
  test::WritePng(std::string(INR_TEST_OUTPUT) + "/Translucent" + name + ".png", image);
}

class Translucent : public testing::TestWithParam<Peeling>
{
protected:
  void expect(const inr::Image& shown, const inr::Image& truth, const std::string& name) const
  {
    Write(shown, name + this->GetParam().name);
    Write(truth, name + "Truth");
    EXPECT_LT(MeanDifference(shown, truth), 1.2 / 255);
    EXPECT_LT(inr::ImageMaximumError(shown, truth), 6.0 / 255);
  }
};

TEST_P(Translucent, InFrontCoversTheVolume)
{
  Glasses scene(this->GetParam());
  scene.addSheet(0.7, Clear);
  this->expect(scene.rgba(), Over(SheetAlone(0.7), VolumeAlone()), "InFront");
}

TEST_P(Translucent, BehindIsCoveredByTheVolume)
{
  Glasses scene(this->GetParam());
  scene.addSheet(-0.7, Clear);
  this->expect(scene.rgba(), Over(VolumeAlone(), SheetAlone(-0.7)), "Behind");
}

TEST_P(Translucent, InsideLiesBetweenTheHalvesOfTheVolume)
{
  Glasses scene(this->GetParam());
  scene.addSheet(0.05, Clear);
  const inr::Image back = Over(SheetAlone(0.05), VolumeAlone(0.05, -1));
  this->expect(scene.rgba(), Over(VolumeAlone(0.05, 1), back), "Inside");
}

TEST_P(Translucent, SeveralAreAllInTheirPlaces)
{
  Glasses scene(this->GetParam());
  for (const double offset : {-0.7, 0.05, 0.7}) { // as alpha blending wants them
    scene.addSheet(offset, Clear);
  }
  const inr::Image back = Over(SheetAlone(0.05), Over(VolumeAlone(0.05, -1), SheetAlone(-0.7)));
  this->expect(scene.rgba(), Over(SheetAlone(0.7), Over(VolumeAlone(0.05, 1), back)), "Several");
}

TEST_P(Translucent, PathsAreSeenThroughThem)
{
  const auto pathTraced = [](Glasses& scene) {
    auto* mapper = vtkINRVolumeMapper::SafeDownCast(scene.mapper);
    mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
    mapper->SetSamplesPerPixel(8);
  };
  Glasses alone({"", false, false});
  pathTraced(alone);
  Glasses scene(this->GetParam());
  pathTraced(scene);
  scene.addSheet(0.7, Clear);
  const inr::Image truth = Over(SheetAlone(0.7), alone.rgba());
  this->expect(scene.rgba(), truth, "Paths");
}

TEST_P(Translucent, LeaveWhatLiesOverTheSceneOnTop)
{
  Glasses scene(this->GetParam());
  scene.addSheet(0.7, Clear);
  vtkNew<vtkPlaneSource> square; // in pixels
  square->SetOrigin(100, 70, 0);
  square->SetPoint1(140, 70, 0);
  square->SetPoint2(100, 110, 0);
  vtkNew<vtkPolyDataMapper2D> flat;
  flat->SetInputConnection(square->GetOutputPort());
  vtkNew<vtkActor2D> label;
  label->SetMapper(flat);
  label->GetProperty()->SetColor(0, 0, 1);
  scene.renderer->AddActor2D(label);
  const inr::Image shown = scene.capture();
  Write(shown, std::string("Label") + this->GetParam().name);
  for (int y = 75; y < 105; ++y) {
    for (int x = 105; x < 135; ++x) {
      const float* pixel = shown.pixel(x, y);
      ASSERT_TRUE(pixel[0] < 0.01f && pixel[1] < 0.01f && pixel[2] > 0.99f) << x << ", " << y;
    }
  }
}

/// As two volumes with one mapper.
TEST_P(Translucent, EachVolumeOfOneMapperIsDrawn)
{
  Glasses scene(this->GetParam());
  scene.addSheet(-0.7, Clear, 5); // without one, nothing is peeled
  scene.volume->VisibilityOff();
  const vtkSmartPointer<vtkVolume> copy = vtkSmartPointer<vtkVolume>::New();
  copy->SetMapper(scene.mapper);
  copy->SetProperty(scene.volume->GetProperty());
  const double* bounds = scene.volume->GetBounds();
  copy->SetPosition(0.6 * (bounds[1] - bounds[0]), 0, 0);
  scene.renderer->AddVolume(copy);
  const inr::Image second = scene.rgba();
  scene.volume->VisibilityOn();
  copy->VisibilityOff();
  const inr::Image first = scene.rgba();
  copy->VisibilityOn();
  const inr::Image both = scene.rgba();
  int missing = 0;
  for (std::size_t k = 3; k < both.pixels.size(); k += 4) {
    missing += both.pixels[k] < std::max(first.pixels[k], second.pixels[k]) - 0.02f ? 1 : 0;
  }
  EXPECT_EQ(missing, 0);
}

TEST_P(Translucent, InteractivePicturesHaveThemToo)
{
  Glasses scene(this->GetParam());
  auto* mapper = vtkINRVolumeMapper::SafeDownCast(scene.mapper);
  mapper->SetDeterministic(true); // a quarter of the resolution
  mapper->SetCacheSize(64);
  scene.addSheet(0.05, Clear);
  const inr::Image still = scene.capture();
  scene.scene.window->SetDesiredUpdateRate(10);
  scene.renderer->GetActiveCamera()->Zoom(1.0001); // as good as the same
  for (int k = 0; k < 6; ++k) {
    scene.capture();
  }
  const inr::Image moving = scene.capture();
  Write(moving, std::string("Moving") + this->GetParam().name);
  EXPECT_GT(mapper->GetImageReduction(), 1);
  EXPECT_LT(MeanDifference(still, moving), 5.0 / 255);
}

TEST_P(Translucent, SurviveWindowsAndViewportsOfNoSize)
{
  Glasses scene(this->GetParam());
  test::Messages messages(scene.mapper);
  scene.addSheet(0.05, Clear);
  const inr::Image before = scene.capture();
  scene.renderer->SetViewport(0.5, 0, 0.5, 1);
  scene.scene.window->Render();
  scene.renderer->SetViewport(0, 0, 1, 1);
  scene.scene.window->SetSize(1, 1);
  scene.scene.window->Render();
  scene.scene.window->SetSize(test::Scene::Width, test::Scene::Height);
  EXPECT_LT(inr::ImageMaximumError(scene.capture(), before), 1e-6);
  EXPECT_EQ(messages.errors, 0) << messages.last;
}

TEST_P(Translucent, MayBeAroundTheCamera)
{
  Glasses scene(this->GetParam());
  test::Messages messages(scene.mapper);
  scene.addSphere(300, Clear);
  scene.addSphere(5, Clear);
  vtkCamera* camera = scene.renderer->GetActiveCamera();
  const auto eye = scene.place(0.1);
  camera->SetPosition(eye.data());
  const inr::Image shown = scene.capture();
  Write(shown, std::string("Around") + this->GetParam().name);
  EXPECT_TRUE(std::all_of(shown.pixels.begin(), shown.pixels.end(),
                          [](float x) { return std::isfinite(x); }));
  EXPECT_EQ(messages.errors, 0) << messages.last;
}

INSTANTIATE_TEST_SUITE_P(Mapper, Translucent,
                         testing::Values(Peeling{"Blended", false, false},
                                         Peeling{"Peeled", true, false},
                                         Peeling{"PeeledWithVolumes", true, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(TranslucentSphere, AgreesWithVtkPeelingTheVoxels)
{
  const Peeling all{"", true, true};
  Glasses scene(all);
  scene.addSphere(14, 0.5);
  Glasses voxels(all, test::VoxelMapper(test::Decode(test::MakeModel())));
  voxels.addSphere(14, 0.5);
  const inr::Image shown = scene.capture();
  const inr::Image truth = voxels.capture();
  Write(shown, "Sphere");
  Write(truth, "SphereVoxels");
  EXPECT_GT(inr::ImagePsnr(shown, truth), 29.0);
}

TEST(MostLayers, FitMemory)
{
  EXPECT_EQ(inr::MostLayers(1), 64);
  EXPECT_EQ(inr::MostLayers(1920 * 1080), 25);
  EXPECT_EQ(inr::MostLayers(std::int64_t{1} << 28), 4);
}

TEST(TranslucentSphere, IsOnlyDrawnAgainWhenItIsSeen)
{
  Glasses scene({"", false, false});
  vtkActor* sphere = scene.addSphere(14, 0.5);
  int drawn = 0;
  const auto count = [](vtkObject*, unsigned long, void* counter, void*) {
    ++*static_cast<int*>(counter);
  };
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&drawn);
  command->SetCallback(count);
  sphere->GetMapper()->AddObserver(vtkCommand::EndEvent, command);
  scene.capture();
  EXPECT_EQ(drawn, 1 + 3); // by the renderer; front, back, and nothing behind it
  drawn = 0;
  sphere->GetProperty()->SetOpacity(1);
  scene.capture();
  EXPECT_EQ(drawn, 1);
}

} // namespace

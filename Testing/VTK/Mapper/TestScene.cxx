// SPDX-License-Identifier: BSD-3-Clause
#include "TestScene.h"

#include "vtkINRReader.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkContourValues.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRendererCollection.h>
#include <vtkSphereSource.h>
#include <vtkVersionMacros.h>
#include <vtkVolumeCollection.h>
#include <vtkVolumeProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <stdexcept>

namespace test {
namespace {

inr::Image ToImage(vtkImageData* source)
{
  const int* dims = source->GetDimensions();
  const int channels = source->GetNumberOfScalarComponents();
  if (channels != 4 || source->GetScalarType() != VTK_UNSIGNED_CHAR) {
    throw std::runtime_error("not an 8-bit RGBA picture");
  }
  inr::Image image(dims[0], dims[1], 4);
  const auto* bytes = static_cast<const unsigned char*>(source->GetScalarPointer());
  std::transform(bytes, bytes + image.pixels.size(), image.pixels.begin(),
                 [](unsigned char byte) { return static_cast<float>(byte) / 255.0f; });
  return image;
}

void Perspective(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* renderer = scene.addRenderer();
  scene.addVolume(renderer, mapper());
  Scene::look(renderer);
}

void Parallel(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* renderer = scene.addRenderer();
  scene.addVolume(renderer, mapper());
  renderer->GetActiveCamera()->ParallelProjectionOn();
  Scene::look(renderer);
}

void Transformed(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* renderer = scene.addRenderer();
  vtkVolume* volume = scene.addVolume(renderer, mapper());
  volume->SetScale(-1.0, 1.4, 0.6); // mirrored and stretched
  volume->RotateX(25);
  volume->RotateZ(40);
  volume->SetPosition(7, -3, 11);
  Scene::look(renderer);
}

vtkVolume* FirstVolume(Scene& scene)
{
  vtkRenderer* renderer = scene.window->GetRenderers()->GetFirstRenderer();
  vtkVolumeCollection* volumes = renderer->GetVolumes();
  volumes->InitTraversal();
  return volumes->GetNextVolume();
}

void OpaqueInside(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* renderer = scene.addRenderer();
  vtkVolume* volume = scene.addVolume(renderer, mapper());
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(volume->GetCenter());
  sphere->SetRadius(11);
  sphere->SetThetaResolution(48);
  sphere->SetPhiResolution(48);
  vtkNew<vtkPolyDataMapper> polygons;
  polygons->SetInputConnection(sphere->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(polygons);
  actor->GetProperty()->SetColor(0.2, 0.9, 0.3);
  renderer->AddActor(actor);
  Scene::look(renderer);
}

void TwoViewports(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* left = scene.addRenderer(0, 0.4);
  scene.addVolume(left, mapper());
  Scene::look(left);
  vtkRenderer* right = scene.addRenderer(0.4, 1);
  scene.addVolume(right, mapper());
  Scene::look(right);
  right->GetActiveCamera()->Azimuth(70);
  right->ResetCameraClippingRange();
}

void ClippingPlane(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* renderer = scene.addRenderer();
  vtkVolume* volume = scene.addVolume(renderer, mapper());
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(volume->GetCenter());
  plane->SetNormal(-0.6, 0.5, 0.6);
  volume->GetMapper()->AddClippingPlane(plane);
  Scene::look(renderer);
}

void Stereo(Scene& scene, const MapperFactory& mapper)
{
  vtkRenderer* renderer = scene.addRenderer();
  scene.addVolume(renderer, mapper());
  Scene::look(renderer);
  renderer->GetActiveCamera()->SetEyeAngle(20); // far more than comfortable: must be visible
  scene.window->StereoRenderOn();
  scene.window->SetStereoTypeToRight();
}

void Shaded(Scene& scene, const MapperFactory& mapper)
{
  Perspective(scene, mapper);
  vtkVolume* volume = FirstVolume(scene);
  volume->GetProperty()->ShadeOn();
  volume->GetProperty()->SetSpecular(0.5);
}

SceneCase Projected(const std::string& name, int blendMode)
{
  return {name, [blendMode](Scene& scene, const MapperFactory& mapper) {
            Perspective(scene, mapper);
            vtkVolume* volume = FirstVolume(scene);
            auto* projecting = vtkVolumeMapper::SafeDownCast(volume->GetMapper());
            projecting->SetBlendMode(blendMode);
            projecting->SetAverageIPScalarRange(0, 120);
            volume->GetProperty()->SetScalarOpacityUnitDistance(12);
            volume->GetProperty()->ShadeOn(); // means nothing to a projection
          }};
}

SceneCase Cropped(const std::string& name, int flags)
{
  return {name, [flags](Scene& scene, const MapperFactory& mapper) {
            Perspective(scene, mapper);
            vtkVolume* volume = FirstVolume(scene);
            auto* cropped = vtkVolumeMapper::SafeDownCast(volume->GetMapper());
            const double* bounds = volume->GetBounds();
            double planes[6];
            for (int axis = 0; axis < 3; ++axis) {
              const double size = bounds[2 * axis + 1] - bounds[2 * axis];
              planes[2 * axis] = bounds[2 * axis] + 0.35 * size;
              planes[2 * axis + 1] = bounds[2 * axis] + 0.6 * size;
            }
            cropped->CroppingOn();
            cropped->SetCroppingRegionPlanes(planes);
            cropped->SetCroppingRegionFlags(flags);
          }};
}

/// One in the other, lit; the outer one shows the inner one.
void Surfaces(Scene& scene, const MapperFactory& mapper)
{
  Perspective(scene, mapper);
  vtkVolume* volume = FirstVolume(scene);
  vtkVolumeMapper::SafeDownCast(volume->GetMapper())->SetBlendModeToIsoSurface();
  volume->GetProperty()->GetIsoSurfaceValues()->SetValue(0, 40);
  volume->GetProperty()->GetIsoSurfaceValues()->SetValue(1, 100);
  volume->GetProperty()->ShadeOn();
  volume->GetProperty()->SetSpecular(0); // VTK before 9.2 has others
}

/// Of what two planes leave; at its faces the whole volume is at its minimum.
void MinimumInside(Scene& scene, const MapperFactory& mapper)
{
  Projected("", vtkVolumeMapper::MINIMUM_INTENSITY_BLEND).make(scene, mapper);
  vtkVolume* volume = FirstVolume(scene);
  const double* center = volume->GetCenter();
  for (const double side : {-1.0, 1.0}) {
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(center[0], center[1], center[2] + 4 * side);
    plane->SetNormal(0, 0, -side);
    volume->GetMapper()->AddClippingPlane(plane);
  }
}

/// Without ambient and specular parts: with more than a headlight VTK's mapper has an error in
/// each.
void Lights(Scene& scene, const MapperFactory& mapper)
{
  Perspective(scene, mapper);
  vtkVolume* volume = FirstVolume(scene);
  volume->GetProperty()->ShadeOn();
  volume->GetProperty()->SetAmbient(0);
  volume->GetProperty()->SetDiffuse(0.9);
  volume->GetProperty()->SetSpecular(0);
  vtkRenderer* renderer = scene.window->GetRenderers()->GetFirstRenderer();
  const double* center = volume->GetCenter();
  vtkNew<vtkLight> sun;
  sun->SetPosition(center[0] + 100, center[1] + 300, center[2] - 100);
  sun->SetFocalPoint(center[0], center[1], center[2]);
  sun->SetDiffuseColor(1.0, 0.6, 0.2);
  renderer->AddLight(sun);
  vtkNew<vtkLight> lamp;
  lamp->SetPositional(true);
  lamp->SetConeAngle(180);
  lamp->SetPosition(center[0] - 60, center[1], center[2] + 70);
  lamp->SetFocalPoint(center[0], center[1], center[2]);
  lamp->SetDiffuseColor(0.2, 0.4, 1.0);
  renderer->AddLight(lamp);
}

} // namespace

std::vector<SceneCase> SceneCases()
{
  // Not comparable: VTK before 9.2 has other highlights, in stereo VTK's GPU mapper does not follow
  // the polygons, and in a second viewport it draws, one run in five, with the shape of the whole
  // window.
  return {{"Perspective", Perspective},
          {"Parallel", Parallel},
          {"Transformed", Transformed},
          {"OpaqueInside", OpaqueInside},
          {"TwoViewports", TwoViewports, false, false},
          {"ClippingPlane", ClippingPlane},
          {"Stereo", Stereo, false, false},
          {"Oblique", Perspective, true},
          {"Shaded", Shaded, false, VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)},
          {"Lights", Lights},
          Projected("Maximum", vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND),
          {"Minimum", MinimumInside},
          Projected("Average", vtkVolumeMapper::AVERAGE_INTENSITY_BLEND),
          Projected("Additive", vtkVolumeMapper::ADDITIVE_BLEND),
          {"Isosurfaces", Surfaces},
          Cropped("Cropped", VTK_CROP_SUBVOLUME),
          Cropped("CroppedFence", VTK_CROP_FENCE)};
}

Scene::Scene()
{
  this->window->SetOffScreenRendering(1);
  this->window->SetSize(Width, Height);
  this->window->SetMultiSamples(0);
  this->window->SetAlphaBitPlanes(1);
}

vtkRenderer* Scene::addRenderer(double xmin, double xmax)
{
  vtkNew<vtkRenderer> renderer;
  renderer->SetViewport(xmin, 0, xmax, 1);
  renderer->SetBackground(0, 0, 0);
  renderer->SetBackgroundAlpha(0);
  this->window->AddRenderer(renderer);
  return renderer;
}

vtkVolume* Scene::addVolume(vtkRenderer* renderer, vtkVolumeMapper* mapper)
{
  vtkNew<vtkColorTransferFunction> colour;
  colour->AddRGBPoint(-20, 0.1, 0.2, 0.9);
  colour->AddRGBPoint(60, 0.9, 0.9, 0.6);
  colour->AddRGBPoint(180, 0.9, 0.1, 0.1);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(-10, 0);
  opacity->AddPoint(30, 0.15);
  opacity->AddPoint(170, 0.8);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->GetProperty()->SetColor(colour);
  volume->GetProperty()->SetScalarOpacity(opacity);
  volume->GetProperty()->SetScalarOpacityUnitDistance(4);
  volume->GetProperty()->SetInterpolationTypeToLinear();
  renderer->AddVolume(volume);
  return volume;
}

void Scene::look(vtkRenderer* renderer)
{
  renderer->ResetCamera();
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->Azimuth(35);
  camera->Elevation(25);
  camera->Roll(10);
  camera->Zoom(1.4);
  renderer->ResetCameraClippingRange();
}

inr::Image Scene::capture()
{
  this->window->Render();
  vtkNew<vtkWindowToImageFilter> reader;
  reader->SetInput(this->window);
  reader->SetInputBufferTypeToRGBA();
  reader->ReadFrontBufferOff();
  reader->ShouldRerenderOff();
  reader->Update();
  return ToImage(reader->GetOutput());
}

vtkSmartPointer<vtkINRVolumeMapper> InrMapper(const std::string& file, vtkIdType maximumGridPoints)
{
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(file.c_str());
  reader->SetMaximumGridPoints(maximumGridPoints);
  auto mapper = vtkSmartPointer<vtkINRVolumeMapper>::New();
  mapper->SetInputConnection(reader->GetOutputPort());
  return mapper;
}

vtkSmartPointer<vtkVolumeMapper> VoxelMapper(vtkImageData* voxels)
{
  // Not the fixed-point mapper: it knows no direction matrix, and on the first frame no aspect
  // ratio.
  auto mapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
  mapper->SetInputData(voxels);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1);
  mapper->SetSampleDistance(0.25f);
  return mapper;
}

Messages::Messages(vtkObject* object)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(this);
  command->SetCallback([](vtkObject*, unsigned long event, void* self, void* text) {
    auto* messages = static_cast<Messages*>(self);
    ++(event == vtkCommand::ErrorEvent ? messages->errors : messages->warnings);
    messages->last = static_cast<const char*>(text);
  });
  object->AddObserver(vtkCommand::ErrorEvent, command);
  object->AddObserver(vtkCommand::WarningEvent, command);
}

inr::Image ReadPng(const std::string& path)
{
  vtkNew<vtkPNGReader> reader;
  if (!reader->CanReadFile(path.c_str())) {
    throw std::runtime_error("cannot read " + path);
  }
  reader->SetFileName(path.c_str());
  reader->Update();
  return ToImage(reader->GetOutput());
}

void WritePng(const std::string& path, const inr::Image& image)
{
  vtkNew<vtkImageData> picture;
  picture->SetDimensions(image.width, image.height, 1);
  picture->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  auto* bytes = static_cast<unsigned char*>(picture->GetScalarPointer());
  std::transform(image.pixels.begin(), image.pixels.end(), bytes, [](float value) {
    return static_cast<unsigned char>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
  });
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(picture);
  writer->Write();
}

} // namespace test

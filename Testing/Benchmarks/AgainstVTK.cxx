// SPDX-License-Identifier: BSD-3-Clause
//
// Our mapper beside VTK's software one, vtkFixedPointVolumeRayCastMapper, on the decoded voxels of
// the same model: same camera, transfer function, threads and constant step; time inside the
// mapper. The truth is ours with a sixteenth of the step: VTK's sums of small opacities are
// rounded.
//
//   bench_against_vtk MODEL.inr NAME      prints one JSON object per line
#include "Core/Image/Image.h"
#include "Core/Image/Metrics.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/ModelFile.h"
#include "vtkINRReader.h"
#include "vtkINRVolumeMapper.h"

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int Threads = 2;
constexpr int Frames = 9;
constexpr int Size = 512;
constexpr double MostDrift = 0.1; ///< of VTK's time, from before ours to behind it
constexpr int MostTries = 5;

vtkSmartPointer<vtkImageData> Decode(const inr::Model& model, const inr::ModelPointer& pointer)
{
  const inr::VolumeInfo& volume = model.volume;
  std::vector<float> normalised(
      static_cast<std::size_t>(volume.dims.x * volume.dims.y * volume.dims.z));
  inr::EvaluateLattice(*inr::MakeEvaluator(pointer), inr::Arena(Threads),
                       inr::VoxelLattice(volume.dims, glm::i64vec3(0), volume.dims),
                       normalised.data());
  vtkNew<vtkFloatArray> scalars;
  scalars->SetName(volume.arrayName.c_str());
  scalars->SetNumberOfValues(static_cast<vtkIdType>(normalised.size()));
  for (std::size_t k = 0; k < normalised.size(); ++k) {
    const double value = inr::ValueOf(volume, inr::NormalisedOutput(normalised[k]));
    scalars->SetValue(static_cast<vtkIdType>(k), static_cast<float>(value));
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(volume.dims.x), static_cast<int>(volume.dims.y),
                       static_cast<int>(volume.dims.z));
  image->SetSpacing(volume.spacing.x, volume.spacing.y, volume.spacing.z);
  image->SetOrigin(volume.origin.x, volume.origin.y, volume.origin.z);
  image->GetPointData()->SetScalars(scalars);
  return image;
}

struct Opacity
{
  std::string name;
  std::vector<std::pair<double, double>> points; ///< fraction of the value range, opacity
  double target;                                 ///< of VTK's time, with longer steps
  bool lit;
};

void SetColours(vtkVolumeProperty* property, const inr::VolumeInfo& volume, const Opacity& opacity)
{
  const double range = volume.high - volume.low;
  vtkNew<vtkPiecewiseFunction> alpha;
  for (const auto& [fraction, value] : opacity.points) {
    alpha->AddPoint(volume.low + fraction * range, value);
  }
  vtkNew<vtkColorTransferFunction> colour;
  colour->AddRGBPoint(volume.low, 0.2, 0.3, 0.8);
  colour->AddRGBPoint(volume.low + 0.5 * range, 0.9, 0.9, 0.8);
  colour->AddRGBPoint(volume.high, 0.7, 0.0, 0.1);
  property->SetScalarOpacity(alpha);
  property->SetColor(colour);
  property->SetInterpolationTypeToLinear();
  property->SetShade(opacity.lit ? 1 : 0); // by VTK's defaults, and a headlight
  const glm::dvec3& spacing = volume.spacing;
  property->SetScalarOpacityUnitDistance(2 * std::min({spacing.x, spacing.y, spacing.z}));
}

struct Measured
{
  double milliseconds; ///< median
  inr::Image picture;
};

inr::Image ReadBack(vtkRenderWindow* window)
{
  vtkNew<vtkWindowToImageFilter> reader;
  reader->SetInput(window);
  reader->SetInputBufferTypeToRGBA();
  reader->ReadFrontBufferOff();
  reader->ShouldRerenderOff();
  reader->Update();
  vtkImageData* output = reader->GetOutput();
  inr::Image image(Size, Size, 4);
  const auto* bytes = static_cast<const unsigned char*>(output->GetScalarPointer());
  std::transform(bytes, bytes + image.pixels.size(), image.pixels.begin(),
                 [](unsigned char byte) { return static_cast<float>(byte) / 255.0f; });
  return image;
}

Measured Measure(vtkVolumeMapper* mapper, const inr::VolumeInfo& info, const Opacity& opacity,
                 int frames = Frames)
{
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  SetColours(volume->GetProperty(), info, opacity);
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  window->SetSize(Size, Size);
  window->AddRenderer(renderer);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Azimuth(30);
  renderer->GetActiveCamera()->Elevation(20);
  renderer->GetActiveCamera()->Zoom(1.3);
  renderer->ResetCameraClippingRange();
  window->Render(); // makes what there is to make
  std::vector<double> times;
  for (int frame = 0; frame < frames; ++frame) {
    renderer->GetActiveCamera()->Azimuth(frame % 2 == 0 ? 0.01 : -0.01); // a still one is kept
    window->Render();
    times.push_back(1000 * mapper->GetTimeToDraw());
  }
  std::sort(times.begin(), times.end());
  return {times[times.size() / 2], ReadBack(window)};
}

void Report(const std::string& name, double value, const std::string& unit,
            const std::string& better, const std::string& more)
{
  std::cout << "{\"name\": \"" << name << "\", \"value\": " << value << ", \"unit\": \"" << unit
            << "\", \"better\": \"" << better << "\"" << more << "}" << std::endl;
}

struct Way
{
  std::string name;
  bool adaptive;
  bool integrated;
};

/// Of one scene: VTK's, and ours in all ways.
struct Compared
{
  Measured theirs;
  std::vector<Measured> mine;
  double drift; ///< of VTK's time meanwhile
};

Compared Compare(vtkVolumeMapper* fixed, vtkINRVolumeMapper* ours, const inr::VolumeInfo& volume,
                 const Opacity& opacity, const std::vector<Way>& ways)
{
  Compared result{Measure(fixed, volume, opacity), {}, 0};
  for (const Way& way : ways) {
    ours->SetAdaptiveSampling(way.adaptive);
    ours->SetLevelOfDetailScale(way.adaptive ? 1 : 0);
    ours->SetPreIntegration(way.integrated);
    result.mine.push_back(Measure(ours, volume, opacity));
  }
  const double before = result.theirs.milliseconds;
  const double after = Measure(fixed, volume, opacity).milliseconds;
  result.drift = std::abs(after / before - 1);
  result.theirs.milliseconds = (before + after) / 2;
  return result;
}

/// By themselves: where something else is busy, they are measured again.
Compared CompareUndisturbed(vtkVolumeMapper* fixed, vtkINRVolumeMapper* ours,
                            const inr::VolumeInfo& volume, const Opacity& opacity,
                            const std::vector<Way>& ways)
{
  for (int number = 0; number < MostTries; ++number) {
    Compared result = Compare(fixed, ours, volume, opacity, ways);
    if (result.drift <= MostDrift) {
      return result;
    }
    std::cerr << opacity.name << ": VTK's time has changed by " << 100 * result.drift
              << " % meanwhile\n";
  }
  throw std::runtime_error("something else is busy on this machine");
}

inr::Image Truth(vtkINRVolumeMapper* ours, const inr::VolumeInfo& volume, const Opacity& opacity)
{
  ours->SetSampleDistance(1. / 16);
  ours->SetAdaptiveSampling(false);
  ours->SetLevelOfDetailScale(0);
  ours->SetPreIntegration(true);
  inr::Image truth = Measure(ours, volume, opacity, 1).picture;
  ours->SetSampleDistance(1);
  return truth;
}

/// Targets are those of what is not lit.
void ReportScene(const std::string& where, const Opacity& opacity, const inr::Image& truth,
                 const Compared& compared, const std::vector<Way>& ways)
{
  const Measured& theirs = compared.theirs;
  Report("VTK fixed frame" + where, theirs.milliseconds, "ms", "lower", "");
  Report("VTK fixed, PSNR to the truth" + where, inr::ImagePsnr(theirs.picture, truth), "dB",
         "higher", "");
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const Measured& mine = compared.mine[k];
    const std::string how = " " + ways[k].name;
    Report("cached frame" + where + how, mine.milliseconds, "ms", "lower", "");
    const double target = ways[k].adaptive ? opacity.target : 0.9;
    const std::string wanted = opacity.lit ? "" : ", \"target\": " + std::to_string(target);
    Report("vs VTK fixed" + where + how, mine.milliseconds / theirs.milliseconds, "", "lower",
           wanted + ", \"baseline\": \"VTK fixed frame" + where + "\"");
    Report("image PSNR" + where + how, inr::ImagePsnr(mine.picture, theirs.picture), "dB", "higher",
           ways[k].adaptive && !opacity.lit ? ", \"target\": 35" : "");
    Report("PSNR to the truth" + where + how, inr::ImagePsnr(mine.picture, truth), "dB", "higher",
           "");
  }
}

void Run(const char* path, const std::string& scene)
{
  const inr::ModelPointer model = inr::ReadModel(path);
  vtkNew<vtkFixedPointVolumeRayCastMapper> fixed;
  fixed->SetInputData(Decode(*model, model));
  fixed->SetNumberOfThreads(Threads);
  fixed->AutoAdjustSampleDistancesOff();
  fixed->SetImageSampleDistance(1);
  const glm::dvec3& spacing = model->volume.spacing;
  fixed->SetSampleDistance(static_cast<float>(std::min({spacing.x, spacing.y, spacing.z})));

  vtkNew<vtkINRReader> reader;
  reader->SetFileName(path);
  vtkNew<vtkINRVolumeMapper> ours;
  ours->SetInputConnection(reader->GetOutputPort());
  ours->SetNumberOfThreads(Threads);
  const std::vector<Way> ways = {
      {"constant step", false, false}, {"adaptive", true, false}, {"pre-integrated", true, true}};
  const std::vector<std::pair<double, double>> sparse = {
      {0, 0}, {0.55, 0}, {0.65, 0.3}, {0.75, 0}, {1, 0}};
  const std::vector<std::pair<double, double>> dense = {{0, 0.02}, {0.5, 0.1}, {1, 0.3}};
  const std::vector<Opacity> opacities = {{"sparse", sparse, 1.0 / 3, false},
                                          {"dense", dense, 0.6, false},
                                          {"sparse, lit", sparse, 1.0 / 3, true},
                                          {"dense, lit", dense, 0.6, true}};
  for (const Opacity& opacity : opacities) {
    const inr::Image truth = Truth(ours, model->volume, opacity);
    const Compared compared = CompareUndisturbed(fixed, ours, model->volume, opacity, ways);
    ReportScene(" " + opacity.name + ", " + scene, opacity, truth, compared, ways);
  }
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3) {
    std::cerr << "usage: bench_against_vtk MODEL.inr NAME\n";
    return 2;
  }
  try {
    Run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}

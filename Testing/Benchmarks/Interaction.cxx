// SPDX-License-Identifier: BSD-3-Clause
//
// Interactive frames as VTK asks for them: a cold volume of 4096^3 that turns by a degree a frame,
// in a window of 512x512 that wants 30 frames per second; time inside the mapper.
//
//   bench_interaction MODEL.inr NAME      prints one JSON object per line
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "vtkINRReader.h"
#include "vtkINRVolumeMapper.h"

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cstdio>
#include <filesystem>

namespace {

constexpr int Frames = 240;
constexpr double Rate = 30; ///< frames per second
constexpr double Dims = 4096;

/// A file with the model as that of a larger volume between the same bounds, while this lives.
class LargeModel
{
public:
  explicit LargeModel(const inr::ModelPointer& model)
      : Folder(std::filesystem::temp_directory_path() / "bench_interaction")
  {
    inr::Model large = *Scaled(model, glm::i64vec3(static_cast<std::int64_t>(Dims)));
    large.volume.spacing = glm::dvec3(1.0);
    std::filesystem::create_directory(this->Folder);
    inr::WriteModel(large, this->path());
  }
  ~LargeModel() { std::filesystem::remove_all(this->Folder); }
  LargeModel(const LargeModel&) = delete;
  LargeModel& operator=(const LargeModel&) = delete;

  std::string path() const { return this->Folder / "large.inr"; }

private:
  std::filesystem::path Folder;
};

void SetColours(vtkVolumeProperty* property, const inr::TransferFunction& function)
{
  vtkNew<vtkPiecewiseFunction> alpha;
  vtkNew<vtkColorTransferFunction> colour;
  for (std::size_t k = 0; k < function.table.size(); ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(function.table.size() - 1);
    const double value = function.low + part * (function.high - function.low);
    const glm::vec4& color = function.table[k];
    alpha->AddPoint(value, color.w);
    colour->AddRGBPoint(value, color.x, color.y, color.z);
  }
  property->SetScalarOpacity(alpha);
  property->SetColor(colour);
  property->SetScalarOpacityUnitDistance(2 * Dims / 256);
}

double Part(std::vector<double> values, double part)
{
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

void Turn(const std::string& path, const Look& look, int mode, const std::string& name)
{
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkINRVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());
  mapper->SetNumberOfThreads(Threads);
  mapper->SetRenderMode(mode);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  SetColours(volume->GetProperty(), look.function);
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(Size, Size);
  window->SetDesiredUpdateRate(Rate);
  window->AddRenderer(renderer);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Elevation(20);
  renderer->GetActiveCamera()->Zoom(1.3);
  std::vector<double> times;
  double reduction = 0;
  double hits = 0;
  for (int frame = 0; frame < Frames; ++frame) {
    renderer->GetActiveCamera()->Azimuth(1);
    renderer->ResetCameraClippingRange();
    window->Render();
    times.push_back(1000 * mapper->GetFrameTime());
    reduction += mapper->GetImageReduction() / double{Frames};
    hits += mapper->GetCacheHitRate() / double{Frames};
  }
  const std::string where =
      std::string(mode == vtkINRVolumeMapper::RAY_MARCHING ? " RM " : " PT ") + look.name +
      ", 4096^3, " + name;
  Report("interactive frame" + where, Part(times, 0.5), "ms", "lower", Target(1000 / Rate));
  Report("95 of 100 interactive frames" + where, Part(times, 0.95), "ms", "lower",
         Target(1000 / Rate));
  Report("first interactive frame" + where, times.front(), "ms", "lower");
  Report("slowest interactive frame" + where, Part(times, 1), "ms", "lower");
  Report("interactive reduction" + where, reduction, "", "lower",
         ", \"note\": \"mean; window / picture, per axis\"");
  Report("interactive hit rate" + where, hits, "", "higher");
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3) {
    std::cerr << "usage: bench_interaction MODEL.inr NAME\n";
    return 2;
  }
  const inr::ModelPointer model = inr::ReadModel(argv[1]);
  const LargeModel large(model);
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    for (const Look& look : Looks(model->volume)) {
      Turn(large.path(), look, mode, argv[2]);
    }
  }
  return 0;
}

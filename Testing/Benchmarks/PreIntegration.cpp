// SPDX-License-Identifier: BSD-3-Clause
//
// What pre-integrated colours cost and buy at several distances between samples, through the cache
// and straight from the network.
//
//   bench_pre_integration MODEL.inr NAME      prints one JSON object per line
//
// Times are of the processor, as parts of a frame with the default distance and plain colours;
// truth has 64 pre-integrated samples a voxel. pre_integration.py writes the result file.
#include "Core/Image/Metrics.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Benchmarks/InTurn.h"

namespace {

constexpr double Distances[] = {0.25, 0.5, 1, 2};
constexpr double Usual = 0.5;

/// Peaks that are 20, 5 and 2 % of the value range wide, and all of it.
std::vector<Look> LooksOf(const inr::VolumeInfo& volume)
{
  std::vector<Look> looks = Looks(volume);
  looks.push_back(
      {"shell of 5 %",
       MakeFunction(volume, {{0, 0}, {0.625f, 0}, {0.65f, 0.6f}, {0.675f, 0}, {1, 0}})});
  looks.push_back({"shell of 2 %",
                   MakeFunction(volume, {{0, 0}, {0.64f, 0}, {0.65f, 0.8f}, {0.66f, 0}, {1, 0}})});
  return looks;
}

/// How a renderer is asked.
struct Way
{
  std::string name;
  bool cached;
  int size;
  int rounds;
};

inr::Frame FrameOf(const inr::VolumeInfo& volume, int size, double distance, bool integrates)
{
  inr::Frame frame = View(volume);
  frame.width = frame.height = size;
  frame.sampleDistance = distance;
  frame.preIntegration = integrates;
  return frame;
}

inr::Image Picture(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image picture;
  renderer.render(frame, picture);
  return picture;
}

void Measure(const inr::ModelPointer& model, const std::string& scene, const Look& look,
             const Way& way)
{
  inr::RendererOptions options = Cached();
  options.cached = way.cached;
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(look.function);
  inr::Frame exact = FrameOf(model->volume, way.size, 1. / 64, true);
  exact.adaptiveSampling = false;
  exact.levelOfDetailScale = 0;
  const inr::Image truth = Picture(renderer, exact);
  const inr::Frame usual = FrameOf(model->volume, way.size, Usual, false);
  for (const double distance : Distances) {
    for (const bool integrates : {false, true}) {
      const inr::Frame frame = FrameOf(model->volume, way.size, distance, integrates);
      const double psnr = inr::ImagePsnr(Picture(renderer, frame), truth);
      const Spread time = SpreadOf(RatiosInTurn(renderer, frame, usual, way.rounds));
      std::ostringstream name;
      name << (integrates ? "pre-integrated" : "plain") << ", distance " << distance << ", "
           << way.name << ", " << look.name << ", " << scene;
      Report(name.str(), psnr, "dB", "higher",
             ", \"time\": " + std::to_string(time.median) + time.json());
    }
  }
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3) {
    std::cerr << "usage: bench_pre_integration MODEL.inr NAME\n";
    return 2;
  }
  const inr::ModelPointer model = inr::ReadModel(argv[1]);
  for (const Look& look : LooksOf(model->volume)) {
    Measure(model, argv[2], look, {"cache", true, 512, 8});
    Measure(model, argv[2], look, {"network only", false, 128, 2});
  }
  return 0;
}

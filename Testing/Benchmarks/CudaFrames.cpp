// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of 768 x 768 that the GPU draws, and those that the CPU does:
//
//   bench_cuda_frames
//
// prints one JSON object per line; cuda.py writes the result file. Ends with status 77 where there
// is no GPU, and says why.
#include "CUDA/CudaAccelerator.h"
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/TranslucentLayers.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Benchmarks/Models.h"

#include <cmath>

namespace {

constexpr int NoGpu = 77;
constexpr int Edge = 768; ///< pixels

/// The default model of a field with something in every part, seen as 256^3 voxels.
inr::ModelPointer MakeModel()
{
  constexpr int n = 96;
  std::vector<float> values;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        values.push_back(std::sin(0.21f * static_cast<float>(x)) *
                             std::cos(0.17f * static_cast<float>(y)) *
                             std::sin(0.13f * static_cast<float>(z) + 1) +
                         0.3f * std::sin(0.9f * static_cast<float>(x + y - z)));
      }
    }
  }
  inr::VolumeData volume;
  volume.values = values.data();
  volume.type = inr::ScalarType::Float32;
  volume.dims = glm::i64vec3(n);
  inr::TrainingOptions options;
  options.maximumSteps = 200;
  options.timeLimit = 0;
  options.description = DefaultDescription();
  return Scaled(inr::TrainModel(volume, {}, options), glm::i64vec3(256));
}

struct Engine
{
  std::string name;
  std::shared_ptr<const inr::Accelerator> accelerator;
  int cachedFrames; ///< of which the median is told
  int uncachedFrames;
};

/// Else what is measured would be the CPU's.
void RequireWorking(const inr::Renderer& renderer)
{
  const auto failure = renderer.acceleratorFailure();
  if (failure) {
    throw inr::Error(inr::ErrorCode::Device, failure->reason);
  }
}

inr::Renderer RendererFor(const inr::ModelPointer& model, const Look& look, const Engine& engine,
                          bool cached)
{
  inr::RendererOptions options = Cached();
  options.threads = 0;
  options.cached = cached;
  options.accelerator = engine.accelerator;
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(look.function);
  return renderer;
}

inr::Frame FrameFor(const inr::ModelPointer& model, bool traced)
{
  inr::Frame frame = View(model->volume);
  frame.width = frame.height = Edge;
  if (traced) {
    frame = Lit(frame);
    frame.samplesPerPixel = 1;
  }
  return frame;
}

/// The median of so many frames, each of other random numbers: no picture is gone on with.
Timed Frames(inr::Renderer& renderer, inr::Frame frame, int frames)
{
  Timed timed;
  std::vector<double> times;
  for (int k = 0; k < frames; ++k) {
    frame.seed = static_cast<std::uint64_t>(frames - 1 - k); // the last one is the same for all
    timed.statistics = renderer.render(frame, timed.picture);
    times.push_back(timed.statistics.seconds);
  }
  RequireWorking(renderer);
  std::sort(times.begin(), times.end());
  timed.seconds = times[times.size() / 2];
  return timed;
}

/// PSNR in dB, of equal pictures 200: JSON knows no infinity.
double Likeness(const inr::Image& a, const inr::Image& b)
{
  return std::min(inr::ImagePsnr(a, b), 200.0);
}

/// Returns a picture by the cache. Where paths are compared, a rounding may send one elsewhere: of
/// 16 through each pixel.
inr::Image Compare(const inr::ModelPointer& model, const Look& look, const Engine& engine,
                   bool traced)
{
  const std::string kind = traced ? "PT" : "RM";
  const std::string where = " " + look.name + ", " + engine.name; // as bench_cache has it
  const inr::Frame frame = FrameFor(model, traced);
  inr::Renderer cached = RendererFor(model, look, engine, true);
  inr::Image first;
  const double cold = cached.render(frame, first).seconds;
  RequireWorking(cached);
  Report("first picture " + kind + where, 1000 * cold, "ms", "lower");
  const Timed warm = Frames(cached, frame, engine.cachedFrames);
  Report("cached frame " + kind + where, 1000 * warm.seconds, "ms", "lower");
  inr::Renderer network = RendererFor(model, look, engine, false);
  const Timed uncached = Frames(network, frame, engine.uncachedFrames);
  Report("uncached frame " + kind + where, 1000 * uncached.seconds, "ms", "lower");
  const std::string ratio = "cached vs uncached " + kind;
  Report(ratio + where, uncached.seconds / warm.seconds, "", "higher",
         Target(traced ? 3 : 6.5, "uncached frame " + kind + where));
  if (!traced) {
    inr::Frame finest = frame;
    finest.levelOfDetailScale = 0;
    Report("cached beside uncached RM" + where,
           Likeness(Frames(cached, finest, 1).picture, uncached.picture), "dB", "higher",
           Target(40));
  }
  inr::Frame shown = frame;
  shown.samplesPerPixel = 16;
  return Frames(cached, shown, 1).picture;
}

/// Milliseconds, rising.
double Percentile(const std::vector<double>& times, double part)
{
  return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
}

std::vector<double> Sorted(std::vector<double> times)
{
  std::sort(times.begin(), times.end());
  return times;
}

/// A volume of 4096^3 that turns, from an empty cache on: bricks come in behind the frames. Then
/// the same view, how long it takes until nothing is missing, and its frames from then on.
void BenchLarge(const inr::ModelPointer& model, const Engine& gpu)
{
  const inr::ModelPointer large = Scaled(model, glm::i64vec3(4096));
  for (const Look& look : Looks(large->volume)) {
    const std::string where = " 4096^3 " + look.name + ", " + gpu.name;
    inr::Renderer renderer = RendererFor(large, look, gpu, true);
    inr::Image picture;
    std::vector<double> times;
    for (int k = 0; k < 200; ++k) {
      inr::Frame frame = View(large->volume, 0.5 * k);
      frame.width = frame.height = Edge;
      frame.timeLimit = 1e-3; // one pass
      times.push_back(1000 * renderer.render(frame, picture).seconds);
    }
    RequireWorking(renderer);
    times = Sorted(std::move(times));
    const double median = Percentile(times, 0.5);
    Report("frame while bricks load RM" + where, median, "ms", "lower");
    Report("99 of 100 frames while bricks load RM" + where, Percentile(times, 0.99) / median, "",
           "lower", Target(2, "frame while bricks load RM" + where));
    inr::Frame still = View(large->volume);
    still.width = still.height = Edge;
    Report("rest of a picture RM" + where, 1000 * renderer.render(still, picture).seconds, "ms",
           "lower");
    const Timed timed = Frames(renderer, still, 30);
    Report("frames per second 4096 " + look.name + ", " + gpu.name, 1 / timed.seconds, "frames/s",
           "higher", Target(100));
  }
}

/// Two panes of glass, before the volume and within it.
void AddLayers(inr::Frame& frame)
{
  const auto pixels = static_cast<std::size_t>(frame.width) * frame.height;
  const inr::RayGeometry geometry(frame, glm::i64vec3(256));
  const glm::dvec3 middle(127.5);
  const auto inside = static_cast<float>(geometry.windowDepth(middle));
  const glm::vec4 glass(0.1f, 0.2f, 0.2f, 0.3f);
  auto layers = std::make_shared<inr::TranslucentLayers>();
  for (const float depth : {0.01f, inside}) {
    layers->layers.push_back(
        {std::vector<float>(pixels, depth), std::vector<glm::vec4>(pixels, glass)});
  }
  frame.layers = layers;
}

/// A kind of frame that kernels of its own draw.
struct Kind
{
  const char* name;
  void (*change)(inr::Frame& frame);
};

constexpr Kind Kinds[] = {
    {"lit", [](inr::Frame& frame) { frame.shading = inr::Material(); }},
    {"layered", AddLayers},
    {"surfaces",
     [](inr::Frame& frame) {
       frame.blending.mode = inr::BlendMode::Isosurface;
       frame.blending.isosurfaces = {-0.4, 0.1, 0.6};
     }},
    {"integrated", [](inr::Frame& frame) { frame.preIntegration = true; }},
};

/// Such frames through the cache, beside the CPU's.
void BenchKinds(const inr::ModelPointer& model, const Engine& gpu)
{
  const Look look = Looks(model->volume).back();
  for (const Kind& kind : Kinds) {
    inr::Image pictures[2];
    for (const Engine& engine : {gpu, Engine{"CPU", nullptr, 5, 1}}) {
      inr::Frame frame = Lit(FrameFor(model, false));
      frame.mode = inr::RenderMode::RayMarching;
      kind.change(frame);
      inr::Renderer renderer = RendererFor(model, look, engine, true);
      Frames(renderer, frame, 1); // brings the bricks
      const Timed timed = Frames(renderer, frame, engine.cachedFrames);
      Report(std::string("cached frame ") + kind.name + " " + look.name + ", " + engine.name,
             1000 * timed.seconds, "ms", "lower");
      pictures[engine.accelerator ? 0 : 1] = timed.picture;
    }
    Report(std::string("picture ") + kind.name + " " + look.name + ", the GPU's beside the CPU's",
           Likeness(pictures[0], pictures[1]), "dB", "higher", Target(50));
  }
}

void Bench(const inr::ModelPointer& model, const Engine& gpu)
{
  for (const Look& look : Looks(model->volume)) {
    for (const bool traced : {false, true}) {
      const inr::Image pictures[2] = {Compare(model, look, gpu, traced),
                                      Compare(model, look, {"CPU", nullptr, 5, 1}, traced)};
      Report(std::string("picture ") + (traced ? "PT " : "RM ") + look.name +
                 ", the GPU's beside the CPU's",
             Likeness(pictures[0], pictures[1]), "dB", "higher", Target(50));
    }
  }
}

} // namespace

int main()
{
  try {
    const inr::cuda::FoundAccelerator found = inr::cuda::FindAccelerator(0);
    if (!found.accelerator) {
      std::cerr << found.reason << "\n";
      return NoGpu;
    }
    const inr::ModelPointer model = MakeModel();
    const Engine gpu{"GPU", found.accelerator, 15, 3};
    Bench(model, gpu);
    BenchKinds(model, gpu);
    BenchLarge(model, gpu);
    return 0;
  } catch (const inr::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}

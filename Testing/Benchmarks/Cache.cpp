// SPDX-License-Identifier: BSD-3-Clause
//
// What the cache of bricks gains and keeps: scenes of one model at 512x512 on 2 threads.
//
//   bench_cache MODEL.inr NAME      prints one JSON object per line; cache.py writes the result
//   file
#include "Core/Image/Metrics.h"
#include "Core/Model/ModelFile.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Timer.h"
#include "Testing/Benchmarks/FrameScenes.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

namespace {

/// Points that the first frame asks for where no range of macro-cells is known to hold.
double PointsOfWholeBricks(const inr::ModelPointer& model, const Look& look)
{
  auto doubtful = std::make_shared<inr::Model>(*model);
  doubtful->macroCells.provenance = inr::MacroCellProvenance::File;
  inr::Renderer renderer(doubtful, Cached());
  renderer.setTransferFunction(look.function);
  inr::Image picture;
  return static_cast<double>(renderer.render(View(model->volume), picture).work.bricks.points);
}

/// Warm frames against the network alone and against one dense grid.
void CompareWithUncached(const inr::ModelPointer& model, const Look& look, const std::string& name)
{
  const std::string where = " " + look.name + ", " + name;
  inr::Frame frame = View(model->volume);
  inr::RendererOptions options = Cached();
  inr::Renderer cached(model, options);
  cached.setTransferFunction(look.function);
  inr::Image first;
  const inr::FrameStatistics cold = cached.render(frame, first);
  Report("first complete frame" + where, 1000 * cold.seconds, "ms", "lower");
  Report("part inferred of its bricks" + where,
         static_cast<double>(cold.work.bricks.points) / PointsOfWholeBricks(model, look), "",
         "lower");
  const Timed warm = Median(cached, frame, 7);
  Report("cached frame" + where, 1000 * warm.seconds, "ms", "lower");

  options.cached = false;
  inr::Renderer network(model, options);
  network.setTransferFunction(look.function);
  const Timed uncached = Median(network, frame, 1);
  Report("uncached frame" + where, 1000 * uncached.seconds, "ms", "lower");
  Report("cached vs uncached RM" + where, uncached.seconds / warm.seconds, "", "higher",
         Target(40, "uncached frame" + where));

  frame.levelOfDetailScale = 0;
  const Timed exact = Median(cached, frame, 5);
  Report("interpolation error" + where, inr::ImagePsnr(exact.picture, uncached.picture), "dB",
         "higher", Target(40));
  options = Cached();
  options.cache.precision = inr::CachePrecision::Float32;
  Timed floats;
  {
    inr::Renderer renderer(model, options);
    renderer.setTransferFunction(look.function);
    floats = Median(renderer, frame, 3);
  }
  Report("16 bit error" + where, inr::ImagePsnr(exact.picture, floats.picture), "dB", "higher");
  // A single brick as large as the volume is a dense grid; 1000 voxels keep its rows apart.
  options.cache.precision = inr::CachePrecision::Bits16;
  options.cache.brickSize = 1000;
  options.cache.bytes = std::int64_t{8} << 30;
  inr::Renderer dense(model, options);
  dense.setTransferFunction(look.function);
  const Timed grid = Median(dense, frame, 5);
  Report("dense grid frame" + where, 1000 * grid.seconds, "ms", "lower");
  Report("cached vs dense" + where, exact.seconds / grid.seconds, "", "lower",
         Target(1.3, "dense grid frame" + where));
}

/// A still picture in a window, in pieces of a tenth of a second until it is complete, beside one
/// at once; nothing of either in the cache.
void InPieces(const inr::ModelPointer& model, const Look& look, const std::string& name)
{
  const std::string where = " " + look.name + ", " + name;
  double seconds[2] = {0, 0};
  double points[2] = {0, 0};
  for (const bool inPieces : {false, true}) {
    inr::Renderer renderer(model, Cached());
    renderer.setTransferFunction(look.function);
    inr::Frame frame = View(model->volume);
    frame.timeLimit = inPieces ? 0.1 : 0;
    inr::FrameStatistics statistics;
    do {
      inr::Image picture;
      statistics = renderer.render(frame, picture);
      seconds[inPieces ? 1 : 0] += statistics.seconds;
      points[inPieces ? 1 : 0] += static_cast<double>(statistics.work.bricks.points);
    } while (!statistics.complete);
  }
  Report("complete in pieces" + where, 1000 * seconds[1], "ms", "lower");
  Report("in pieces vs at once" + where, seconds[1] / seconds[0], "", "lower",
         ", \"baseline\": \"first complete frame" + where + "\"");
  Report("points in pieces vs at once" + where, points[1] / points[0], "", "lower");
}

/// The camera goes round with a cache of an eighth of what one view wants.
void SteadyMisses(const inr::ModelPointer& model, const Look& look, const std::string& name)
{
  const std::string where = " " + look.name + ", " + name;
  inr::RendererOptions options = Cached();
  std::int64_t bricks = 0;
  std::int64_t bytes = 0;
  {
    inr::Renderer all(model, options);
    all.setTransferFunction(look.function);
    Median(all, View(model->volume), 1);
    bricks = all.cachedBricks();
  }
  const std::int64_t voxels =
      std::int64_t{options.cache.brickSize} * options.cache.brickSize * options.cache.brickSize;
  bytes = bricks / 8 * (2 * voxels + 2000);
  options.cache.bytes = std::max<std::int64_t>(bytes, 9 * (2 * voxels + 2000));
  inr::Renderer small(model, options);
  small.setTransferFunction(look.function);
  double cached = 0;
  constexpr int frames = 20;
  for (int k = 0; k < frames; ++k) {
    inr::Frame frame = View(model->volume, 30 + 2.0 * k);
    frame.timeLimit = 0.2;
    inr::Image picture;
    cached += small.render(frame, picture).seconds / frames;
  }
  inr::RendererOptions plain = options;
  plain.cached = false;
  inr::Renderer network(model, plain);
  network.setTransferFunction(look.function);
  const Timed uncached = Median(network, View(model->volume), 1);
  Report("steady-miss frame" + where, 1000 * cached, "ms", "lower");
  Report("steady-miss RM" + where, uncached.seconds / cached, "", "higher",
         Target(4.8, "uncached frame" + where));
}

/// The same view of larger and larger volumes: the first picture, and one when all is there.
void Growth(const inr::ModelPointer& model, const Look& look, const std::string& name)
{
  double smallest = 0;
  for (const std::int64_t dims : {256, 1024, 4096, 131072}) {
    const std::string where = " " + std::to_string(dims) + "^3 " + look.name + ", " + name;
    const inr::ModelPointer large = Scaled(model, glm::i64vec3(dims));
    inr::Renderer renderer(large, Cached());
    renderer.setTransferFunction(look.function);
    inr::Frame frame = View(large->volume);
    frame.timeLimit = 1e-3;
    inr::Image picture;
    Report("first image" + where, renderer.render(frame, picture).seconds, "s", "lower", Target(1));
    frame.timeLimit = 0;
    const double complete = Median(renderer, frame, 1).seconds;
    Report("first complete frame" + where, complete, "s", "lower");
    const Timed warm = Median(renderer, frame, 5);
    smallest = smallest > 0 ? smallest : warm.seconds;
    Report("frame" + where, 1000 * warm.seconds, "ms", "lower");
    Report("bricks" + where, static_cast<double>(renderer.cachedBricks()), "", "lower");
    Report("frame time growth" + where, warm.seconds / smallest, "", "lower",
           Target(1.5, "frame 256^3 " + look.name + ", " + name));
    if (dims == 4096) {
      Report("frames per second 4096 " + look.name + ", " + name, 1 / warm.seconds, "frames/s",
             "higher", Target(10));
    }
  }
}

/// Of a cold cache, frame by frame.
struct Filling
{
  std::vector<std::int64_t> bricks;
  std::vector<double> hitRates;

  /// With exactly so many bricks; nothing where no frame had them, as time decides how many come.
  std::optional<double> rateWith(std::int64_t count) const
  {
    const auto at = std::lower_bound(this->bricks.begin(), this->bricks.end(), count);
    return at != this->bricks.end() && *at == count
               ? std::optional<double>(this->hitRates[at - this->bricks.begin()])
               : std::nullopt;
  }
};

Filling Fill(const inr::ModelPointer& model, const Look& look, double degrees, bool ranked)
{
  inr::RendererOptions options = Cached();
  options.cache.ranking = ranked;
  options.cache.preloading = false;
  options.cache.background = false;
  options.cache.maximumRequests = 4;
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(look.function);
  inr::Frame frame = View(model->volume, degrees);
  frame.width = frame.height = 256;
  frame.timeLimit = 1e-9; // one batch of bricks for each frame, of as many as there is time for
  Filling filling;
  for (int k = 0; k < 40; ++k) {
    inr::Image picture;
    const std::int64_t bricks = renderer.cachedBricks(); // that the frame is drawn from
    frame.unitDistance *= 1 + 1e-12; // another picture, of which no tile waits for more
    filling.hitRates.push_back(renderer.render(frame, picture).hitRate());
    filling.bricks.push_back(bricks);
  }
  return filling;
}

/// Hit rates with the same number of bricks, with and without ranking.
void Ranking(const inr::ModelPointer& model, const Look& look, const std::string& name)
{
  const inr::ModelPointer large = Scaled(model, glm::i64vec3(1024));
  double worst = 1;
  int compared = 0;
  for (int camera = 0; camera < 5; ++camera) {
    const Filling plain = Fill(large, look, 72.0 * camera, false);
    const Filling ranked = Fill(large, look, 72.0 * camera, true);
    for (std::size_t k = 0; k < plain.bricks.size(); ++k) {
      if (const auto rate = ranked.rateWith(plain.bricks[k])) {
        worst = std::min(worst, *rate - plain.hitRates[k]);
        ++compared;
      }
    }
    Report("hit rate after 40 batches, camera " + std::to_string(camera) + " " + look.name + ", " +
               name,
           ranked.hitRates.back(), "", "higher",
           ", \"note\": \"without ranking " + std::to_string(plain.hitRates.back()) + "\"");
  }
  Report("smallest gain of ranking " + look.name + ", " + name, worst, "", "higher",
         Target(0) + ", \"note\": \"at " + std::to_string(compared) + " numbers of bricks\"");
}

/// What a user sees who turns a cold 4096^3 volume by ten degrees a second, with 20 ms between a
/// frame and the next.
void Interaction(const inr::ModelPointer& model, const Look& look, const std::string& name,
                 bool background)
{
  constexpr double duration = 6;
  const inr::ModelPointer large = Scaled(model, glm::i64vec3(4096));
  inr::RendererOptions options = Cached();
  options.cache.background = background;
  inr::Renderer renderer(large, options);
  renderer.setTransferFunction(look.function);
  std::vector<double> times;
  double hits = 0;
  inr::Image picture;
  const inr::Timer clock;
  while (clock.seconds() < duration) {
    inr::Frame frame = View(large->volume, 30 + 10 * clock.seconds());
    frame.width = frame.height = Size / 8; // as the mapper does when it has to be quick,
    frame.levelOfDetailScale = 1.0 / 8;    // but wanting all that the window could show
    frame.timeLimit = 1.0 / 30;
    const inr::FrameStatistics statistics = renderer.render(frame, picture);
    times.push_back(statistics.seconds);
    hits += statistics.hitRate();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::sort(times.begin(), times.end());
  const std::string where = std::string(background ? " with" : " without") +
                            " background loading, " + look.name + ", " + name;
  Report("interactive frame" + where, 1000 * times[times.size() / 2], "ms", "lower");
  Report("slowest interactive frame" + where, 1000 * times.back(), "ms", "lower");
  Report("bricks mapped" + where, static_cast<double>(renderer.cachedBricks()) / duration,
         "bricks/s", "higher");
  Report("interactive hit rate" + where, hits / static_cast<double>(times.size()), "", "higher");
}

/// From a new transfer function to new majorants.
void TransferFunctionChange(const inr::ModelPointer& model, const Look& look)
{
  for (const int edge : {16, 1}) { // 4096 cells, 16.8 million
    auto changed = std::make_shared<inr::Model>(*model);
    changed->volume.dims = glm::i64vec3(256);
    changed->macroCells = inr::MakeMacroCells(changed->volume.dims, edge);
    for (std::size_t k = 0; k < changed->macroCells.ranges.size(); ++k) {
      const float low = static_cast<float>(k % 977) / 977;
      changed->macroCells.ranges[k] = {low, std::min(1.0f, low + 0.2f)};
    }
    inr::Renderer renderer(changed, Cached());
    const inr::Timer timer;
    renderer.setTransferFunction(look.function);
    const double seconds = timer.seconds();
    const auto cells = static_cast<double>(changed->macroCells.ranges.size());
    Report("majorants of " + std::to_string(changed->macroCells.ranges.size()) + " cells",
           1000 * seconds, "ms", "lower", Target(100));
    Report("majorant rate, " + std::to_string(changed->macroCells.ranges.size()) + " cells",
           cells / seconds / 1e6, "M cells/s", "higher");
  }
}

} // namespace

int main(int argc, char* argv[])
{
  const std::string part = argc == 4 ? argv[3] : "all";
  const bool all = part == "all";
  if (argc < 3 || argc > 4 || !(all || part == "frames" || part == "interaction")) {
    std::cerr << "usage: bench_cache MODEL.inr NAME [frames | interaction]\n";
    return 2;
  }
  const inr::ModelPointer model = inr::ReadModel(argv[1]);
  const std::vector<Look> looks = Looks(model->volume);
  if (all || part == "frames") {
    for (const Look& look : looks) {
      CompareWithUncached(model, look, argv[2]);
      InPieces(model, look, argv[2]);
      SteadyMisses(model, look, argv[2]);
    }
    TransferFunctionChange(model, looks.front());
  }
  if (all || part == "interaction") {
    for (const Look& look : looks) {
      Interaction(model, look, argv[2], false);
      Interaction(model, look, argv[2], true);
    }
  }
  if (all) {
    for (const Look& look : looks) {
      Ranking(model, look, argv[2]);
    }
    Growth(model, looks.front(), argv[2]);
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
//
// What the cache of bricks gains for path tracing: one model at 512x512 on 2 threads.
//
//   bench_paths MODEL.inr NAME      prints one JSON object per line; cache.py writes the result
//   file
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"

namespace {

/// The lit view; one path through each pixel.
inr::Frame Lit(const inr::VolumeInfo& volume, double degrees = 30)
{
  inr::Frame frame = ::Lit(View(volume, degrees));
  frame.samplesPerPixel = 1;
  return frame;
}

/// Seconds for one path through each pixel: the median over `frames` different ones.
double Seconds(inr::Renderer& renderer, inr::Frame frame, int frames)
{
  std::vector<double> times;
  for (int k = 0; k < frames; ++k) {
    frame.frameIndex = static_cast<std::uint64_t>(k);
    inr::Image picture;
    times.push_back(renderer.render(frame, picture).seconds);
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

/// Renders other paths until a few frames in a row have asked for no further brick.
void Converge(inr::Renderer& renderer, inr::Frame frame)
{
  constexpr std::uint64_t others = 1000;
  constexpr int most = 60;
  int quiet = 0;
  for (std::uint64_t k = others; quiet < 4 && k < others + most; ++k) {
    const std::int64_t before = renderer.cachedBricks();
    frame.frameIndex = k;
    inr::Image picture;
    renderer.render(frame, picture);
    quiet = renderer.cachedBricks() == before ? quiet + 1 : 0;
  }
}

double Uncached(const inr::ModelPointer& model, const Look& look, const std::string& where)
{
  inr::RendererOptions options = Cached();
  options.cached = false;
  inr::Renderer network(model, options);
  network.setTransferFunction(look.function);
  const double seconds = Seconds(network, Lit(model->volume), 1);
  Report("uncached path frame" + where, 1000 * seconds, "ms", "lower");
  return seconds;
}

/// Converged frames against the network alone; how many bricks they want.
std::int64_t CompareWithUncached(const inr::ModelPointer& model, const Look& look, double uncached,
                                 const std::string& where)
{
  inr::Renderer cached(model, Cached());
  cached.setTransferFunction(look.function);
  const inr::Frame frame = Lit(model->volume);
  inr::Image first;
  Report("first path frame" + where, 1000 * cached.render(frame, first).seconds, "ms", "lower");
  Converge(cached, frame);
  const double warm = Seconds(cached, frame, 9);
  Report("cached path frame" + where, 1000 * warm, "ms", "lower");
  Report("cached vs uncached PT" + where, uncached / warm, "", "higher",
         Target(10, "uncached path frame" + where));
  return cached.cachedBricks();
}

/// Seconds of a frame while the camera goes round with a cache of an eighth of what a view wants.
double Flight(const inr::ModelPointer& model, const Look& look, std::int64_t bricks,
              double timeLimit)
{
  inr::RendererOptions options = Cached();
  const std::int64_t side = options.cache.brickSize;
  options.cache.bytes = std::max<std::int64_t>(bricks / 8, 9) * (2 * side * side * side + 2000);
  inr::Renderer small(model, options);
  small.setTransferFunction(look.function);
  constexpr int frames = 10;
  double seconds = 0;
  for (int k = -3; k < frames; ++k) { // the first ones fill the cache
    inr::Frame frame = Lit(model->volume, 30 + 2.0 * k);
    frame.timeLimit = timeLimit;
    inr::Image picture;
    const double taken = small.render(frame, picture).seconds;
    seconds += k < 0 ? 0 : taken / frames;
  }
  return seconds;
}

/// With a fifth of a second for each frame, as for ray marching, and with complete frames.
void SteadyMisses(const inr::ModelPointer& model, const Look& look, std::int64_t bricks,
                  double uncached, const std::string& where)
{
  const std::string baseline = "uncached path frame" + where;
  const double timed = Flight(model, look, bricks, 0.2);
  Report("steady-miss path frame" + where, 1000 * timed, "ms", "lower");
  Report("steady-miss PT" + where, uncached / timed, "", "higher", Target(2, baseline));
  const double complete = Flight(model, look, bricks, 0);
  Report("steady-miss complete path frame" + where, 1000 * complete, "ms", "lower");
  Report("steady-miss complete PT" + where, uncached / complete, "", "higher", Target(2, baseline));
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3) {
    std::cerr << "usage: bench_paths MODEL.inr NAME\n";
    return 2;
  }
  const inr::ModelPointer model = inr::ReadModel(argv[1]);
  for (const Look& look : Looks(model->volume)) {
    const std::string where = " " + look.name + ", " + argv[2];
    const double uncached = Uncached(model, look, where);
    const std::int64_t bricks = CompareWithUncached(model, look, uncached, where);
    SteadyMisses(model, look, bricks, uncached, where);
  }
  return 0;
}

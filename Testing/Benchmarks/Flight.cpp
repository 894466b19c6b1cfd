// SPDX-License-Identifier: BSD-3-Clause
//
// Many frames in a row, each within its time: what a user sees while the cache fills.
//
//   bench_flight MODEL.inr NAME flight FRAMES     through a volume of 4096^3: memory and holes
//   bench_flight MODEL.inr NAME protocol FRAMES   one view of the volume scaled by 4: frame times
//
// prints one JSON object per line; flight.py writes the result file.
#include "Core/Model/ModelFile.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Benchmarks/FrameScenes.h"

#include <cmath>
#include <fstream>
#include <string>

namespace {

constexpr double FrameLimit = 0.1; ///< seconds

double ResidentMebibytes()
{
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  double resident = 0;
  file >> pages >> resident;
  return resident * 4096 / (1 << 20);
}

/// From outside through the middle of the volume and round, looking ahead.
inr::Frame Waypoint(const inr::VolumeInfo& volume, double part)
{
  constexpr double turn = 6.283185307179586;
  const glm::dvec3 extent(volume.dims);
  const auto place = [&](double at) {
    const double angle = turn * at;
    return extent * (0.5 + glm::dvec3(0.9 * std::cos(angle), 0.25 * std::sin(3 * angle),
                                      0.45 * std::sin(2 * angle)));
  };
  inr::Frame frame = View(volume);
  frame.width = frame.height = 192;
  frame.sampleDistance = 4; // as while the mouse moves
  frame.clipToWorld = glm::inverse(
      glm::perspective(glm::radians(60.0), 1.0, 1e-3 * extent.x, 4 * extent.x) *
      glm::lookAt(place(part), 0.3 * extent + 0.4 * place(part + 0.05), glm::dvec3(0, 1, 0)));
  frame.timeLimit = 1.0 / 30;
  return frame;
}

/// Rays that met the volume, which this transfer function makes visible everywhere, and left no
/// trace in the picture.
std::int64_t Holes(const inr::Image& picture, const inr::FrameStatistics& statistics)
{
  std::int64_t seen = 0;
  for (std::size_t k = 3; k < picture.pixels.size(); k += 4) {
    seen += picture.pixels[k] > 0 ? 1 : 0;
  }
  return statistics.rays - seen;
}

void Fly(const inr::ModelPointer& large, const std::string& name, int frames)
{
  inr::RendererOptions options = Cached();
  options.cache.bytes = std::int64_t{64} << 20; // fills on the way
  inr::Renderer renderer(large, options);
  renderer.setTransferFunction(Looks(large->volume)[1].function);
  double hits = 0;
  double warm = 0;
  double most = 0;
  std::int64_t holes = 0;
  std::vector<double> seconds;
  inr::Image picture;
  for (int k = 0; k < frames; ++k) {
    const inr::FrameStatistics statistics =
        renderer.render(Waypoint(large->volume, static_cast<double>(k) / frames), picture);
    seconds.push_back(statistics.seconds);
    holes += Holes(picture, statistics) > 0 ? 1 : 0;
    hits += statistics.hitRate() / frames;
    const double memory = ResidentMebibytes();
    warm = k < frames / 4 ? std::max(warm, memory) : warm;
    most = std::max(most, memory);
    if (k % (frames / 40 + 1) == 0) {
      std::cerr << k << " of " << frames << " frames, " << memory << " MiB\n";
    }
  }
  std::sort(seconds.begin(), seconds.end());
  const std::string where = ", flight of " + std::to_string(frames) + " frames, " + name;
  Report("frames with a hole" + where, static_cast<double>(holes), "", "lower", Target(0));
  Report("largest memory" + where, most, "MiB", "lower");
  Report("growth of memory after a quarter" + where, most - warm, "MiB", "lower");
  Report("mean hit rate" + where, hits, "", "higher");
  Report("median frame" + where, 1000 * seconds[seconds.size() / 2], "ms", "lower");
  Report("slowest of a hundred" + where, 1000 * seconds[seconds.size() * 99 / 100], "ms", "lower");
}

std::string List(const std::vector<double>& values)
{
  std::ostringstream text;
  text.precision(4);
  for (const double value : values) {
    text << (text.tellp() > 0 ? ", " : "[") << value;
  }
  return text.str() + "]";
}

/// The frames of one view from an empty cache on.
void Watch(const inr::ModelPointer& model, const Look& look, const std::string& what,
           const inr::RendererOptions& options, int frames, const std::string& name)
{
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(look.function);
  inr::Frame frame = View(model->volume);
  frame.timeLimit = FrameLimit;
  std::vector<double> march;
  std::vector<double> hits;
  double last = 0;
  const int counted = std::min(200, frames);
  for (int k = 0; k < frames; ++k) {
    inr::Image picture;
    frame.frameIndex = static_cast<std::uint64_t>(k); // else only what has changed is marched
    const inr::FrameStatistics statistics = renderer.render(frame, picture);
    march.push_back(1000 * statistics.marchSeconds);
    hits.push_back(statistics.hitRate());
    last += k >= frames - counted ? march.back() / counted : 0.0;
  }
  const std::string where = ", " + what + ", " + look.name + " x4, " + name;
  Report("mean of the last frames" + where, last, "ms", "lower", ", \"series\": " + List(march));
  Report("hit rate at the end" + where, hits.back(), "", "higher", ", \"series\": " + List(hits));
}

void RunProtocol(const inr::ModelPointer& model, const std::string& name, int frames)
{
  const inr::ModelPointer large = Scaled(model, model->volume.dims * std::int64_t{4});
  for (const Look& look : Looks(large->volume)) {
    inr::RendererOptions options = Cached();
    Watch(large, look, "cache", options, frames, name);
    options.cache.ranking = false;
    Watch(large, look, "cache without ranking", options, frames, name);
    options.cache.ranking = true;
    options.cache.preloading = false;
    Watch(large, look, "cache without preloading", options, frames, name);
    options.cached = false;
    Watch(large, look, "network only", options, 1, name);
  }
}

} // namespace

int main(int argc, char* argv[])
{
  const std::string mode = argc == 5 ? argv[3] : "";
  const int frames = argc == 5 ? std::atoi(argv[4]) : 0;
  if ((mode != "flight" && mode != "protocol") || frames < 1) {
    std::cerr << "usage: bench_flight MODEL.inr NAME flight|protocol FRAMES\n";
    return 2;
  }
  const inr::ModelPointer model = inr::ReadModel(argv[1]);
  if (mode == "flight") {
    Fly(Scaled(model, glm::i64vec3(4096)), argv[2], frames);
  } else {
    RunProtocol(model, argv[2], frames);
  }
  return 0;
}

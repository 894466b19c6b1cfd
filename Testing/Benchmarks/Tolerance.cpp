// SPDX-License-Identifier: BSD-3-Clause
//
// What a tolerance of errors promises, keeps and saves, beside levels chosen by distance.
//
//   bench_tolerance MODEL.inr NAME TIMES
//
// of the volume with TIMES as many voxels along every axis, prints one JSON object per line;
// tolerance.py writes the result file. The reference of all pictures has every sample, from voxels
// of level 0 in float32 (reference A). Everything is decoded before anything is timed.
#include "Core/Image/Metrics.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Core/Image/PixelDifferences.h"

#include <cmath>
#include <ctime>
#include <limits>
#include <optional>

namespace {

constexpr int Frames = 3;

struct Shown
{
  inr::Image picture;
  double psnr;
  double samples;
  double milliseconds; ///< processor time of a frame, the least of some
};

class Scene
{
public:
  Scene(const inr::ModelPointer& model, const Look& look, std::string name)
      : Name(std::move(name)), Renderer(model, Cached()), Picture(View(model->volume))
  {
    this->Renderer.setTransferFunction(look.function);
    inr::RendererOptions exact = Cached();
    exact.cache.precision = inr::CachePrecision::Float32;
    inr::Renderer reference(model, exact);
    reference.setTransferFunction(look.function);
    inr::Frame frame = this->Picture;
    frame.errorTolerance = 0;
    reference.render(frame, this->Truth);
    this->Exact = this->show(frame);
  }

  void compare()
  {
    Report("exact frame, " + this->Name, this->Exact.milliseconds, "ms", "lower");
    Report("samples of the exact frame, " + this->Name, this->Exact.samples, "", "lower");
    this->reportDistance(1, "default");
    for (double scale = 0.125; scale < 9; scale *= std::sqrt(2.0)) {
      this->ByDistance.emplace_back(scale, this->showByDistance(scale));
    }
    for (const double tolerance : {1.0, 2.0, 4.0, 8.0}) {
      this->compareAt(tolerance);
    }
  }

private:
  Shown show(const inr::Frame& frame)
  {
    inr::Image first;
    this->Renderer.render(frame, first);
    Shown shown{{}, 0, 0, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < Frames; ++k) {
      const std::clock_t start = std::clock();
      const inr::FrameStatistics statistics = this->Renderer.render(frame, shown.picture);
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      shown.milliseconds = std::min(shown.milliseconds, 1000 * seconds);
      shown.samples = static_cast<double>(statistics.samples);
    }
    shown.psnr = inr::ImagePsnr(shown.picture, this->Truth);
    return shown;
  }

  Shown showByDistance(double scale)
  {
    inr::Frame frame = this->Picture;
    frame.levelOfDetailScale = scale;
    return this->show(frame);
  }

  void reportDistance(double scale, const std::string& what)
  {
    const Shown shown = this->showByDistance(scale);
    const std::string where = ", by distance, " + what + ", " + this->Name;
    Report("frame" + where, shown.milliseconds, "ms", "lower");
    Report("samples" + where, shown.samples, "", "lower");
    Report("PSNR" + where, shown.psnr, "dB", "higher");
  }

  void compareAt(double tolerance)
  {
    inr::Frame frame = this->Picture;
    frame.errorTolerance = tolerance;
    const Shown shown = this->show(frame);
    std::ostringstream text;
    text << ", tolerance " << tolerance << ", " << this->Name;
    const std::string where = text.str();
    const std::vector<float> differences = PixelDifferences(shown.picture, this->Truth);
    Report("tolerance held pixels" + where, ShareWithin(tolerance, differences), "", "higher",
           Target(0.999));
    Report("99.9 % of pixels are within" + where,
           differences.empty() ? 0 : differences[differences.size() * 999 / 1000], "1/255",
           "lower");
    Report("samples as part of the exact frame's" + where, shown.samples / this->Exact.samples, "",
           "lower");
    Report("frame" + where, shown.milliseconds, "ms", "lower");
    Report("PSNR" + where, shown.psnr, "dB", "higher");
    this->compareAtEqualTime(shown, where);
  }

  /// With the best picture by distance among those whose frames take no longer, and the one whose
  /// frame is next slower.
  void compareAtEqualTime(const Shown& shown, const std::string& where)
  {
    double best = 0;
    double bestScale = 0;
    double nextSlower = std::numeric_limits<double>::infinity();
    double nextPsnr = 0;
    for (const auto& [scale, tried] : this->ByDistance) {
      if (tried.milliseconds <= shown.milliseconds && tried.psnr > best) {
        best = tried.psnr;
        bestScale = scale;
      } else if (tried.milliseconds > shown.milliseconds && tried.milliseconds < nextSlower) {
        nextSlower = tried.milliseconds;
        nextPsnr = tried.psnr;
      }
    }
    std::ostringstream note;
    note << ", \"note\": \"best by distance in the time: scale " << bestScale << ", " << best
         << " dB; next slower: " << nextSlower << " ms, " << nextPsnr << " dB\"";
    Report("PSNR gain vs distance LoD" + where, shown.psnr - std::max(best, nextPsnr), "dB",
           "higher", Target(3) + note.str());
  }

  std::string Name;
  inr::Renderer Renderer;
  inr::Frame Picture;
  inr::Image Truth;
  Shown Exact;
  std::vector<std::pair<double, Shown>> ByDistance; ///< pictures of some scales
};

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 4) {
    std::cerr << "usage: bench_tolerance MODEL.inr NAME TIMES\n";
    return 2;
  }
  const inr::ModelPointer own = inr::ReadModel(argv[1]);
  const inr::ModelPointer model = Scaled(own, own->volume.dims * std::int64_t{std::atoi(argv[3])});
  for (const Look& look : Looks(model->volume)) {
    Scene(model, look, look.name + ", " + argv[2]).compare();
  }
  return 0;
}

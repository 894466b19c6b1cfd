// SPDX-License-Identifier: BSD-3-Clause
//
// What a tolerance of errors promises, keeps and saves, beside levels chosen by distance.
//
//   bench_tolerance MODEL.inr NAME TIMES PIXELS
//
// of the volume with TIMES as many voxels along every axis, in pictures of so many PIXELS across,
// prints one JSON object per line; tolerance.py writes the result file. The reference of all
// pictures has every sample at the same distance, from voxels of level 0 in float32: a tolerance
// promises nothing of the distance. (Reference A of bench_tradeoff has four times as many samples.)
// But for first pictures, everything is decoded before anything is timed.
#include "Core/Image/Metrics.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Core/Image/PixelDifferences.h"

#include <cmath>
#include <ctime>
#include <limits>
#include <optional>

namespace {

constexpr int Frames = 4;

struct Shown
{
  inr::Image picture;
  double psnr;
  double samples;
  double milliseconds; ///< processor time of a frame, the least of some
};

struct Priced
{
  double cost;
  double psnr;
};

/// What the best of some pictures have at a cost: between two of them, as if those in between were
/// on a line over the cost's logarithm.
double PsnrAt(double cost, std::vector<Priced> pictures)
{
  std::sort(pictures.begin(), pictures.end(),
            [](const Priced& a, const Priced& b) { return a.cost < b.cost; });
  Priced cheaper = pictures.front();
  for (const Priced& next : pictures) {
    if (next.psnr <= cheaper.psnr) {
      continue;
    }
    if (next.cost > cost) {
      const double way = std::log(next.cost / cheaper.cost);
      const double part = way > 0 ? std::clamp(std::log(cost / cheaper.cost) / way, 0.0, 1.0) : 0.0;
      return cheaper.psnr + part * (next.psnr - cheaper.psnr);
    }
    cheaper = next;
  }
  return cheaper.psnr;
}

class Scene
{
public:
  Scene(const inr::ModelPointer& model, const Look& look, std::string name, int pixels)
      : Name(std::move(name)), Model(model), Function(look.function), Renderer(model, Cached()),
        Picture(View(model->volume))
  {
    this->Picture.width = this->Picture.height = pixels;
    this->Picture.sampleDistance = inr::Frame{}.sampleDistance;
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
    this->reportFirst(0);
    this->reportFirst(1);
    this->reportDistance(1, "default");
    for (int octave = -4; octave <= 6; ++octave) { // halves of them
      const double scale = std::exp2(0.5 * octave);
      for (const bool adaptive : {true, false}) {
        this->ByDistance.push_back(this->showByDistance(scale, adaptive));
      }
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

  /// With nothing decoded or measured before: of a model of its own, whose bricks nobody keeps.
  void reportFirst(double tolerance)
  {
    inr::Renderer renderer(std::make_shared<inr::Model>(*this->Model), Cached());
    renderer.setTransferFunction(this->Function);
    inr::Frame frame = this->Picture;
    frame.errorTolerance = tolerance;
    inr::Image picture;
    const std::clock_t start = std::clock();
    renderer.render(frame, picture);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::ostringstream text;
    text << "first picture, tolerance " << tolerance << ", " << this->Name;
    Report(text.str(), 1000 * seconds, "ms", "lower");
  }

  Shown showByDistance(double scale, bool adaptive)
  {
    inr::Frame frame = this->Picture;
    frame.levelOfDetailScale = scale;
    frame.adaptiveSampling = adaptive;
    return this->show(frame);
  }

  void reportDistance(double scale, const std::string& what)
  {
    const Shown shown = this->showByDistance(scale, true);
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
    this->compareAtEqualCost(shown, where);
  }

  /// With what distance gives in the same time, and with as many samples.
  void compareAtEqualCost(const Shown& shown, const std::string& where)
  {
    const auto report = [&](const std::string& what, const auto& costOf,
                            const std::string& target) {
      std::vector<Priced> others;
      for (const Shown& other : this->ByDistance) {
        others.push_back({costOf(other), other.psnr});
      }
      const double same = PsnrAt(costOf(shown), others);
      std::ostringstream note;
      note << ", \"note\": \"by distance: " << same << " dB\"";
      Report("PSNR gain vs distance LoD" + what + where, shown.psnr - same, "dB", "higher",
             target + note.str());
    };
    report(
        "", [](const Shown& picture) { return picture.milliseconds; }, Target(3));
    report(
        " at equal samples", [](const Shown& picture) { return picture.samples; }, "");
  }

  std::string Name;
  inr::ModelPointer Model;
  inr::TransferFunction Function;
  inr::Renderer Renderer;
  inr::Frame Picture;
  inr::Image Truth;
  Shown Exact;
  std::vector<Shown> ByDistance; ///< at many scales, with AdaptiveSampling and without
};

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 5) {
    std::cerr << "usage: bench_tolerance MODEL.inr NAME TIMES PIXELS\n";
    return 2;
  }
  const inr::ModelPointer own = inr::ReadModel(argv[1]);
  const inr::ModelPointer model = Scaled(own, own->volume.dims * std::int64_t{std::atoi(argv[3])});
  for (const Look& look : Looks(model->volume)) {
    Scene(model, look, look.name + ", " + argv[2], std::atoi(argv[4])).compare();
  }
  return 0;
}

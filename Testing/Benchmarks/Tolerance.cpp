// SPDX-License-Identifier: BSD-3-Clause
//
// What a tolerance of errors promises, keeps and saves, beside levels chosen by distance.
//
//   bench_tolerance MODEL.inr NAME TIMES PIXELS
//
// of the volume with TIMES as many voxels along every axis, in pictures of so many PIXELS across,
// prints one JSON object per line; tolerance.py writes the result file. Reference A of all pictures
// has every sample at the same distance, from voxels of level 0 in float32: a tolerance promises
// nothing of the distance. The converged reference A, as in bench_tradeoff, has samples an eighth
// of a voxel apart; what the distance costs is the exact frame's difference from it. But for first
// pictures, everything is decoded before anything is timed. What is said of equal times is from
// frames in turn; see InTurn.h.
#include "Core/Image/Metrics.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Benchmarks/InTurn.h"
#include "Testing/Core/Image/PixelDifferences.h"

#include <cmath>
#include <limits>
#include <optional>

namespace {

constexpr int Frames = 2;       ///< for a rough idea of the time
constexpr int Rounds = 7;       ///< in turn
constexpr std::size_t Near = 5; ///< rivals that frames are drawn in turn with
constexpr double ConvergedStep = 0.125;
constexpr double EqualPictures = 200; ///< dB, that stand for infinity

struct Shown
{
  inr::Frame frame;
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

/// Those next to a time, of the ones that none is better than in nine tenths of their time.
std::vector<const Shown*> Rivals(const std::vector<Shown>& all, double milliseconds)
{
  std::vector<const Shown*> rivals;
  for (const Shown& one : all) {
    const bool beaten = std::any_of(all.begin(), all.end(), [&](const Shown& other) {
      return other.psnr >= one.psnr && other.milliseconds < 0.9 * one.milliseconds;
    });
    if (!beaten) {
      rivals.push_back(&one);
    }
  }
  const auto away = [&](const Shown* one) {
    return std::abs(std::log(one->milliseconds / milliseconds));
  };
  std::sort(rivals.begin(), rivals.end(),
            [&](const Shown* a, const Shown* b) { return away(a) < away(b); });
  rivals.resize(std::min(rivals.size(), Near));
  return rivals;
}

class Scene
{
public:
  Scene(const inr::ModelPointer& model, const Look& look, std::string name, int pixels)
      : Name(std::move(name)), Model(model), Function(look.function), Renderer(model, Unrounded()),
        Picture(View(model->volume))
  {
    this->Picture.width = this->Picture.height = pixels;
    this->Picture.sampleDistance = inr::Frame{}.sampleDistance;
    this->Renderer.setTransferFunction(look.function);
    inr::RendererOptions exact = Unrounded();
    exact.cache.precision = inr::CachePrecision::Float32;
    inr::Renderer reference(model, exact);
    reference.setTransferFunction(look.function);
    inr::Frame frame = this->Picture;
    frame.errorTolerance = 0;
    reference.render(frame, this->Truth);
    this->Exact = this->show(frame);
    frame.sampleDistance = ConvergedStep;
    reference.render(frame, this->Converged);
  }

  void compare()
  {
    Report("exact frame, " + this->Name, this->Exact.milliseconds, "ms", "lower");
    Report("samples of the exact frame, " + this->Name, this->Exact.samples, "", "lower");
    this->reportConverged(this->Exact.picture, ", exact frame, " + this->Name);
    this->reportFirst(0);
    this->reportFirst(1);
    this->reportDistance(1, "default");
    for (int octave = -4; octave <= 6; ++octave) { // halves of them
      const double scale = std::exp2(0.5 * octave);
      for (const bool adaptive : {true, false}) {
        this->ByDistance.push_back(this->showByDistance(scale, adaptive));
      }
    }
    for (const double tolerance : {2.0, 8.0, 16.0, 32.0, 64.0}) {
      this->compareAt(tolerance);
    }
  }

private:
  Shown show(const inr::Frame& frame)
  {
    inr::Image first;
    this->Renderer.render(frame, first);
    Shown shown{frame, {}, 0, 0, std::numeric_limits<double>::infinity()};
    shown.samples = static_cast<double>(this->Renderer.render(frame, shown.picture).samples);
    for (int k = 0; k < Frames; ++k) {
      shown.milliseconds =
          std::min(shown.milliseconds, 1000 * ProcessorSecondsOf(this->Renderer, frame));
    }
    shown.psnr = std::min(EqualPictures, inr::ImagePsnr(shown.picture, this->Truth));
    return shown;
  }

  /// With nothing decoded or measured before: of a model of its own, whose bricks nobody keeps.
  void reportFirst(double tolerance)
  {
    inr::Renderer renderer(std::make_shared<inr::Model>(*this->Model), Unrounded());
    renderer.setTransferFunction(this->Function);
    inr::Frame frame = this->Picture;
    frame.errorTolerance = tolerance;
    const double seconds = ProcessorSecondsOf(renderer, frame);
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
    this->reportConverged(shown.picture, where);
  }

  void reportConverged(const inr::Image& picture, const std::string& where) const
  {
    Report("PSNR against the converged reference A" + where,
           inr::ImagePsnr(picture, this->Converged), "dB", "higher");
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
    this->reportConverged(shown.picture, where);
    const Spread part = SpreadOf(RatiosInTurn(this->Renderer, frame, this->Exact.frame, Rounds));
    Report("time as part of the exact frame's" + where, part.median, "", "lower",
           part.json() + this->inTurn());
    this->compareAtEqualSamples(shown, where);
    this->compareAtEqualTime(shown, where);
  }

  void compareAtEqualSamples(const Shown& shown, const std::string& where)
  {
    std::vector<Priced> others;
    for (const Shown& other : this->ByDistance) {
      others.push_back({other.samples, other.psnr});
    }
    const double same = PsnrAt(shown.samples, others);
    std::ostringstream note;
    note << ", \"note\": \"by distance: " << same << " dB\"";
    Report("PSNR gain vs distance LoD at equal samples" + where, shown.psnr - same, "dB", "higher",
           note.str());
  }

  /// With what distance gives in the same time: by the medians of the times of rivals whose frames
  /// were drawn in turn with this one's, and, as far as that is sure, by their quartiles.
  void compareAtEqualTime(const Shown& shown, const std::string& where)
  {
    std::vector<Priced> others[3];
    std::ostringstream rivals;
    for (const Shown* rival : Rivals(this->ByDistance, shown.milliseconds)) {
      const Spread time = SpreadOf(RatiosInTurn(this->Renderer, rival->frame, shown.frame, Rounds));
      others[0].push_back({time.low, rival->psnr});
      others[1].push_back({time.median, rival->psnr});
      others[2].push_back({time.high, rival->psnr});
      rivals << (rivals.str().empty() ? "" : ", ")
             << "{\"scale\": " << rival->frame.levelOfDetailScale
             << ", \"adaptive\": " << (rival->frame.adaptiveSampling ? "true" : "false")
             << ", \"psnr\": " << rival->psnr << ", \"time\": " << time.median << time.json()
             << "}";
    }
    const auto gain = [&](int by) { return shown.psnr - PsnrAt(1.0, others[by]); };
    const Spread gains{gain(0), gain(1), gain(2)};
    Report("PSNR gain vs distance LoD" + where, gains.median, "dB", "higher",
           Target(3) + gains.json() + ", \"rivals\": [" + rivals.str() + "]" + this->inTurn());
  }

  static std::string inTurn()
  {
    return ", \"note\": \"median and quartiles of " + std::to_string(Rounds) +
           " frames in turn, processor time\"";
  }

  std::string Name;
  inr::ModelPointer Model;
  inr::TransferFunction Function;
  inr::Renderer Renderer;
  inr::Frame Picture;
  inr::Image Truth; ///< reference A
  inr::Image Converged;
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

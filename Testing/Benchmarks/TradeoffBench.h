// SPDX-License-Identifier: BSD-3-Clause
//
// Times and errors of bench_tradeoff's points.
#pragma once

#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Benchmarks/TradeoffKnobs.h"
#include "Testing/Benchmarks/TradeoffScenes.h"

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

inline double ProcessorSeconds()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The least disturbed.
inline double Fastest(const std::vector<double>& seconds)
{
  return *std::min_element(seconds.begin(), seconds.end());
}

/// A renderer that shares bricks with none before.
inline inr::Renderer Fresh(const inr::ModelPointer& model, const inr::RendererOptions& options,
                           const Scene& scene)
{
  inr::Renderer renderer(std::make_shared<inr::Model>(*model), options);
  renderer.setTransferFunction(scene.function);
  return renderer;
}

/// Measures points of one scene beside its default settings.
class Bench
{
public:
  Bench(const Subject& subject, const Scene& scene, References references)
      : Given(subject), Shown(scene), Compared(std::move(references)),
        Usual(subject.usual, Cached())
  {
    this->Usual.setTransferFunction(scene.function);
    this->Usual.render(scene.frame, this->UsualPicture);
    inr::Renderer fresh = Fresh(subject.usual, Cached(), scene);
    const double start = ProcessorSeconds();
    inr::Image picture;
    fresh.render(scene.frame, picture);
    this->UsualFilling = ProcessorSeconds() - start;
    const std::int64_t side = Cached().cache.brickSize;
    this->Wanted = fresh.cachedBricks() * (2 * side * side * side + 2000);
  }

  /// Bytes of the bricks that the view wants.
  std::int64_t wanted() const { return this->Wanted; }

  const References& references() const { return this->Compared; }

  /// `part`: what the points are part of.
  void measure(const std::vector<Point>& points, const std::string& part)
  {
    for (const Point& point : points) {
      Record record(this->Shown.name + ", " + point.knob + " " + point.setting);
      record.add("part", part).add("scene", this->Shown.name);
      record.add("knob", point.knob).add("setting", point.setting);
      this->measure(point, record);
      record.print();
    }
  }

private:
  void measure(const Point& point, Record& record)
  {
    if (point.fromEmpty) {
      this->startEarly(point, record);
      inr::Renderer renderer = Fresh(this->Given.model, point.options, this->Shown);
      this->fill(renderer, point.frame, record);
      this->compareFrames(renderer, point.frame, record);
    } else {
      this->compareFrames(this->sharing(point.options), point.frame, record);
    }
  }

  /// The first complete picture from an empty cache, and what is in the cache then.
  void fill(inr::Renderer& renderer, const inr::Frame& frame, Record& record) const
  {
    const std::int64_t before = this->Usual.cacheBytes();
    inr::Image picture;
    const double start = ProcessorSeconds();
    renderer.render(frame, picture);
    record.add("first_cpu_ms", 1000 * (ProcessorSeconds() - start));
    record.add("default_first_cpu_ms", 1000 * this->UsualFilling);
    record.add("cache_mib", static_cast<double>(renderer.cacheBytes() - before) / (1 << 20));
    record.add("bricks", static_cast<double>(renderer.cachedBricks()));
  }

  /// Frames in a limited time, counted, until half of the processor time is spent in which the
  /// default settings complete theirs: how much of the last one is at its level.
  void startEarly(const Point& point, Record& record) const
  {
    inr::RendererOptions options = point.options;
    options.deterministic = true;
    inr::Renderer renderer = Fresh(this->Given.model, options, this->Shown);
    inr::Frame frame = point.frame;
    frame.timeLimit = 0.1;
    inr::FrameStatistics statistics;
    inr::Image picture;
    const double start = ProcessorSeconds();
    do {
      statistics = renderer.render(frame, picture);
    } while (!statistics.complete && ProcessorSeconds() - start < this->UsualFilling / 2);
    record.add("early_hit_rate", statistics.hitRate());
    record.add("early_psnr_a", std::min(EqualPictures, inr::ImagePsnr(this->Compared.a, picture)));
  }

  /// The picture, and complete frames of other seeds in turn with those of the default settings.
  void compareFrames(inr::Renderer& renderer, const inr::Frame& frame, Record& record)
  {
    inr::Image picture;
    renderer.render(frame, picture);
    std::vector<double> own;
    std::vector<double> usual;
    inr::FrameStatistics statistics;
    for (double spent = 0; own.size() < 2 || (own.size() < 9 && spent < 0.5); spent += own.back()) {
      const std::uint64_t index = 1 + own.size();
      usual.push_back(timed(this->Usual, this->Shown.frame, index).second);
      const auto [counted, seconds] = timed(renderer, frame, index);
      statistics = counted;
      own.push_back(seconds);
    }
    const double seconds = Fastest(own);
    const double samples = static_cast<double>(statistics.samples) *
                           static_cast<double>(std::max<std::int64_t>(1, statistics.paths));
    record.add("cpu_ms", 1000 * seconds).add("default_cpu_ms", 1000 * Fastest(usual));
    record.add("samples", samples).add("samples_per_cpu_s", samples / seconds);
    record.add("hit_rate", statistics.hitRate());
    record.compare("a", this->Compared.a, picture).compare("b", this->Compared.b, picture);
    record.compare("c", this->Compared.c, picture);
    const double changed = inr::ImagePsnr(this->UsualPicture, picture);
    record.add("psnr_default", std::min(EqualPictures, changed));
  }

  static std::pair<inr::FrameStatistics, double> timed(inr::Renderer& renderer, inr::Frame frame,
                                                       std::uint64_t index)
  {
    frame.frameIndex = index;
    inr::Image picture;
    const double start = ProcessorSeconds();
    const inr::FrameStatistics statistics = renderer.render(frame, picture);
    return {statistics, ProcessorSeconds() - start};
  }

  /// With the bricks of all points that are as precise.
  inr::Renderer& sharing(const inr::RendererOptions& options)
  {
    const Kind key(options.cached, options.cache.precision, options.inference);
    const auto found = this->Sharing.find(key);
    if (found != this->Sharing.end()) {
      return found->second;
    }
    inr::Renderer renderer(this->Given.model, options);
    renderer.setTransferFunction(this->Shown.function);
    return this->Sharing.emplace(key, std::move(renderer)).first->second;
  }

  const Subject& Given;
  const Scene& Shown;
  References Compared;
  inr::Renderer Usual;
  inr::Image UsualPicture;
  double UsualFilling = 0;
  std::int64_t Wanted = 0;
  using Kind = std::tuple<bool, inr::CachePrecision, std::optional<inr::InferencePrecision>>;
  std::map<Kind, inr::Renderer> Sharing;
};

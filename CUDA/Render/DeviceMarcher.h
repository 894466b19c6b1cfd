// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/DevicePicture.h"
#include "CUDA/Render/DeviceScene.h"
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/WindowedRays.h"
#include "Core/Render/AcceleratedRenderer.h"
#include "Core/Render/CachedRenderer.h"
#include "Core/Render/KeptFrame.h"
#include "Core/Render/WorkLimit.h"

namespace inr {
namespace cuda {

/// Ray-marched frames by a machine's kernels; see AcceleratedRenderer.
template <class Machine, class Cache> class DeviceMarcher
{
public:
  /// `beside`: infers bricks while frames go on.
  DeviceMarcher(Machine& machine, Machine& beside, Cache& cache, const CacheOptions& options)
      : Where(machine), Beside(beside), Bricks(cache), Options(options), Picture(machine),
        Scene(machine.template allocate<RenderScene>(1)), Rays(machine, cache, MostRays)
  {}

  FrameStatistics march(const MarchJob& job, const DeviceColors<Machine>& colors,
                        const WorkLimit& limit, const PassOutput& output,
                        const std::function<bool()>& keepGoing)
  {
    const RenderScene scene = this->sceneOf(job, colors);
    this->Where.toMachine(this->Scene.data(), &scene, 1);
    this->Picture.resize(std::int64_t{job.frame.width} * job.frame.height);
    const bool inTime = limit.isLimited() || this->Options.onlyWhatFits;
    // What wants more than the cache holds never comes to its end by what is loaded in between.
    const bool again = this->Overfull && this->Overfull->isOf(job.frame);
    FrameStatistics statistics = inTime && !(again && !this->Options.onlyWhatFits)
                                     ? this->marchInTime(job.frame, limit, keepGoing)
                                     : this->marchComplete(job.frame, keepGoing);
    this->Picture.copyTo(output.rgba.pixels.data(),
                         output.depth != nullptr ? output.depth->pixels.data() : nullptr,
                         output.samples != nullptr ? output.samples->pixels.data() : nullptr);
    return statistics;
  }

  /// For when colours change.
  void forget()
  {
    this->Overfull.reset();
    this->Steps.reset();
  }

private:
  static constexpr std::int64_t MostRays = 1 << 18; ///< 38 MB of their progress

  RenderScene sceneOf(const MarchJob& job, const DeviceColors<Machine>& colors)
  {
    const double step = job.settings.step * job.settings.unitsPerT;
    const int lengths = SampleLengths(this->Bricks.hierarchy().levels());
    if (!this->Steps || !this->Steps->fits(step, lengths)) { // they are megabytes
      this->Steps.emplace(job.colors, step, lengths);
      this->OfSteps.clear();
      this->Entries =
          this->OfSteps.put(this->Where, this->Steps->lookup().entries, 4 * this->Steps->count());
    }
    this->OfFrame.clear();
    RenderScene scene = SceneOn(this->Where, job, colors, this->OfFrame);
    scene.steps = this->Steps->lookup();
    scene.steps.entries = this->Entries;
    return scene;
  }

  MarchRays kernel(OnMiss onMiss) const
  {
    MarchRays kernel{};
    kernel.scene = this->Scene.data();
    kernel.onMiss = onMiss;
    kernel.picture = this->Picture.view();
    kernel.counts = this->Picture.counts();
    return kernel;
  }

  FrameStatistics marchComplete(const Frame& frame, const std::function<bool()>& keepGoing)
  {
    const Timer timer;
    this->Picture.clearCounts();
    this->Rays.runToEnd(this->kernel(OnMiss::Stop), {frame.width, frame.height, nullptr, 0},
                        keepGoing);
    FrameStatistics statistics = this->Picture.statistics();
    statistics.complete = true;
    statistics.marchSeconds = timer.seconds();
    return statistics;
  }

  /// As far as the bricks are there; then some more come in, and once more while there is time.
  FrameStatistics marchInTime(const Frame& frame, const WorkLimit& limit,
                              const std::function<bool()>& keepGoing)
  {
    const OnMiss onMiss = this->Options.preloading ? OnMiss::Approach : OnMiss::UseCoarser;
    bool full = this->Bricks.hasInferred() && this->Bricks.finishLoad().isHopeless();
    while (true) {
      RequireGoingOn(keepGoing);
      const Timer timer;
      this->Picture.clearCounts();
      this->Bricks.beginFrame();
      this->Rays.runOnce(this->kernel(onMiss), {frame.width, frame.height, nullptr, 0});
      FrameStatistics statistics = this->Picture.statistics();
      statistics.marchSeconds = timer.seconds();
      if (statistics.missed > 0) {
        full = this->loadMore(limit) || full;
      }
      statistics.complete = statistics.missed == 0 || (full && this->Options.onlyWhatFits);
      if (full && !statistics.complete) {
        this->Overfull.emplace(frame);
      }
      if (statistics.complete || full || limit.endsWithin(statistics.marchSeconds)) {
        return statistics;
      }
      full = this->Bricks.finishLoad().isHopeless(); // else nothing would be new
    }
  }

  /// Begins to bring bricks that were missed: behind the frames where there is to be a background,
  /// as many as one launch infers. Whether the cache is found to have no room for any.
  bool loadMore(const WorkLimit& limit)
  {
    const std::int64_t most =
        limit.isLimited() ? this->Options.maximumRequests : this->Bricks.capacity();
    if (limit.isLimited() && this->Options.background) {
      if (!this->Bricks.isLoading()) {
        this->Bricks.beginLoad(this->Beside, most, this->Options.ranking);
      }
      return false;
    }
    return this->Bricks.load(most, this->Options.ranking).isHopeless();
  }

  Machine& Where;
  Machine& Beside;
  Cache& Bricks;
  CacheOptions Options;
  DevicePicture<Machine> Picture;
  typename Machine::template Array<RenderScene> Scene;
  WindowedRays<Machine, Cache, RayProgress> Rays;
  Belongings<Machine> OfFrame;
  std::optional<StepTable> Steps; ///< of the present colours
  Belongings<Machine> OfSteps;
  const float* Entries = nullptr;    ///< of them
  std::optional<KeptFrame> Overfull; ///< the latest frame that wanted more than the cache holds
};

} // namespace cuda
} // namespace inr

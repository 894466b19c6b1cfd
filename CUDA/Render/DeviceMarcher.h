// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/MarchedPicture.h"
#include "Core/Render/Acceleration/AcceleratedRenderer.h"
#include "Core/Render/Marching/StepTable.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/KeptFrame.h"
#include "Core/Render/Scene/PerView.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace inr {
namespace cuda {

/// Ray-marched frames by a machine's kernels; see AcceleratedRenderer.
template <class Machine, class Cache> class DeviceMarcher
{
public:
  /// `beside`: infers bricks while frames go on. `most`: rays that wait at once.
  DeviceMarcher(Machine& machine, Machine& beside, Cache& cache, const CacheOptions& options,
                std::int64_t most)
      : Where(machine), Beside(beside), Bricks(cache), Options(options), Most(most)
  {}

  FrameStatistics march(const MarchJob& job, const DeviceColors<Machine>& colors,
                        const DrawCall& call)
  {
    const WorkLimit& limit = call.limit;
    if (this->Unfinished && this->Unfinished->frame.isOf(job.frame)) {
      return this->refine(call);
    }
    // Others are looked at in between without a limit, too: see AcceleratedFrames::prove.
    if (limit.isLimited() && !this->letsOtherGoOn(job.frame.view)) {
      this->dropUnfinished();
    }
    const StepLookup steps = this->stepsFor(job);
    if (!this->Present) {
      this->Present = std::make_unique<Picture>(this->Where, this->Bricks, this->Most);
    }
    Picture& picture = *this->Present;
    picture.setScene(job, colors, steps);
    const bool inTime = limit.isLimited() || this->Options.onlyWhatFits;
    const FrameStatistics statistics = inTime ? this->marchInTime(picture, limit, call.keepGoing)
                                              : this->marchComplete(picture, call.keepGoing);
    picture.copyTo(call.output);
    if (std::exchange(this->Overfull, false) && !this->Unfinished) {
      this->keepUnfinished(job.frame);
    }
    return statistics;
  }

  /// For when another kind of pictures is drawn.
  void clearLayers()
  {
    if (this->Present) {
      this->Present->clearLayers();
    }
  }
  /// For when colours change.
  void forget()
  {
    this->dropUnfinished();
    this->Steps.reset();
  }

private:
  using Picture = MarchedPicture<Machine, Cache>;

  /// A picture that wants more than the cache holds, between the calls that it takes.
  struct Refinement
  {
    Refinement(const Frame& of, std::unique_ptr<Picture> seen)
        : frame(of), view(of.view), picture(std::move(seen))
    {
      this->picture->begin();
    }

    KeptFrame frame;
    int view;                         ///< whose it is
    int waits = 0;                    ///< limited frames of other views since it went on
    std::unique_ptr<Picture> picture; ///< rays that have not ended show what was there before
    FrameStatistics soFar;            ///< of those that have, and of the others' ways
  };

  StepLookup stepsFor(const MarchJob& job)
  {
    const double step = job.settings.step * job.settings.unitsPerT;
    const int lengths = SampleLengths(this->Bricks.hierarchy().levels());
    if (!this->Steps || !this->Steps->fits(step, lengths)) { // they are megabytes
      this->dropUnfinished();                                // it reads them
      this->Steps.emplace(job.colors, step, lengths);
      this->OfSteps.clear();
      this->Entries =
          this->OfSteps.put(this->Where, this->Steps->lookup().entries, 4 * this->Steps->count());
    }
    StepLookup steps = this->Steps->lookup();
    steps.entries = this->Entries;
    return steps;
  }

  /// For a frame of `view`: whether another view's picture, if there is one, keeps its place to
  /// come to its end first. Counts these frames, as nobody may go on with it any more.
  bool letsOtherGoOn(int view)
  {
    constexpr int most = 2 * static_cast<int>(PerView<int>::Most); // views, each shown twice
    return this->Unfinished && this->Unfinished->view != view &&
           !this->Unfinished->picture->done() && ++this->Unfinished->waits < most;
  }

  void keepUnfinished(const Frame& frame)
  {
    this->Unfinished.emplace(frame, std::move(this->Present));
  }
  /// Its memory is for the next picture.
  void dropUnfinished()
  {
    if (this->Unfinished && !this->Present) {
      this->Present = std::move(this->Unfinished->picture);
    }
    this->Unfinished.reset();
  }

  FrameStatistics marchComplete(Picture& picture, const std::function<bool()>& keepGoing)
  {
    picture.begin();
    FrameStatistics statistics =
        picture.goOn(WorkLimit(0, false), this->Options.maximumRequests, keepGoing);
    statistics.complete = true;
    return statistics;
  }

  /// Goes on with the same rays. What is finished is only shown.
  FrameStatistics refine(const DrawCall& call)
  {
    Picture& picture = *this->Unfinished->picture;
    this->Unfinished->waits = 0;
    FrameStatistics& all = this->Unfinished->soFar;
    const FrameStatistics part =
        picture.goOn(call.limit, this->Options.maximumRequests, call.keepGoing);
    picture.copyTo(call.output);
    all.add(part);
    FrameStatistics statistics = all;
    statistics.complete = picture.done();
    statistics.marchSeconds = part.marchSeconds;
    statistics.work = part.work;
    return statistics;
  }

  /// As far as the bricks are there; then some more come in, and once more while there is time.
  FrameStatistics marchInTime(Picture& picture, const WorkLimit& limit,
                              const std::function<bool()>& keepGoing)
  {
    const OnMiss onMiss = this->Options.preloading ? OnMiss::Approach : OnMiss::UseCoarser;
    bool full = this->Bricks.hasInferred() && this->Bricks.finishLoad().isHopeless();
    while (true) {
      FrameStatistics statistics = picture.marchOnce(onMiss, keepGoing);
      if (statistics.missed > 0) {
        full = this->loadMore(limit) || full;
      }
      statistics.complete = statistics.missed == 0 || (full && this->Options.onlyWhatFits);
      // What wants more than the cache holds never comes to its end by what is loaded in between.
      this->Overfull = full && !statistics.complete;
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
  std::int64_t Most;
  std::optional<StepTable> Steps; ///< of the present colours
  Belongings<Machine> OfSteps;
  const float* Entries = nullptr;   ///< of them
  std::unique_ptr<Picture> Present; ///< the latest; null: to be made
  bool Overfull = false;            ///< it was found to want more than the cache holds
  std::optional<Refinement> Unfinished;
};

} // namespace cuda
} // namespace inr

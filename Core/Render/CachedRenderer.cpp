// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/CachedRenderer.h"

#include "Core/Error.h"
#include "Core/Render/CachedPaths.h"
#include "Core/Render/Timer.h"

#include <algorithm>
#include <unistd.h>

namespace inr {

namespace {

/// Bricks inferred in one go: they share the threads, and time and abort are looked at in between.
constexpr std::int64_t BricksAtOnce = 2;

/// log2 of the longest sample in steps: the coarsest level's, four times as long where it is faint.
int StepMultiples(int levels) { return levels + 2; }

const CacheOptions& Checked(const CacheOptions& options)
{
  if (options.bytes < 0 || options.maximumRequests < 1) {
    throw Error(ErrorCode::InvalidArgument,
                "a cache needs a size that is not negative and at least one request at a time");
  }
  return options;
}

} // namespace

std::int64_t DefaultCacheBytes()
{
  constexpr std::int64_t most = std::int64_t{16} << 30;
  const std::int64_t memory =
      std::int64_t{sysconf(_SC_PHYS_PAGES)} * std::int64_t{sysconf(_SC_PAGE_SIZE)};
  return std::min(memory / 4, most);
}

CachedRenderer::CachedRenderer(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
                               const CacheOptions& options, const BrickKernel& kernel,
                               const Arena& arena)
    : Options(Checked(options)), Kernel(kernel), Threads(arena), Field(std::move(field)),
      Cache(Hierarchy(dims, options.brickSize), options.precision,
            options.bytes > 0 ? options.bytes : DefaultCacheBytes()),
      Source(MakeBrickSource(this->Field, this->Cache.hierarchy()))
{
  // There is always something to fall back on.
  const BrickKey coarsest = this->Cache.hierarchy().coarsest();
  this->load({coarsest}, {});
  this->Cache.pin(coarsest);
}

const StepLookup& CachedRenderer::stepsFor(const ColorLookup& colors, double stepLength)
{
  const int multiples = StepMultiples(this->Cache.hierarchy().levels());
  if (!this->Steps || !this->Steps->fits(stepLength, multiples)) {
    this->Steps.emplace(colors, stepLength, multiples);
  }
  return this->Steps->lookup();
}

void CachedRenderer::forgetColors()
{
  this->Unfinished.reset();
  this->Steps.reset();
}

FrameStatistics CachedRenderer::render(const Frame& frame, const RayGeometry& geometry,
                                       const Majorants& majorants, const ColorLookup& colors,
                                       const MarchSettings& settings, const Shading* shading,
                                       const PassOutput& output,
                                       const std::function<bool()>& keepGoing)
{
  if (this->Unfinished && frame.timeLimit > 0 && this->Unfinished->continues(frame)) {
    return this->refine(frame.timeLimit, output, keepGoing);
  }
  this->Unfinished.reset(); // before the table that it reads may change
  const StepLookup& steps = this->stepsFor(colors, settings.step * settings.unitsPerT);
  const CachedScene scene{frame,    geometry,    majorants,    colors,
                          steps,    this->Cache, this->Kernel, FormatOf(this->Cache),
                          settings, shading};
  return frame.timeLimit > 0 ? this->renderInTime(scene, output, keepGoing)
                             : this->renderComplete(scene, output, keepGoing);
}

CachedRenderer::Loaded CachedRenderer::load(const std::vector<BrickKey>& keys,
                                            const std::function<bool()>& keepGoing)
{
  const std::int64_t voxels = this->Cache.hierarchy().voxelsPerBrick();
  const auto count = static_cast<std::int64_t>(keys.size());
  std::vector<float> values(static_cast<std::size_t>(BricksAtOnce * voxels));
  for (std::int64_t first = 0; first < count; first += BricksAtOnce) {
    if (first > 0 && keepGoing && !keepGoing()) { // never without progress
      return {first, false};
    }
    const std::int64_t batch = std::min(BricksAtOnce, count - first);
    this->Source->infer(keys.data() + first, batch, values.data(), this->Threads);
    for (std::int64_t k = 0; k < batch; ++k) {
      if (!this->Cache.insert(keys[static_cast<std::size_t>(first + k)],
                              values.data() + k * voxels)) {
        return {first + k, true};
      }
    }
  }
  return {count, false};
}

FrameStatistics CachedRenderer::renderComplete(const CachedScene& scene, const PassOutput& output,
                                               const std::function<bool()>& keepGoing)
{
  CompletePass pass(scene);
  double marching = 0;
  while (true) {
    const Timer march;
    this->Cache.beginFrame();
    RequestRanking requests;
    pass.advance(this->Threads, keepGoing, output, requests);
    marching += march.seconds();
    if (pass.done()) {
      break;
    }
    // Room for what waits now must not be taken from what was loaded a moment ago for the same
    // rays.
    const std::int64_t most = this->Cache.capacity() - 1;
    const Loaded loaded = this->load(requests.ranked(most, false), keepGoing);
    if (loaded.full) {
      pass.crowd(loaded.bricks);
    }
    if (keepGoing && !keepGoing()) {
      throw Error(ErrorCode::Cancelled, "rendering stopped on request");
    }
  }
  FrameStatistics statistics = pass.statistics();
  statistics.complete = true;
  statistics.marchSeconds = marching;
  return statistics;
}

FrameStatistics CachedRenderer::renderInTime(const CachedScene& scene, const PassOutput& output,
                                             const std::function<bool()>& keepGoing)
{
  const Timer timer(scene.frame.timeLimit);
  const OnMiss onMiss = this->Options.preloading ? OnMiss::Approach : OnMiss::UseCoarser;
  while (true) {
    const Timer march;
    this->Cache.beginFrame();
    RequestRanking requests;
    FrameStatistics statistics =
        MarchOnce(scene, onMiss, this->Threads, keepGoing, output, requests);
    statistics.marchSeconds = march.seconds();
    statistics.complete = requests.empty();
    const bool fits = this->Cache.usedInFrame() + requests.count() <= this->Cache.capacity();
    if (!fits) { // should the same be asked for again
      this->Unfinished.emplace(scene, output);
    }
    this->load(requests.ranked(this->Options.maximumRequests, this->Options.ranking),
               [&] { return timer.left() > 0; });
    if (statistics.complete || !fits || timer.left() < statistics.marchSeconds) {
      return statistics;
    }
  }
}

FrameStatistics CachedRenderer::refine(double timeLimit, const PassOutput& output,
                                       const std::function<bool()>& keepGoing)
{
  const Timer timer(timeLimit);
  double marching = 0;
  do {
    const Timer march;
    this->Cache.beginFrame();
    RequestRanking requests;
    this->Unfinished->advance(this->Threads, keepGoing, requests);
    marching += march.seconds();
    const auto inTime = [&] { return timer.left() > 0; };
    const std::int64_t most = this->Cache.capacity();
    const Loaded loaded = this->load(requests.ranked(most, false), inTime);
    if (loaded.full) {
      this->Unfinished->crowd(loaded.bricks);
    }
  } while (!this->Unfinished->done() && timer.left() > 0);
  this->Unfinished->copyTo(output);
  FrameStatistics statistics = this->Unfinished->statistics();
  statistics.complete = this->Unfinished->done();
  statistics.marchSeconds = marching;
  return statistics;
}

TracedTiles CachedRenderer::tracePaths(const PathRound& round, const Timer* timer,
                                       const std::function<bool()>& keepGoing)
{
  if (round.first) {
    this->InferMisses = false;
  }
  if (round.whole) {
    this->Cache.beginFrame();
  }
  const bool approach = timer != nullptr && this->Options.preloading;
  const OnPathMiss onMiss = this->InferMisses ? OnPathMiss::Infer
                            : approach        ? OnPathMiss::Approach
                                              : OnPathMiss::UseCoarser;
  RequestRanking requests;
  TracedTiles traced = TraceThroughCache(round, this->Cache, *this->Field, onMiss, this->Threads,
                                         keepGoing, requests);
  this->loadForPaths(requests, timer, keepGoing);
  return traced;
}

void CachedRenderer::loadForPaths(const RequestRanking& requests, const Timer* timer,
                                  const std::function<bool()>& keepGoing)
{
  const std::int64_t room = this->Cache.capacity() - this->Cache.usedInFrame();
  const bool some = timer != nullptr || this->InferMisses;
  const std::int64_t most = std::min(room, some ? this->Options.maximumRequests : room);
  this->load(requests.ranked(most, this->Options.ranking), [&] {
    return (timer == nullptr || timer->left() > 0) && (!keepGoing || keepGoing());
  });
  // What does not fit is not worth loading for one path: paths come back to it from everywhere.
  this->InferMisses = this->InferMisses || requests.count() > room;
}

} // namespace inr

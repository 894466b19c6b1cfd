// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/PathPicture.h"

#include "Core/Error.h"
#include "Core/Random.h"
#include "Core/Render/Tiles/WorkLimit.h"

#include <algorithm>
#include <numeric>

namespace inr {

namespace {

/// The mean depth of the collisions where at least half of the paths had one, else 1. `collided` is
/// the part that had, and `depth` a mean over all paths.
float DepthOf(float collided, float depth) { return collided >= 0.5f ? depth / collided : 1.0f; }

} // namespace

bool PathPicture::continues(const Frame& frame) const
{
  return this->Begun && this->Colors.samples() <= frame.samplesPerPixel &&
         this->Picture->isOf(frame);
}

void PathPicture::start(const Frame& frame)
{
  this->Begun = false; // memory may run out before all is of the new picture
  this->Picture.emplace(frame);
  this->Colors.reset(frame.width, frame.height, 4);
  this->Depths.reset(frame.width, frame.height, 1);
  this->Sample = Image(frame.width, frame.height, 4);
  this->SampleDepth = Image(frame.width, frame.height, 1);
  const Tiling tiling(frame.width, frame.height);
  this->Pending.resize(static_cast<std::size_t>(tiling.count()));
  std::iota(this->Pending.begin(), this->Pending.end(), std::int64_t{0});
  this->Reached.assign(this->Pending.size(), 0);
  this->Finished = {};
  this->Latest = {};
  this->Begun = true;
}

void PathPicture::finishTiles(const TracedTiles& traced)
{
  const Tiling tiling(this->Sample.width, this->Sample.height);
  const bool whole = static_cast<std::int64_t>(this->Pending.size()) == tiling.count();
  FrameStatistics unfinished;
  std::size_t pending = 0;
  std::size_t reached = 0;
  for (std::size_t k = 0; k < traced.tiles.size(); ++k) {
    const bool isHere = traced.reached.empty() || traced.reached[k] != 0;
    const bool finished = isHere && (traced.final || traced.tiles[k].missed == 0);
    (finished ? this->Finished : unfinished).add(traced.tiles[k]);
    char& everReached = this->Reached[static_cast<std::size_t>(this->Pending[k])];
    everReached = isHere ? 1 : everReached;
    this->Work.add(traced.tiles[k].work);
    reached += isHere ? 1 : 0;
    if (!finished) {
      this->Pending[pending++] = this->Pending[k];
    }
  }
  this->Pending.resize(pending);
  // Something everywhere comes before the best anywhere.
  std::stable_partition(this->Pending.begin(), this->Pending.end(), [this](std::int64_t tile) {
    return this->Reached[static_cast<std::size_t>(tile)] == 0;
  });
  if (whole) { // what is missing may take as long as the others
    this->Latest.marchSeconds = traced.seconds * static_cast<double>(traced.tiles.size()) /
                                static_cast<double>(std::max<std::size_t>(reached, 1));
  }
  unfinished.add(this->Finished);
  unfinished.marchSeconds = this->Latest.marchSeconds;
  this->Latest = unfinished;
}

bool PathPicture::isBlank() const
{
  return std::find(this->Reached.begin(), this->Reached.end(), 0) != this->Reached.end();
}

void PathPicture::traceRound(const PathMedium& medium, const TraceTiles& trace)
{
  Frame sample = this->Picture->frame();
  sample.seed = RandomBits(sample.seed, sample.frameIndex);
  sample.frameIndex = static_cast<std::uint64_t>(this->Colors.samples());
  const RayGeometry geometry(sample, medium.dims);
  const PathTracer tracer(sample, geometry, medium.dims, medium.majorants, medium.colors,
                          medium.levels);
  const Tiling tiling(sample.width, sample.height);
  const bool whole = static_cast<std::int64_t>(this->Pending.size()) == tiling.count();
  const PassOutput output{this->Sample, &this->SampleDepth};
  const bool first =
      std::find(this->Reached.begin(), this->Reached.end(), 1) == this->Reached.end();
  this->finishTiles(trace({tracer, this->Pending, output, whole, first, this->isBlank()}));
  if (this->Pending.empty()) {
    this->Colors.add(this->Sample);
    this->Depths.add(this->SampleDepth);
    this->Finished = {};
    this->Pending.resize(static_cast<std::size_t>(tiling.count()));
    std::iota(this->Pending.begin(), this->Pending.end(), std::int64_t{0});
  }
}

void PathPicture::show(const PassOutput& output) const
{
  Image depth = this->SampleDepth;
  output.rgba = this->Sample;
  if (this->Colors.samples() > 0) {
    this->Colors.mean(output.rgba);
    this->Depths.mean(depth);
  }
  if (output.depth != nullptr) {
    for (std::size_t k = 0; k < depth.pixels.size(); ++k) {
      output.depth->pixels[k] = DepthOf(output.rgba.pixels[4 * k + 3], depth.pixels[k]);
    }
  }
}

FrameStatistics PathPicture::advance(const Frame& frame, const PathMedium& medium,
                                     const TraceTiles& trace, const WorkLimit& limit,
                                     const PassOutput& output)
{
  if (!this->continues(frame)) {
    this->start(frame);
  }
  this->Work = {};
  bool inTime = true;
  while (inTime && this->Colors.samples() < frame.samplesPerPixel) {
    const Timer round;
    this->traceRound(medium, trace);
    inTime = !limit.endsWithin(round.seconds());
  }
  this->show(output);
  FrameStatistics statistics = this->Latest;
  statistics.paths = this->Colors.samples();
  statistics.blank = this->isBlank();
  statistics.complete = this->Colors.samples() == frame.samplesPerPixel;
  statistics.work = this->Work;
  return statistics;
}

} // namespace inr

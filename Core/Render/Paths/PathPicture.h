// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedPasses.h"
#include "Core/Render/Paths/PathTracer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/KeptFrame.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace inr {

class WorkLimit;

/// What paths go through. `levels` is as for PathTracer.
struct PathMedium
{
  const glm::i64vec3& dims;
  const Majorants& majorants;
  const ColorLookup& colors;
  int levels = 1;
};

/// Tiles of a picture (see Tiling) through whose pixels one path each is to be traced.
struct PathRound
{
  const PathTracer& tracer;
  const std::vector<std::int64_t>& tiles;
  const PassOutput& output; ///< with a depth
  bool whole;               ///< these are all tiles
  bool first;               ///< nothing of this picture was traced before
  bool blank;               ///< nor was something of each of its tiles
};

struct TracedTiles
{
  /// In the order of the round's tiles. Those that missed something, unless that is final, and
  /// those that were not reached are asked for again.
  std::vector<FrameStatistics> tiles;
  std::vector<char> reached; ///< whether there was time for each; empty: for all of them
  bool final = false;
  double seconds = 0; ///< of tracing, without what was loaded
};

using TraceTiles = std::function<TracedTiles(const PathRound&)>;

/// A path-traced picture in the making, over several calls: the mean of samples, each with one path
/// through every pixel and complete. Sample k is a function of seed, frame index and k, however the
/// calls share the work. One for each medium.
class PathPicture
{
public:
  PathPicture() = default;
  PathPicture(const PathPicture&) = delete;
  PathPicture& operator=(const PathPicture&) = delete;

  /// Goes on with the picture at hand if `frame` asks for the same one (and for no fewer samples
  /// than there are), else starts anew. Traces until Frame::samplesPerPixel or, at least one round
  /// as far as `trace` comes in it, as far as `limit`. Shows the mean of the complete samples or,
  /// before the first of them is complete, what there is of it, where the rest lets everything
  /// through. `trace` may throw; nothing is lost then but its round. The
  /// frame is a valid one: see RequireValid.
  FrameStatistics advance(const Frame& frame, const PathMedium& medium, const TraceTiles& trace,
                          const WorkLimit& limit, const PassOutput& output);
  /// Whether a call with that frame would go on with the same picture.
  bool continues(const Frame& frame) const;

private:
  void start(const Frame& frame);
  void traceRound(const PathMedium& medium, const TraceTiles& trace);
  void finishTiles(const TracedTiles& traced);
  bool isBlank() const; ///< some tile shows nothing yet
  void show(const PassOutput& output) const;

  bool Begun = false;
  std::optional<KeptFrame> Picture;
  Accumulator Colors;
  Accumulator Depths; ///< of first collisions; 0 where there was none

  Image Sample; ///< in the making
  Image SampleDepth;
  std::vector<std::int64_t> Pending; ///< tiles of it
  std::vector<char> Reached;         ///< tiles that show something of the picture
  FrameStatistics Finished;          ///< of the sample's other tiles
  FrameStatistics Latest;            ///< of the latest sample, as far as it is traced
  WorkDone Work;                     ///< of the present call
};

} // namespace inr

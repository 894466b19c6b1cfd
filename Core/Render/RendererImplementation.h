// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/Parallel.h"
#include "Core/Render/Acceleration/AcceleratedFrames.h"
#include "Core/Render/CachedRenderer.h"
#include "Core/Render/Marching/PreIntegratedColors.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/PerView.h"
#include "Core/Render/Tiles/WorkLimit.h"
#include "Core/Render/Tolerance/LevelChooser.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace inr {

/// How a frame's rays are marched.
struct MarchSetup
{
  RayGeometry geometry;
  MarchSettings settings;
  std::optional<Shading> shading;

  const Shading* lit() const { return this->shading ? &*this->shading : nullptr; }
  MarchJob job(const Frame& frame, const ColorLookup& colors) const
  {
    return {frame, this->geometry, this->settings, colors, this->lit()};
  }
};

/// A frame as it is drawn with levels that its tolerance has chosen, if it has one.
struct LevelChoice
{
  Frame frame;
  bool final = true;       ///< else not all is measured yet, and levels are by distance meanwhile
  std::int64_t points = 0; ///< that the network was asked for

  void addTo(FrameStatistics& statistics) const
  {
    statistics.complete = statistics.complete && this->final;
    statistics.work.networkSamples += this->points;
  }
};

/// Lasts as long as a picture is drawn, during which nothing of its renderer may change.
class Drawing
{
public:
  explicit Drawing(bool& inProgress) : InProgress(inProgress)
  {
    RequireNone(inProgress);
    inProgress = true;
  }
  ~Drawing() { this->InProgress = false; }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  static void RequireNone(bool inProgress)
  {
    Require(!inProgress, "a renderer that is asked whether to go on can neither draw something "
                         "else nor change its transfer function; do so when it has returned");
  }

private:
  bool& InProgress;
};

/// What a renderer consists of.
struct Renderer::Implementation
{
  /// `model`: null for another field.
  Implementation(std::shared_ptr<const Evaluator> field, std::shared_ptr<const void> identity,
                 const ModelPointer& model, VolumeInfo volume, const MacroCells& cells,
                 RendererOptions options);

  /// Before a picture of a kind that the accelerator has not drawn yet: gives it up unless a small
  /// one like it is the CPU's, if such a one shows anything.
  void proveDevice(const Frame& frame, const std::function<bool()>& keepGoing);
  /// Whether the accelerator draws such a frame itself.
  bool isForDevice(const Frame& frame) { return this->Drawn && this->Drawn->draws(frame); }
  /// That small picture by either, on the device if it does not fail.
  void proveOnDevice(const Frame& small, const PassOutput& output,
                     const std::function<bool()>& keepGoing);
  void proveOnCpu(const Frame& small, const PassOutput& output,
                  const std::function<bool()>& keepGoing);
  /// Has it made what frames will ask for, so that it is known beforehand whether it can.
  void tryAccelerator();

  Projector projector() const
  {
    return ProjectorFor(this->Seen, this->Volume, this->Cells.bounds(), this->Surfaces);
  }
  void build();
  /// Finds what matters to pictures blended like this, unless that is known.
  void buildFor(const Blending& blending);
  /// Whether what comes from coarser levels is chosen by such a frame's tolerance.
  bool choosesLevels(const Frame& frame) const;
  /// Puts such a choice into `settings`.
  LevelChoice chooseLevels(const Frame& frame, const DrawCall& call, MarchSettings& settings);

  MarchSetup setupFor(const Frame& frame);
  FrameStatistics march(const Frame& frame, const PassOutput& output,
                        const std::function<bool()>& keepGoing);
  /// By the accelerator, if that does not fail.
  std::optional<FrameStatistics> marchOnDevice(const Frame& frame, MarchSetup& setup,
                                               const DrawCall& call);
  /// By the CPU; without a cache, with samples that `field` infers.
  FrameStatistics marchOnCpu(const Frame& frame, MarchSetup& setup, const Evaluator& field,
                             const DrawCall& call);
  FrameStatistics marchCached(const Frame& frame, MarchSetup& setup, const DrawCall& call);
  PathMedium medium() const;
  TracedTiles traceRound(const PathRound& round, const WorkLimit& limit,
                         const std::function<bool()>& keepGoing);
  /// By the CPU; see marchOnCpu.
  TracedTiles traceOnCpu(const PathRound& round, const Evaluator& field, const WorkLimit& limit,
                         const std::function<bool()>& keepGoing);
  /// A picture beside the one in the making.
  void traceAlone(const Frame& frame, const WorkLimit& limit, const PassOutput& output,
                  const TraceTiles& trace);
  FrameStatistics tracePaths(const Frame& frame, const PassOutput& output,
                             const std::function<bool()>& keepGoing);

  std::shared_ptr<const Evaluator> Field; ///< by the CPU
  std::shared_ptr<const void>
      Identity; ///< of the field: renderers that have the same share a cache
  VolumeInfo Volume;
  RendererOptions Options;
  std::shared_ptr<AcceleratedField> Accelerated; ///< null where only the CPU computes
  std::shared_ptr<const Evaluator> Samples;      ///< of frames without a cache: the field
  Arena Threads;
  Majorants Cells;
  std::optional<TransferFunction> Function;
  std::optional<ColorTable> Colors;
  std::optional<PreIntegratedColors> PreIntegrated; ///< once a frame wanted them, of `Colors`
  bool IsDrawing = false;                           ///< see Drawing
  bool Built = false;                     ///< the majorants, for the colours and for `Seen`
  Blending Seen;                          ///< how pictures are blended that the majorants are for
  std::vector<float> Surfaces;            ///< of these pictures
  std::optional<CachedRenderer> Cached;   ///< where there is to be a cache
  std::optional<AcceleratedFrames> Drawn; ///< where there is an accelerator
  PerView<PathPicture> Paths;             ///< while paths are traced: 64 bytes a pixel
                                          ///< each, and 20 for each translucent layer
  std::optional<LevelChooser> Levels;     ///< once a frame had a tolerance
  std::int64_t ColorsVersion = 0;
};

} // namespace inr

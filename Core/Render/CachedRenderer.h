// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickStore.h"
#include "Core/Cache/CacheOptions.h"
#include "Core/Parallel.h"
#include "Core/Render/Acceleration/Accelerator.h"
#include "Core/Render/Bricks/SufficientBricks.h"
#include "Core/Render/KeptPicture.h"
#include "Core/Render/Marching/MarchJob.h"
#include "Core/Render/Marching/StepTable.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Paths/PathShortage.h"
#include "Core/Render/Refinement.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/PerView.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace inr {

enum class OnPathMiss;

/// What is drawn through a cache.
struct CachedField
{
  std::shared_ptr<const Evaluator> field;
  std::shared_ptr<const void> identity; ///< the same object for the same field
  glm::i64vec3 dims;                    ///< voxels
  /// Of the field, whose ranges hold; may be null.
  std::shared_ptr<const MacroCells> cells;
  /// Infers the bricks; null: the CPU does.
  std::shared_ptr<const Accelerator> accelerator;
  ModelPointer model; ///< that the field is of, where there is an accelerator
};

/// Renders through a cache of bricks, which lives from frame to frame and which all renderers of
/// the same field with the same bricks and size of the cache share. The threads that load bricks
/// are as many as those of the first.
class CachedRenderer
{
public:
  /// Throws what Hierarchy and BrickCache throw. `arena` must outlive the renderer.
  CachedRenderer(const CachedField& field, const CacheOptions& options, const BrickKernel& kernel,
                 const Arena& arena);
  /// Nothing more is loaded for its pictures, even where somebody keeps the bricks.
  ~CachedRenderer();
  CachedRenderer(const CachedRenderer&) = delete;
  CachedRenderer& operator=(const CachedRenderer&) = delete;

  /// Within a call; see Renderer::render. The references are for this only.
  FrameStatistics render(const MarchJob& job, const Majorants& majorants, const ColorTable& colors,
                         const DrawCall& call);
  /// Around what follows; see BrickStore.
  BrickStore::Call call() const { return {*this->Store, this->Threads}; }
  /// Within a call: traces a round of a path-traced picture and brings what its paths missed, as
  /// much as `limit` allows. Where the cache has no room for what the picture wants, the rest is
  /// inferred at the paths' points instead, or stays coarser.
  TracedTiles tracePaths(const PathRound& round, const Majorants& majorants,
                         const ColorTable& colors, const WorkLimit& limit,
                         const std::function<bool()>& keepGoing);
  /// Forgets what was made of the colours; for when they change.
  void forgetColors();

  const BrickStore& store() const { return *this->Store; }
  const std::shared_ptr<BrickStore>& sharedStore() const { return this->Store; }

private:
  /// A view's latest picture, where it is not complete: one of these or none. Its pixels, some 20
  /// bytes each, and tables are beside the cache, until the view is drawn again or many others are.
  struct UnfinishedPicture
  {
    /// Where there was no time for all of it, or it lacks bricks that the cache has room for.
    std::unique_ptr<KeptPicture> kept;
    /// Of what the cache cannot hold, or keep for it.
    std::optional<Refinement> refined;
  };

  FrameStatistics renderFrame(const CachedScene& scene, const DrawCall& call);
  void beginFrame();
  const std::shared_ptr<const StepTable>& stepsFor(const ColorLookup& colors, double stepLength);
  /// Null where all values matter.
  std::shared_ptr<const BlockVisibility> blocksFor(const ColorTable& colors,
                                                   const MarchSettings& settings, bool rangesHold);
  /// `reach`: see VisibleBlocks; nothing: whole bricks.
  const std::shared_ptr<const SufficientBricks>& bricksFor(const Majorants& majorants,
                                                           std::optional<int> reach);
  /// Where there is no room for so many bricks, the level that is not on the way, which takes an
  /// eighth of it, in place of the next finer one, unless it is there.
  RequestRanking inSteps(const RequestRanking& requests, std::int64_t room) const;
  FrameStatistics renderComplete(const CachedScene& scene, const DrawCall& call);
  /// Those to go on with, and their pixels, or new ones.
  MarchedTiles tilesFor(const CachedScene& scene, const DrawCall& call);
  void keep(const CachedScene& scene, MarchedTiles tiles, const DrawCall& call);
  FrameStatistics renderInTime(const CachedScene& scene, const DrawCall& call);
  FrameStatistics renderWhatFits(const CachedScene& scene, const DrawCall& call);
  /// Those tiles that are due, as far as the bricks are there.
  FrameStatistics march(const CachedScene& scene, MarchedTiles& tiles, const DrawCall& call,
                        RequestRanking& requests);
  FrameStatistics refine(Refinement& unfinished, const DrawCall& call);
  /// At most so many bricks.
  void loadForPass(CompletePass& pass, const RequestRanking& requests, std::int64_t most,
                   const std::function<bool()>& keepGoing);
  /// Whether the cache is found to be full. `part`: see WorkLimit::secondsForLoading.
  bool loadForFrame(std::vector<BrickPart> parts, const WorkLimit& limit,
                    const std::function<bool()>& keepGoing, double part = 0.25);
  /// Bricks that may come without any of the present frame having to go.
  std::int64_t room() const;
  /// In a round of a picture that has begun.
  OnPathMiss onPathMiss(const WorkLimit& limit) const;
  /// `again`: others for the same picture.
  void loadForPaths(const RequestRanking& requests, bool again, const WorkLimit& limit,
                    const std::function<bool()>& keepGoing);

  CacheOptions Options;
  const BrickKernel& Kernel;
  const Arena& Threads;
  std::shared_ptr<const Evaluator> Field;
  std::shared_ptr<BrickStore> Store;
  std::uint64_t Latest = BrickCache::Pinned; ///< of this renderer's frames in the store
  WorkDone Work;                             ///< of rays, in the present call
  // Of the latest frame; null before.
  std::shared_ptr<const StepTable> Steps;
  std::shared_ptr<const BlockVisibility> Blocks;
  std::shared_ptr<const SufficientBricks> Bricks;
  PerView<UnfinishedPicture> Unfinished;
  PathShortage Shortage; ///< of the latest path-traced picture
};

} // namespace inr

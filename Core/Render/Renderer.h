// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CacheOptions.h"
#include "Core/Cache/KeptBricks.h"
#include "Core/Image/Image.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/Model.h"
#include "Core/Render/Acceleration/AcceleratedField.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/TransferFunction.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace inr {

struct RendererOptions
{
  int threads = 0;    ///< 0 = all available cores
  std::string kernel; ///< instruction set, for tests; empty = the fastest
  /// Of what the CPU infers where there is no accelerator, and it and the model allow that. Empty:
  /// SplitBFloat16 where a cache rounds to 16 bits or less and layers have 64 neurons or more, else
  /// Float32.
  std::optional<InferencePrecision> inference = InferencePrecision::Float32;
  bool cached = true; ///< through a cache of bricks, else straight from the network
  /// Frames with a time limit do a fixed amount of work instead of what there is time for, and
  /// bricks come in within them only; see WorkLimit. CacheOptions::background is then off.
  bool deterministic = false;
  CacheOptions cache;
  /// Draws a model's frames where it can, and else infers bricks or samples; null: the CPU does.
  std::shared_ptr<const Accelerator> accelerator;

  bool operator==(const RendererOptions& other) const
  {
    return this->threads == other.threads && this->kernel == other.kernel &&
           this->inference == other.inference && this->cached == other.cached &&
           this->deterministic == other.deterministic && this->cache == other.cache &&
           this->accelerator == other.accelerator;
  }
};

/// Draws an INR by marching rays or tracing paths, through a cache of decoded bricks or straight
/// from its network.
///
/// Renderers of the same field (one model or one Evaluator) share their bricks if these are of the
/// same size, inferred and kept in the same precision, and in a cache as large; how many are asked
/// for at once, and in which order, may differ. They are kept as long as one such renderer or
/// KeptBricks of one exist. All renderers of the process share the memory of their caches: see
/// CacheBudget.
///
/// A complete frame is a pure function of model, transfer function and Frame: threads, tiles, the
/// size of the cache and what other renderers do change no pixel. The exception are paths whose
/// bricks the cache cannot hold, or keep until the next call: part of what they meet is then free
/// of interpolation error, and pictures that are to make do with what the cache can hold. A
/// renderer is not for use from two threads at once; several are, and those that share bricks take
/// turns. In the middle of rendering (in keepGoing, on whichever thread that is asked), another
/// that shares its bricks throws Error(Cancelled); this one throws Error(InvalidArgument).
///
/// Where an accelerator fails, the CPU takes over within the call and goes on: no call fails
/// because of it, no brick is lost, and the picture is the same but for the rounding of float32.
/// Samples that paths take of the network for want of room in the cache, and what a tolerance
/// measures, are always the CPU's.
class Renderer
{
public:
  /// Throws Error(InvalidArgument) without a model; further what the cache and the kernel throw.
  explicit Renderer(const ModelPointer& model, const RendererOptions& options = {});
  /// Any field: normalised values over the unit cube, with a volume's dimensions and value range.
  /// Throws Error(InvalidArgument), too, where the volume or the cells (may be empty) are not
  /// valid (see RequireValidVolume and RequireValidGeometry) or a cell has no range.
  Renderer(const std::shared_ptr<const Evaluator>& field, const VolumeInfo& volume,
           const MacroCells& cells, const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Rebuilds the majorants if, and only if, `transferFunction` differs from the current one.
  /// Throws Error(InvalidArgument) for a table of fewer than 2 entries, non-finite entries, low >=
  /// high, or a logarithmic range that is not positive.
  void setTransferFunction(const TransferFunction& transferFunction);

  /// Rises by one whenever what pictures depend on of the colours changes, and the majorants are
  /// rebuilt: for a transfer function or a frame whose Blending is not that of the one before.
  std::int64_t colorsVersion() const;

  /// Bytes in use by the caches of all renderers of the process, their tables and queues: at most
  /// the largest of their CacheOptions::bytes. (One that comes while the others draw with all of
  /// it brings its empty tables until they end, eight bytes for each brick that it may come to
  /// hold.) An accelerator's caches are counted, too, and have such a limit of their own. 0 without
  /// a cache.
  std::int64_t cacheBytes() const;
  /// Bricks in the cache of this renderer and those that it shares them with, 0 as above.
  std::int64_t cachedBricks() const;

  /// Keeps the bricks beyond the life of the renderer; null where there is no cache.
  std::shared_ptr<const KeptBricks> keepBricks() const;

  /// The instruction set with which the CPU computes, and how: Evaluator::kernel().
  std::string kernel() const;

  /// What infers bricks or, without a cache, samples in the CPU's place: Accelerator::name(). Empty
  /// where nothing does.
  std::string accelerator() const;
  /// Why it does not.
  std::optional<AcceleratedField::Failure> acceleratorFailure() const;

  /// That compute the pictures.
  int threads() const;

  /// Renders into `rgba`: premultiplied RGBA, resized to the frame. `depth`, when given, receives
  /// the window-space depth where accumulated opacity first reaches one half, 1 where it never
  /// does; of the largest or smallest value where its opacity does; 1 for averages and sums; of
  /// path tracing, the mean depth of the first collisions where at least half of the paths had one.
  /// A picture that a time limit cut short goes on when the same frame is asked for again; paths
  /// do so for several views by turns, see Frame::view.
  /// `samples`, when given, receives two channels: the samples that each pixel took and the mean of
  /// the levels of the cache that they came from, -1 where there were none; it is left empty when
  /// paths are traced or there is no cache; where more bricks are at hand, rays look further ahead,
  /// and take samples that come to nothing. `keepGoing` is asked between tiles, possibly by
  /// several threads at once; returning false throws Error(Cancelled). Throws
  /// Error(InvalidArgument) for a frame outside its documented ranges, singular matrices or a
  /// missing transfer function.
  FrameStatistics render(const Frame& frame, Image& rgba, Image* depth = nullptr,
                         const std::function<bool()>& keepGoing = {}, Image* samples = nullptr);

  /// Lets go of the paths that a view's picture would go on with; see Frame::view. Not in the
  /// middle of rendering, as above.
  void forgetPaths(int view);

private:
  struct Implementation;
  std::unique_ptr<Implementation> Self;
};

} // namespace inr

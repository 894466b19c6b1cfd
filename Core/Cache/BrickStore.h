// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Cache/BrickLoader.h"
#include "Core/Cache/BrickWork.h"
#include "Core/Cache/CacheBudget.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

namespace inr {

/// A cache of bricks with what fills it: threads that wait for bricks, or a loader behind them.
///
/// Several renderers may have the same one, on several threads. They take turns: all but
/// what never changes (hierarchy(), sharedBudget()), capacity(), mapped(), budget() and
/// forgetRequests() is for who has a Call.
class BrickStore
{
public:
  /// Cache, tables and the loader's queue stay within `bytes` together and share them with the
  /// other stores of `budget`; what is being inferred for who waits, two bricks of floats or a
  /// single large one, and what the source infers at once where it does so, comes on top. Without
  /// `background`, and where the queue would need more than an eighth of that, there is no loader,
  /// and bricks come in only while somebody waits. `threads`: of the loader. Throws what BrickCache
  /// throws.
  BrickStore(std::shared_ptr<CacheBudget> budget, std::shared_ptr<const BrickSource> source,
             CachePrecision precision, std::int64_t bytes, bool background, int threads);
  ~BrickStore();
  BrickStore(const BrickStore&) = delete;
  BrickStore& operator=(const BrickStore&) = delete;

  const CacheBudget& budget() const { return *this->Budget; }
  const std::shared_ptr<CacheBudget>& sharedBudget() const { return this->Budget; }
  const BrickCache& cache() const { return this->Cache; }
  std::int64_t mapped() const; ///< bricks
  /// Bricks that it may come to hold while the other stores that are in use keep what they have.
  std::int64_t capacity() const;

  /// A frame of its own, of which nothing is evicted until the next one begins; its place in time.
  /// What was used in frame `continued` or after it is used in this one, too.
  std::uint64_t beginFrame(std::optional<std::uint64_t> continued = std::nullopt);
  std::uint64_t frame() const { return this->Cache.frame(); }
  /// Whether a brick is lost that was used in that frame or came in for it, or in a later one.
  bool hasLostSince(std::uint64_t frame) const;

  struct Loaded
  {
    std::int64_t bricks;
    bool full; ///< there were more than fitted beside what the latest frame used
  };
  /// Infers and maps parts of bricks now, for as long as `keepGoing` (may be empty) says so, but
  /// never without progress. Of a brick that is mapped all is inferred: it has turned out to lack
  /// something, and is not to come in a third time. Requests to the loader are forgotten.
  Loaded load(std::vector<BrickPart> parts, const Arena& arena,
              const std::function<bool()>& keepGoing);
  /// Drops all bricks but the coarsest level, those of the current frame included.
  void clear();
  /// Maps what the loader infers in so many seconds, or infers where there is none; it goes on with
  /// them when it is not paused.
  void loadFor(double seconds, std::vector<BrickPart> parts, const Arena& arena);

  /// Nobody needs for now what the loader was asked for, on any thread.
  void forgetRequests();

  /// The time of one call that renders: others wait, the loaders of all stores are paused, so that
  /// a frame has the machine to itself, and what this one's has finished is mapped, in place of
  /// nothing that the last frame used. The coarsest level is there.
  class Call
  {
  public:
    /// Throws Error(Cancelled) where waiting would be for ever: to render from a store that is in
    /// use, in the middle of rendering on the same thread or for one that is Awaited. And what
    /// inferring throws.
    Call(BrickStore& store, const Arena& arena);
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    /// What has come in since it began.
    BrickWork done() const { return this->Mine.Store.Done.since(this->Mine.Before); }

  private:
    struct Turn
    {
      explicit Turn(BrickStore& store);
      ~Turn();
      BrickStore& Store;
      BrickWork Before;
    };
    Turn Mine;
  };

  /// While one exists, its thread does something that a call waits for, whichever thread that is
  /// on: a host is asked whether to go on. What needs a store that is in use is refused there.
  class Awaited
  {
  public:
    Awaited();
    ~Awaited();
    Awaited(const Awaited&) = delete;
    Awaited& operator=(const Awaited&) = delete;

    static bool here();
  };

private:
  friend class CacheBudget;

  void mapLoaded();
  void completeKnown(std::vector<BrickPart>& parts) const;
  bool insert(const BrickPart& part, const float* values);
  bool makeRoomAndInsert(const BrickPart& part, const float* values);
  void countInferred(const BrickPart& part);
  bool makeQueue(std::int64_t bricks);

  // The rest is for who holds the budget's mutex.
  std::int64_t queueBytes() const;
  std::int64_t bytes() const { return this->Cache.bytes() + this->queueBytes(); } ///< in use
  std::int64_t least() const;      ///< that it may need at any time
  std::int64_t kept() const;       ///< in use, and at least that
  std::int64_t cannotGive() const; ///< of what is kept
  void setPaused(bool paused);
  bool isInUse() const { return this->User != std::thread::id(); }
  /// When what it would give back next was last used, BrickCache::Pinned where it has nothing.
  std::uint64_t oldestUse();
  /// Gives that back.
  void giveOldest();
  std::uint64_t evictableBefore() const;
  std::uint64_t oldestBrickUse();
  bool mayGiveQueue() const;

  const std::shared_ptr<CacheBudget> Budget;
  const std::shared_ptr<const BrickSource> Source;
  const std::int64_t Limit;
  const std::int64_t LongestQueue;           ///< bricks
  const std::unique_ptr<BrickLoader> Loader; ///< may be null
  BrickCache Cache;
  BrickWork Done;              ///< so far, for who has a call
  std::int64_t Queue = 0;      ///< bricks for which the loader has room
  std::uint64_t LostQueue = 0; ///< the latest frame that lost what the loader had for it
  std::thread::id User;        ///< of the present call
};

} // namespace inr

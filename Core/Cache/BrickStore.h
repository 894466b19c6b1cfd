// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Cache/BrickLoader.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace inr {

/// A cache of bricks with what fills it: threads that wait for bricks, or a loader behind them. The
/// coarsest level is always there.
///
/// For one thread at a time, like the cache's own changes.
class BrickStore
{
public:
  /// Cache, tables and the loader's queue stay within `bytes` together. Without `background`, and
  /// where the queue would need more than an eighth of that, there is no loader, and bricks come in
  /// only while somebody waits. Throws what BrickCache and inferring throw.
  BrickStore(std::shared_ptr<const BrickSource> source, CachePrecision precision,
             std::int64_t bytes, bool background, const Arena& arena);

  const BrickCache& cache() const { return this->Cache; }
  std::int64_t bytes() const; ///< of all that is allocated

  /// See BrickCache.
  void beginFrame() { this->Cache.beginFrame(); }

  struct Loaded
  {
    std::int64_t bricks;
    bool full; ///< there were more than fitted beside what the latest frame used
  };
  /// Infers and maps bricks now, for as long as `keepGoing` (may be empty) says so, but never
  /// without progress. Requests to the loader are forgotten.
  Loaded load(const std::vector<BrickKey>& keys, const Arena& arena,
              const std::function<bool()>& keepGoing);
  /// Infers and maps bricks for so many seconds, together with the loader, which goes on with them
  /// when it is not paused.
  void loadFor(double seconds, const std::vector<BrickKey>& keys, const Arena& arena);

  /// The time of one call that renders: the loader is paused, so that a frame has the machine to
  /// itself, and what it has finished is mapped, in place of nothing that the last frame used.
  class Call
  {
  public:
    explicit Call(BrickStore& store);
    ~Call();
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

  private:
    BrickStore& Store;
  };

private:
  void mapLoaded();

  std::shared_ptr<const BrickSource> Source;
  std::unique_ptr<BrickLoader> Loader; ///< may be null
  BrickCache Cache;
};

} // namespace inr

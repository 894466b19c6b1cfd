// SPDX-License-Identifier: BSD-3-Clause
//
// Memory of a device that several caches share.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace inr {
namespace cuda {

/// What a cache can do with memory, in bytes.
struct CacheWish
{
  std::int64_t least; ///< that it needs
  std::int64_t most;  ///< that it would take of its limit
  std::int64_t limit; ///< that it was given: at least `most`, which is at least `least`
};

/// How much each may take, that all of them stay within the largest limit or, should that be more,
/// within the least that all of them need. What is left after these goes to all alike, but nobody
/// has more than its most; who has that is told its limit.
std::vector<std::int64_t> SharesOf(const std::vector<CacheWish>& wishes);

/// The caches of a device that share memory. May be used from several threads at once.
class CacheShares
{
public:
  /// Those of a GPU in this process, as long as somebody holds them.
  static std::shared_ptr<CacheShares> ofGpu(int ordinal);

  /// Who has a cache in such memory.
  class Holder
  {
  public:
    virtual ~Holder() = default;
    /// Takes what its share is now, if nobody uses the cache, and says whether nobody did. May
    /// throw: see adjust.
    virtual bool adjustIfIdle() = 0;
  };

  /// Of one cache, from when it wishes for memory until it has given all back.
  class Share
  {
  public:
    Share(std::shared_ptr<CacheShares> all, const CacheWish& wish);
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    std::int64_t bytes() const { return this->Bytes; } ///< that it may take, at present
    void take(std::int64_t bytes) { this->Taken = bytes; }
    CacheShares& all() const { return *this->All; }

  private:
    friend class CacheShares;

    std::shared_ptr<CacheShares> All;
    CacheWish Wish;
    std::atomic<std::int64_t> Bytes{0};
    std::atomic<std::int64_t> Taken{0};
  };

  std::int64_t taken() const; ///< bytes, by all

  void add(const std::shared_ptr<Holder>& holder);
  /// Has all adjust that are idle, but for `who`, which sees to itself, unless `division` says that
  /// they have since memory was divided last; it does once none was in use. Who cannot tries again
  /// when it is used: the others have nothing to do with that.
  void adjust(const Holder& who, std::uint64_t& division);

private:
  void divide(); ///< for who holds the mutex

  mutable std::mutex Mutex; ///< guards what follows
  std::uint64_t Division = 1;
  std::vector<Share*> Shares;
  std::vector<std::weak_ptr<Holder>> Holders;
};

} // namespace cuda
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/CacheShares.h"

#include <algorithm>
#include <exception>
#include <map>
#include <new>
#include <numeric>
#include <utility>

namespace inr {
namespace cuda {

std::vector<std::int64_t> SharesOf(const std::vector<CacheWish>& wishes)
{
  std::vector<std::int64_t> shares;
  std::int64_t left = 0;
  for (const CacheWish& wish : wishes) {
    left = std::max(left, wish.limit);
  }
  for (const CacheWish& wish : wishes) {
    shares.push_back(wish.least);
    left -= wish.least;
  }
  std::vector<std::size_t> order(wishes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto more = [&](std::size_t k) { return wishes[k].most - wishes[k].least; };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return more(a) < more(b); });
  // Whoever wants less than an even part leaves the rest to those that come later.
  auto waiting = static_cast<std::int64_t>(order.size());
  for (const std::size_t k : order) {
    const std::int64_t part = std::min(more(k), std::max<std::int64_t>(left, 0) / waiting--);
    left -= part;
    shares[k] = part == more(k) ? wishes[k].limit : shares[k] + part;
  }
  return shares;
}

CacheShares::Share::Share(std::shared_ptr<CacheShares> all, const CacheWish& wish)
    : All(std::move(all)), Wish(wish)
{
  const std::lock_guard<std::mutex> lock(this->All->Mutex);
  this->All->Shares.push_back(this);
  try {
    this->All->divide();
  } catch (const std::bad_alloc&) {
    this->All->Shares.pop_back();
    throw;
  }
}

CacheShares::Share::~Share()
{
  const std::lock_guard<std::mutex> lock(this->All->Mutex);
  std::vector<Share*>& shares = this->All->Shares;
  shares.erase(std::remove(shares.begin(), shares.end(), this), shares.end());
  try {
    this->All->divide();
  } catch (const std::bad_alloc&) { // the others keep what they have
  }
}

std::shared_ptr<CacheShares> CacheShares::ofGpu(int ordinal)
{
  // Never destroyed: whoever holds shares may outlive this library's other statics.
  static auto& mutex = *new std::mutex;
  static auto& known = *new std::map<int, std::weak_ptr<CacheShares>>;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<CacheShares> shares = known[ordinal].lock();
  if (!shares) {
    shares = std::make_shared<CacheShares>();
    known[ordinal] = shares;
  }
  return shares;
}

std::int64_t CacheShares::taken() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return std::accumulate(this->Shares.begin(), this->Shares.end(), std::int64_t{0},
                         [](std::int64_t sum, const Share* share) { return sum + share->Taken; });
}

void CacheShares::add(const std::shared_ptr<Holder>& holder)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto isGone = [](const std::weak_ptr<Holder>& other) { return other.expired(); };
  this->Holders.erase(std::remove_if(this->Holders.begin(), this->Holders.end(), isGone),
                      this->Holders.end());
  this->Holders.push_back(holder);
}

void CacheShares::adjust(const Holder& who, std::uint64_t& division)
{
  std::vector<std::shared_ptr<Holder>> holders;
  std::uint64_t present = 0;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (division == this->Division) {
      return;
    }
    present = this->Division;
    for (const std::weak_ptr<Holder>& holder : this->Holders) {
      holders.push_back(holder.lock());
    }
  } // one that is let go of here takes the mutex, too
  bool wereIdle = true;
  for (const std::shared_ptr<Holder>& holder : holders) {
    try {
      if (holder && holder.get() != &who) {
        wereIdle = holder->adjustIfIdle() && wereIdle;
      }
    } catch (const std::exception&) { // it is told so when it draws itself
    }
  }
  division = wereIdle ? present : division;
}

void CacheShares::divide()
{
  std::vector<CacheWish> wishes;
  for (const Share* share : this->Shares) {
    wishes.push_back(share->Wish);
  }
  const std::vector<std::int64_t> shares = SharesOf(wishes);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    this->Shares[k]->Bytes = shares[k];
  }
  ++this->Division;
}

} // namespace cuda
} // namespace inr

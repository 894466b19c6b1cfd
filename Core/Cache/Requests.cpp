// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/Requests.h"

#include <algorithm>

namespace inr {

void RequestList::add(BrickKey key, float contribution)
{
  // Neighbouring rays miss the same bricks: the last few entries catch most repetitions.
  constexpr std::size_t window = 8;
  const std::size_t size = this->Entries.size();
  for (std::size_t k = size; k > 0 && k + window > size; --k) {
    Request& entry = this->Entries[k - 1];
    if (entry.key == key) {
      entry.contribution += contribution;
      return;
    }
  }
  this->Entries.push_back({key, contribution});
}

void RequestRanking::add(const RequestList& list)
{
  this->add(list, [](const Request&) { return true; });
}

void RequestRanking::add(const RequestList& list,
                         const std::function<bool(const Request&)>& isWanted)
{
  for (const Request& request : list.entries()) {
    if (isWanted(request)) {
      this->add(request.key, static_cast<double>(request.contribution));
    }
  }
}

void RequestRanking::add(BrickKey key, double contribution)
{
  const auto place = this->Places.try_emplace(key, this->Sums.size());
  if (place.second) {
    this->Sums.push_back({key, 0.0});
  }
  this->Sums[place.first->second].contribution += contribution;
}

RequestRanking RequestRanking::replaced(const std::function<BrickKey(BrickKey)>& instead) const
{
  RequestRanking others;
  for (const Sum& sum : this->Sums) {
    others.add(instead(sum.key), sum.contribution);
  }
  return others;
}

std::vector<BrickKey> RequestRanking::ranked(std::int64_t most, bool byContribution) const
{
  std::vector<Sum> sums = this->Sums;
  const auto count = static_cast<std::ptrdiff_t>(std::min(most, this->count()));
  if (byContribution) {
    const auto before = [](const Sum& a, const Sum& b) {
      if (a.contribution != b.contribution) {
        return a.contribution > b.contribution;
      }
      const int levelA = IdOf(a.key).level;
      const int levelB = IdOf(b.key).level;
      return levelA != levelB ? levelA > levelB : a.key < b.key;
    };
    std::partial_sort(sums.begin(), sums.begin() + count, sums.end(), before);
  }
  std::vector<BrickKey> keys;
  for (auto sum = sums.begin(); sum != sums.begin() + count; ++sum) {
    keys.push_back(sum->key);
  }
  return keys;
}

} // namespace inr

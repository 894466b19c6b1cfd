// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickKey.h"

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

namespace inr {

/// One wish for a brick.
struct Request
{
  BrickKey key;
  float contribution; ///< part of the light that reaches a sample, summed over those that want it
};

/// What one tile's rays missed, in the order in which they did.
class RequestList
{
public:
  void add(BrickKey key, float contribution);
  const std::vector<Request>& entries() const { return this->Entries; }

private:
  std::vector<Request> Entries;
};

/// The wishes of a whole picture. Lists are added in the order of their tiles, so that sums do not
/// depend on threads.
class RequestRanking
{
public:
  void add(const RequestList& list);
  /// Those of which `isWanted` says so.
  void add(const RequestList& list, const std::function<bool(const Request&)>& isWanted);
  bool empty() const { return this->Sums.empty(); }
  std::int64_t count() const { return static_cast<std::int64_t>(this->Sums.size()); } ///< bricks

  /// Each wish as one for the brick that `instead` gives in place of its own.
  RequestRanking replaced(const std::function<BrickKey(BrickKey)>& instead) const;

  /// At most `most` bricks: by falling contribution (coarser levels, then smaller keys first among
  /// equals), or in the order in which they were first wanted.
  std::vector<BrickKey> ranked(std::int64_t most, bool byContribution) const;

private:
  void add(BrickKey key, double contribution);

  struct Sum
  {
    BrickKey key;
    double contribution;
  };

  std::vector<Sum> Sums;
  std::unordered_map<BrickKey, std::size_t> Places; ///< in Sums
};

} // namespace inr

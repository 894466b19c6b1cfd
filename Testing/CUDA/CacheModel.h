// SPDX-License-Identifier: BSD-3-Clause
//
// What a DeviceCache is to do, brick by brick.
#pragma once

#include "Core/Cache/Requests.h"

#include <algorithm>
#include <map>
#include <vector>

class CacheModel
{
public:
  struct Loaded
  {
    std::int64_t loaded = 0;
    bool full = false;
  };

  CacheModel(const inr::Hierarchy& levels, std::int64_t capacity)
      : Coarsest(levels.coarsest()), Uses(static_cast<std::size_t>(capacity)),
        Owners(static_cast<std::size_t>(capacity))
  {
    this->put(0, this->Coarsest);
  }

  const std::map<inr::BrickKey, std::size_t>& slots() const { return this->Slots; }

  void beginFrame() { ++this->Frame; }

  /// Uses what is there and asks for the rest.
  void ask(inr::BrickKey key, float contribution)
  {
    const auto place = this->Slots.find(key);
    if (place != this->Slots.end()) {
      this->Uses[place->second] = this->Frame;
    } else {
      this->Wishes.add(key, contribution);
    }
  }
  std::int64_t wishes() const { return this->ranking().count(); }

  Loaded load(std::int64_t most, bool byContribution)
  {
    return this->store(this->list(most, byContribution));
  }

  /// What is to come in; forgets all wishes.
  std::vector<inr::BrickKey> list(std::int64_t most, bool byContribution)
  {
    std::vector<inr::BrickKey> keys = this->ranking().ranked(this->wishes(), byContribution);
    if (!byContribution) {
      std::sort(keys.begin(), keys.end(), [](inr::BrickKey a, inr::BrickKey b) {
        const int levelA = inr::IdOf(a).level;
        const int levelB = inr::IdOf(b).level;
        return levelA != levelB ? levelA > levelB : a < b;
      });
    }
    const auto isMapped = [this](inr::BrickKey key) { return this->Slots.count(key) > 0; };
    keys.erase(std::remove_if(keys.begin(), keys.end(), isMapped), keys.end());
    this->Wanted = std::min(keys.size(), static_cast<std::size_t>(most));
    keys.resize(std::min(this->Wanted, this->replaceable()));
    this->Wishes = {};
    return keys;
  }

  Loaded store(const std::vector<inr::BrickKey>& keys)
  {
    std::int64_t stored = 0;
    for (const inr::BrickKey key : keys) {
      const std::size_t slot = this->oldest();
      if (slot == 0) {
        break;
      }
      this->put(slot, key);
      ++stored;
    }
    return {stored, stored < static_cast<std::int64_t>(this->Wanted)};
  }

  void clear()
  {
    std::fill(this->Uses.begin() + 1, this->Uses.end(), 0);
    this->Slots = {{this->Coarsest, 0}};
  }

private:
  inr::RequestRanking ranking() const
  {
    inr::RequestRanking ranking;
    ranking.add(this->Wishes);
    return ranking;
  }

  std::size_t replaceable() const
  {
    const auto mayGo = [this](std::uint64_t use) { return use < this->Frame; };
    return static_cast<std::size_t>(std::count_if(this->Uses.begin() + 1, this->Uses.end(), mayGo));
  }

  /// 0 where there is none: that one stays.
  std::size_t oldest() const
  {
    std::size_t oldest = 0;
    for (std::size_t slot = 1; slot < this->Uses.size(); ++slot) {
      if (this->Uses[slot] < (oldest == 0 ? this->Frame : this->Uses[oldest])) {
        oldest = slot;
      }
    }
    return oldest;
  }

  void put(std::size_t slot, inr::BrickKey key)
  {
    if (this->Uses[slot] > 0) {
      this->Slots.erase(this->Owners[slot]);
    }
    this->Uses[slot] = this->Frame;
    this->Owners[slot] = key;
    this->Slots[key] = slot;
  }

  inr::BrickKey Coarsest;
  std::uint64_t Frame = 1;
  std::vector<std::uint64_t> Uses; ///< 0: free
  std::vector<inr::BrickKey> Owners;
  std::map<inr::BrickKey, std::size_t> Slots;
  inr::RequestList Wishes;
  std::size_t Wanted = 0; ///< of what was listed last, before slots were counted
};

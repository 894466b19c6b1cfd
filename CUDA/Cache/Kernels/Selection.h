// SPDX-License-Identifier: BSD-3-Clause
//
// The first few of many entries in a total order, sorted. By tournament: a block sorts a chunk of
// them and passes its first ones on, until there is one chunk. As no two entries are equal, the
// result does not depend on threads.
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// What is sorted: by major, then by minor, the least first.
struct alignas(16) RankEntry
{
  std::uint64_t major;
  std::uint64_t minor;

  /// Behind all others, and none itself.
  INR_HOST_DEVICE static RankEntry None() { return {~std::uint64_t{0}, ~std::uint64_t{0}}; }
  INR_HOST_DEVICE bool isNone() const { return (this->major & this->minor) == ~std::uint64_t{0}; }
  INR_HOST_DEVICE bool isBefore(const RankEntry& other) const
  {
    return this->major != other.major ? this->major < other.major : this->minor < other.minor;
  }
};

constexpr int SelectionChunk = 2048;             ///< entries that a block sorts
constexpr int MostSelected = SelectionChunk / 2; ///< so that every pass leaves fewer
constexpr std::int64_t SelectionSharedBytes = SelectionChunk * sizeof(RankEntry);

INR_HOST_DEVICE inline std::int64_t SelectionChunks(std::int64_t entries)
{
  return entries > SelectionChunk ? (entries + SelectionChunk - 1) / SelectionChunk : 1;
}

/// Entries that a pass leaves where each chunk leaves `most`.
INR_HOST_DEVICE inline std::int64_t SelectionSurvivors(std::int64_t entries, std::int64_t most)
{
  return SelectionChunks(entries) * most;
}

/// Bytes for what the passes leave, see Selector.
INR_HOST_DEVICE inline std::int64_t SelectionBytes(std::int64_t entries, std::int64_t most)
{
  const std::int64_t survivors = SelectionSurvivors(entries, most);
  return (survivors + SelectionSurvivors(survivors, most)) *
         static_cast<std::int64_t>(sizeof(RankEntry));
}

/// One pass. `Source` gives entry k, or None.
template <class Source> struct SelectFirst
{
  static constexpr int Threads = 512;

  Source source;
  std::int64_t count;
  std::int64_t most;   ///< of each chunk, at most MostSelected
  RankEntry* selected; ///< `most` of each chunk, None where it has no more

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    RankEntry* const entries = reinterpret_cast<RankEntry*>(block.shared());
    for (std::int64_t k = block.index(); k < SelectionChunks(this->count); k += block.count()) {
      block.threads([&](int thread) {
        for (int i = thread; i < SelectionChunk; i += Threads) {
          const std::int64_t from = k * SelectionChunk + i;
          entries[i] = from < this->count ? this->source(from) : RankEntry::None();
        }
      });
      Sort(block, entries);
      block.threads([&](int thread) {
        for (std::int64_t i = thread; i < this->most; i += Threads) {
          this->selected[k * this->most + i] = entries[i];
        }
      });
    }
  }

private:
  /// Batcher's bitonic sorting network.
  template <class Block> INR_HOST_DEVICE static void Sort(Block& block, RankEntry* entries)
  {
    for (int size = 2; size <= SelectionChunk; size *= 2) {
      for (int reach = size / 2; reach > 0; reach /= 2) {
        block.threads([&](int thread) {
          for (int pair = thread; pair < SelectionChunk / 2; pair += Threads) {
            const int a = 2 * pair - (pair & (reach - 1));
            const bool rising = (a & size) == 0;
            Order(entries[rising ? a : a + reach], entries[rising ? a + reach : a]);
          }
        });
      }
    }
  }

  INR_HOST_DEVICE static void Order(RankEntry& first, RankEntry& second)
  {
    if (second.isBefore(first)) {
      const RankEntry kept = first;
      first = second;
      second = kept;
    }
  }
};

/// What a pass has left.
struct SelectedEntries
{
  const RankEntry* entries;

  INR_HOST_DEVICE RankEntry operator()(std::int64_t k) const { return this->entries[k]; }
};

} // namespace cuda
} // namespace inr

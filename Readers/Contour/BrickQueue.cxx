// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Contour/BrickQueue.h"

#include <algorithm>
#include <limits>

BrickQueue::BrickQueue(const std::vector<inr::BrickKey>& keys, int piece, int pieces)
{
  const std::size_t count = keys.size();
  const auto begin = count * static_cast<std::size_t>(piece) / static_cast<std::size_t>(pieces);
  const auto end = count * static_cast<std::size_t>(piece + 1) / static_cast<std::size_t>(pieces);
  this->First = begin == 0 || begin == count ? 0 : keys[begin];
  this->End = end == count ? std::numeric_limits<inr::BrickKey>::max() : keys[end];
  this->Waiting.assign(keys.begin() + static_cast<std::ptrdiff_t>(begin),
                       keys.begin() + static_cast<std::ptrdiff_t>(end));
  this->Known.insert(this->Waiting.begin(), this->Waiting.end());
}

std::vector<inr::BrickKey> BrickQueue::Next(std::size_t count)
{
  const std::size_t end = std::min(this->Waiting.size(), this->Done + count);
  std::vector<inr::BrickKey> keys(this->Waiting.begin() + static_cast<std::ptrdiff_t>(this->Done),
                                  this->Waiting.begin() + static_cast<std::ptrdiff_t>(end));
  this->Done = end;
  return keys;
}

void BrickQueue::Follow(inr::BrickKey key, const bool (&reaches)[6], const glm::i64vec3& bricks)
{
  for (int face = 0; face < 6; ++face) {
    inr::BrickId next = inr::IdOf(key);
    next.at[face / 2] += face % 2 == 0 ? -1 : 1;
    const std::int64_t at = next.at[face / 2];
    if (!reaches[face] || at < 0 || at >= bricks[face / 2]) {
      continue;
    }
    const inr::BrickKey neighbour = inr::KeyOf(next);
    if (this->IsMine(neighbour) && this->Known.insert(neighbour).second) {
      this->Waiting.push_back(neighbour);
    }
  }
}

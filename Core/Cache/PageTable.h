// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Hierarchy.h"
#include "Core/Cache/ReservedArray.h"

#include <cstdint>
#include <vector>

namespace inr {

/// Where the mapped bricks are: brick -> slot. Virtual: a page covers 4 x 4 x 4 bricks of a level
/// and exists only while one of them is mapped; a hash table finds the pages. So its memory follows
/// what is mapped at the time, not the volume. Reading is for any number of threads, changing for
/// one while nobody reads.
class PageTable
{
public:
  static constexpr std::int32_t Unmapped = -1;

  /// Room for `bricks` mapped bricks, wherever in the volume they are.
  explicit PageTable(std::int64_t bricks);
  /// Bytes that a table takes at most while so many are mapped.
  static std::int64_t bytesFor(std::int64_t bricks);

  std::int32_t find(BrickKey key) const
  {
    const std::int32_t page = this->pageOf(PageKey(key));
    return page < 0 ? Unmapped : this->Entries[EntryOf(page, key)];
  }
  /// Takes what memory mapping another brick may take; all else that changes the table then takes
  /// none, and cannot fail.
  void makeRoomForOne();
  /// `key` must not be mapped yet, and no more bricks than there is room for.
  void map(BrickKey key, std::int32_t slot);
  /// For a mapped `key` whose brick has moved.
  void move(BrickKey key, std::int32_t slot);
  /// `key` must be mapped.
  void unmap(BrickKey key);
  std::int64_t pages() const { return this->Keys.size(); }

private:
  static constexpr int PageBits = 2;
  static constexpr std::int64_t EntriesPerPage = std::int64_t{1} << (3 * PageBits);
  static constexpr BrickKey NoPage = ~BrickKey{0};

  struct Bucket
  {
    BrickKey page = NoPage;
    std::int32_t at = -1;
  };

  static BrickKey PageKey(BrickKey key);
  static std::int64_t EntryOf(std::int32_t page, BrickKey key);
  std::size_t home(BrickKey page) const;
  /// Of a page's bucket or, where it has none, the one that it would get.
  std::size_t bucketOf(BrickKey page) const;
  std::int32_t pageOf(BrickKey page) const { return this->Directory[this->bucketOf(page)].at; }
  std::int32_t makePage(BrickKey page);
  void dropPage(std::int32_t at);
  void eraseBucket(std::size_t hole);
  void resizeDirectory(std::size_t size);

  std::vector<Bucket> Directory; ///< open addressing, linear probing, an eighth to a half full
  ReservedArray<std::int32_t> Entries;
  ReservedArray<BrickKey> Keys;       ///< of the pages
  ReservedArray<std::int32_t> Mapped; ///< entries in use, of each page
};

} // namespace inr

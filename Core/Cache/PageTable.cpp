// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/PageTable.h"

#include "Core/Random.h"

namespace inr {

namespace {

std::int64_t DirectorySize(std::int64_t pages)
{
  std::int64_t size = 16;
  while (size < 2 * pages) {
    size *= 2;
  }
  return size;
}

} // namespace

// Bricks that share no page are the worst case, and there is room for it.
PageTable::PageTable(std::int64_t bricks)
    : Directory(static_cast<std::size_t>(DirectorySize(bricks))),
      Entries(static_cast<std::size_t>(bricks * EntriesPerPage), Unmapped),
      Mapped(static_cast<std::size_t>(bricks), 0)
{
  // Growing would take more than was asked for.
  this->Free.reserve(static_cast<std::size_t>(bricks));
  for (auto page = static_cast<std::int32_t>(bricks); page > 0; --page) {
    this->Free.push_back(page - 1);
  }
}

std::int64_t PageTable::bytesFor(std::int64_t bricks)
{
  constexpr auto word = static_cast<std::int64_t>(sizeof(std::int32_t));
  return DirectorySize(bricks) * static_cast<std::int64_t>(sizeof(Bucket)) +
         bricks * (EntriesPerPage + 2) * word;
}

// Both take the key apart where it stands: they are what every brick on a ray's way costs.
BrickKey PageTable::PageKey(BrickKey key)
{
  constexpr BrickKey within = (BrickKey{1} << PageBits) - 1;
  constexpr BrickKey all = within | within << BrickAxisBits | within << (2 * BrickAxisBits);
  return key & ~all;
}

std::size_t PageTable::EntryOf(std::int32_t page, BrickKey key)
{
  constexpr BrickKey within = (BrickKey{1} << PageBits) - 1;
  const BrickKey x = key & within;
  const BrickKey y = key >> BrickAxisBits & within;
  const BrickKey z = key >> (2 * BrickAxisBits) & within;
  return static_cast<std::size_t>(page) * EntriesPerPage +
         (x | y << PageBits | z << (2 * PageBits));
}

std::size_t PageTable::home(BrickKey page) const
{
  return static_cast<std::size_t>(MixBits(page)) & (this->Directory.size() - 1);
}

std::int32_t PageTable::pageOf(BrickKey page) const
{
  std::size_t bucket = this->home(page);
  while (this->Directory[bucket].page != page) {
    if (this->Directory[bucket].page == NoPage) {
      return -1;
    }
    bucket = (bucket + 1) & (this->Directory.size() - 1);
  }
  return this->Directory[bucket].at;
}

void PageTable::insertPage(BrickKey page, std::int32_t at)
{
  std::size_t bucket = this->home(page);
  while (this->Directory[bucket].page != NoPage) {
    bucket = (bucket + 1) & (this->Directory.size() - 1);
  }
  this->Directory[bucket] = {page, at};
}

void PageTable::erasePage(BrickKey page)
{
  const std::size_t mask = this->Directory.size() - 1;
  std::size_t hole = this->home(page);
  while (this->Directory[hole].page != page) {
    hole = (hole + 1) & mask;
  }
  // Pages behind the hole move into it unless that would put them before their home.
  for (std::size_t next = (hole + 1) & mask; this->Directory[next].page != NoPage;
       next = (next + 1) & mask) {
    const std::size_t distance = (next - this->home(this->Directory[next].page)) & mask;
    if (distance >= ((next - hole) & mask)) {
      this->Directory[hole] = this->Directory[next];
      hole = next;
    }
  }
  this->Directory[hole] = {};
}

void PageTable::map(BrickKey key, std::int32_t slot)
{
  const BrickKey page = PageKey(key);
  std::int32_t at = this->pageOf(page);
  if (at < 0) {
    at = this->Free.back();
    this->Free.pop_back();
    this->insertPage(page, at);
  }
  this->Entries[EntryOf(at, key)] = slot;
  ++this->Mapped[static_cast<std::size_t>(at)];
}

void PageTable::unmap(BrickKey key)
{
  const BrickKey page = PageKey(key);
  const std::int32_t at = this->pageOf(page);
  this->Entries[EntryOf(at, key)] = Unmapped;
  if (--this->Mapped[static_cast<std::size_t>(at)] == 0) {
    this->erasePage(page);
    this->Free.push_back(at);
  }
}

} // namespace inr

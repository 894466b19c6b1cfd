// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/PageTable.h"

#include "Core/Random.h"

#include <algorithm>
#include <new>

namespace inr {

namespace {
constexpr std::size_t SmallestDirectory = 16;
}

// Bricks that share no page are the worst case, and there is room for it.
PageTable::PageTable(std::int64_t bricks)
    : Directory(SmallestDirectory), Entries(bricks * EntriesPerPage), Keys(bricks), Mapped(bricks)
{}

std::int64_t PageTable::bytesFor(std::int64_t bricks)
{
  constexpr auto bucket = static_cast<std::int64_t>(sizeof(Bucket));
  constexpr auto word = static_cast<std::int64_t>(sizeof(std::int32_t));
  constexpr auto key = static_cast<std::int64_t>(sizeof(BrickKey));
  return static_cast<std::int64_t>(SmallestDirectory) * bucket +
         bricks * (8 * bucket + (EntriesPerPage + 1) * word + key);
}

// Both take the key apart where it stands: they are what every brick on a ray's way costs.
BrickKey PageTable::PageKey(BrickKey key)
{
  constexpr BrickKey within = (BrickKey{1} << PageBits) - 1;
  constexpr BrickKey all = within | within << BrickAxisBits | within << (2 * BrickAxisBits);
  return key & ~all;
}

std::int64_t PageTable::EntryOf(std::int32_t page, BrickKey key)
{
  constexpr BrickKey within = (BrickKey{1} << PageBits) - 1;
  const BrickKey x = key & within;
  const BrickKey y = key >> BrickAxisBits & within;
  const BrickKey z = key >> (2 * BrickAxisBits) & within;
  return page * EntriesPerPage + static_cast<std::int64_t>(x | y << PageBits | z << (2 * PageBits));
}

std::size_t PageTable::home(BrickKey page) const
{
  return static_cast<std::size_t>(MixBits(page)) & (this->Directory.size() - 1);
}

std::size_t PageTable::bucketOf(BrickKey page) const
{
  std::size_t bucket = this->home(page);
  while (this->Directory[bucket].page != page && this->Directory[bucket].page != NoPage) {
    bucket = (bucket + 1) & (this->Directory.size() - 1);
  }
  return bucket;
}

void PageTable::resizeDirectory(std::size_t size)
{
  std::vector<Bucket> directory(size);
  this->Directory.swap(directory);
  for (std::int32_t at = 0; at < this->pages(); ++at) {
    this->Directory[this->bucketOf(this->Keys[at])] = {this->Keys[at], at};
  }
}

void PageTable::eraseBucket(std::size_t hole)
{
  const std::size_t mask = this->Directory.size() - 1;
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

void PageTable::makeRoomForOne()
{
  if (2 * (static_cast<std::size_t>(this->pages()) + 1) > this->Directory.size()) {
    this->resizeDirectory(2 * this->Directory.size());
  }
}

std::int32_t PageTable::makePage(BrickKey page)
{
  const auto at = static_cast<std::int32_t>(this->pages());
  this->makeRoomForOne();
  this->Keys.resize(at + 1);
  this->Mapped.resize(at + 1);
  this->Entries.resize((at + 1) * EntriesPerPage);
  this->Keys[at] = page;
  this->Mapped[at] = 0;
  std::fill_n(&this->Entries[at * EntriesPerPage], EntriesPerPage, Unmapped);
  this->Directory[this->bucketOf(page)] = {page, at};
  return at;
}

// The last page moves into its place, so that those in use stay together.
void PageTable::dropPage(std::int32_t at)
{
  const auto last = static_cast<std::int32_t>(this->pages() - 1);
  this->eraseBucket(this->bucketOf(this->Keys[at]));
  if (at != last) {
    this->Keys[at] = this->Keys[last];
    this->Mapped[at] = this->Mapped[last];
    std::copy_n(&this->Entries[last * EntriesPerPage], EntriesPerPage,
                &this->Entries[at * EntriesPerPage]);
    this->Directory[this->bucketOf(this->Keys[at])].at = at;
  }
  this->Keys.resize(last);
  this->Mapped.resize(last);
  this->Entries.resize(last * EntriesPerPage);
  const std::size_t size = this->Directory.size();
  if (size > SmallestDirectory && 8 * static_cast<std::size_t>(last) < size) {
    try {
      this->resizeDirectory(size / 2);
    } catch (const std::bad_alloc&) { // then it stays as large as it is
    }
  }
}

void PageTable::map(BrickKey key, std::int32_t slot)
{
  const BrickKey page = PageKey(key);
  const std::int32_t known = this->pageOf(page);
  const std::int32_t at = known < 0 ? this->makePage(page) : known;
  this->Entries[EntryOf(at, key)] = slot;
  ++this->Mapped[at];
}

void PageTable::move(BrickKey key, std::int32_t slot)
{
  this->Entries[EntryOf(this->pageOf(PageKey(key)), key)] = slot;
}

void PageTable::unmap(BrickKey key)
{
  const std::int32_t at = this->pageOf(PageKey(key));
  this->Entries[EntryOf(at, key)] = Unmapped;
  if (--this->Mapped[at] == 0) {
    this->dropPage(at);
  }
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/ReservedArray.h"

#include "Core/Error.h"

#include <algorithm>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace inr {

namespace {

std::int64_t WholePages(std::int64_t bytes)
{
  const std::int64_t page = sysconf(_SC_PAGESIZE);
  return (bytes + page - 1) / page * page;
}

} // namespace

ReservedMemory::ReservedMemory(std::int64_t bytes)
    : Data(nullptr), Bytes(static_cast<std::size_t>(WholePages(std::max<std::int64_t>(bytes, 1))))
{
  this->Data = mmap(nullptr, this->Bytes, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (this->Data == MAP_FAILED) {
    throw Error(ErrorCode::TooLarge, "the system does not lend " + std::to_string(bytes) +
                                         " bytes of memory; take a smaller cache");
  }
}

ReservedMemory::~ReservedMemory() { munmap(this->Data, this->Bytes); }

void ReservedMemory::giveBack(std::int64_t begin, std::int64_t end) const
{
  const std::int64_t first = WholePages(begin);
  const std::int64_t last = WholePages(end);
  if (first < last) {
    madvise(static_cast<unsigned char*>(this->Data) + first, static_cast<std::size_t>(last - first),
            MADV_DONTNEED);
  }
}

} // namespace inr

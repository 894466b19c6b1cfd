// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Core/Memory/FailingMemory.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

constexpr std::int64_t Never = -1;
// Plain values: memory is asked for before main and after it.
std::atomic<std::int64_t> FirstToFail{Never};
std::atomic<bool> FailsOnce{false};
std::atomic<std::int64_t> Asked{0};
std::atomic<std::int64_t> Failed{0};
std::atomic<std::int64_t> InUse{0};

bool Fails()
{
  const std::int64_t first = FirstToFail.load();
  if (first == Never) {
    return false;
  }
  const std::int64_t now = ++Asked;
  const bool fails = FailsOnce ? now == first : now >= first;
  Failed += fails ? 1 : 0;
  return fails;
}

void* Take(std::size_t bytes, std::size_t alignment)
{
  if (Fails()) {
    return nullptr;
  }
  const std::size_t least = std::max<std::size_t>(bytes, 1);
  void* const memory =
      alignment <= alignof(std::max_align_t)
          ? std::malloc(least)
          : std::aligned_alloc(alignment, (least + alignment - 1) / alignment * alignment);
  InUse += memory != nullptr ? 1 : 0;
  return memory;
}

void* TakeOrThrow(std::size_t bytes, std::size_t alignment)
{
  void* const memory = Take(bytes, alignment);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

void Give(void* memory)
{
  InUse -= memory != nullptr ? 1 : 0;
  std::free(memory);
}

constexpr std::size_t Usual = alignof(std::max_align_t);

} // namespace

FailingMemory::FailingMemory(std::int64_t nth, For how)
{
  Asked = 0;
  Failed = 0;
  FailsOnce = how == For::Once;
  FirstToFail = nth;
}

FailingMemory::~FailingMemory() { FirstToFail = Never; }

bool FailingMemory::hasFailed() const { return Failed > 0; }
std::int64_t FailingMemory::asked() const { return Asked; }

std::int64_t BlocksInUse() { return InUse; }

void* operator new(std::size_t bytes) { return TakeOrThrow(bytes, Usual); }
void* operator new[](std::size_t bytes) { return TakeOrThrow(bytes, Usual); }
void* operator new(std::size_t bytes, std::align_val_t alignment)
{
  return TakeOrThrow(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment)
{
  return TakeOrThrow(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return Take(bytes, Usual); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept
{
  return Take(bytes, Usual);
}
void operator delete(void* memory) noexcept { Give(memory); }
void operator delete[](void* memory) noexcept { Give(memory); }
void operator delete(void* memory, std::size_t) noexcept { Give(memory); }
void operator delete[](void* memory, std::size_t) noexcept { Give(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { Give(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { Give(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { Give(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { Give(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { Give(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { Give(memory); }

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/CacheLine.h"

#include <cstddef>
#include <new>
#include <vector>

namespace inr {

/// Memory that begins at a cache line.
template <class T> struct LineAllocator
{
  using value_type = T;
  static constexpr std::align_val_t Line{CacheLineBytes};
  static_assert(alignof(T) <= CacheLineBytes, "begins at lines, not at more");

  LineAllocator() = default;
  template <class Other> LineAllocator(const LineAllocator<Other>&) noexcept {}

  T* allocate(std::size_t count)
  {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) {
      throw std::bad_array_new_length();
    }
    return static_cast<T*>(::operator new(count * sizeof(T), Line));
  }
  void deallocate(T* memory, std::size_t) noexcept { ::operator delete(memory, Line); }
};

template <class A, class B> bool operator==(const LineAllocator<A>&, const LineAllocator<B>&)
{
  return true;
}
template <class A, class B> bool operator!=(const LineAllocator<A>&, const LineAllocator<B>&)
{
  return false;
}

/// A vector that begins at a cache line. The features of a table entry, or the lanes of a vector,
/// then lie in one line and not in two, which would be twice the reads of memory: if what lies in
/// front of them fills whole lines, as the weights of networks do that are a multiple of 16 wide.
template <class T> using AlignedVector = std::vector<T, LineAllocator<T>>;

} // namespace inr

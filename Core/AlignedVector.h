// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace inr {

/// Memory that begins at a cache line.
template <class T> struct LineAllocator
{
  using value_type = T;
  static constexpr std::align_val_t Line{64};

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
/// then lie in one line and not in two, which would be twice the reads of memory.
template <class T> using AlignedVector = std::vector<T, LineAllocator<T>>;

} // namespace inr

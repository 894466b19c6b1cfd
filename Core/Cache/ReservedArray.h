// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace inr {

/// A range of addresses of which the operating system lends the memory when it is first written to.
class ReservedMemory
{
public:
  /// Throws Error(TooLarge) when there are not so many addresses to be had.
  explicit ReservedMemory(std::int64_t bytes);
  ~ReservedMemory();
  ReservedMemory(const ReservedMemory&) = delete;
  ReservedMemory& operator=(const ReservedMemory&) = delete;

  void* data() const { return this->Data; }
  /// Gives the memory of [begin, end) back, where nothing behind `end` is in use. What was there is
  /// lost. Pages that begin before `begin` stay.
  void giveBack(std::int64_t begin, std::int64_t end) const;

private:
  void* Data;
  std::size_t Bytes;
};

/// An array that never moves and takes memory for the elements that it has, and some kilobytes that
/// it had. New ones have no value; the very first ones of their places are of zeros.
template <typename Element> class ReservedArray
{
  static_assert(std::is_trivially_destructible_v<Element>);

public:
  explicit ReservedArray(std::int64_t room) : Memory(room * Bytes) {}

  std::int64_t size() const { return this->Count; }
  Element* data() const { return static_cast<Element*>(this->Memory.data()); }
  Element& operator[](std::int64_t k) const { return this->data()[k]; }
  /// `count`: no more than there is room for.
  void resize(std::int64_t count)
  {
    // Not at once: one that goes is often followed by one that comes.
    constexpr std::int64_t kept = 16 << 10;
    if ((this->Touched - count) * Bytes > kept) {
      this->Memory.giveBack(count * Bytes, this->Touched * Bytes);
      this->Touched = count;
    }
    this->Touched = std::max(this->Touched, count);
    this->Count = count;
  }

private:
  static constexpr auto Bytes = static_cast<std::int64_t>(sizeof(Element));

  ReservedMemory Memory;
  std::int64_t Count = 0;
  std::int64_t Touched = 0; ///< elements whose memory was not given back
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace inr {
namespace cuda {

/// Arrays in a machine's memory that come and go together: what a frame brings, say. The memory
/// stays for the next ones, as taking and giving it back makes a GPU wait for all that it does.
template <class Machine> class Belongings
{
public:
  /// A copy of `count` numbers there, until clear; null of none.
  template <class T> T* put(Machine& machine, const T* from, std::int64_t count)
  {
    if (from == nullptr || count == 0) {
      return nullptr;
    }
    const std::int64_t bytes = count * static_cast<std::int64_t>(sizeof(T));
    const std::int64_t taken = (bytes + Alignment - 1) / Alignment * Alignment;
    if (this->Chunks.empty() || this->Used + taken > this->Chunks.back().size()) {
      const std::int64_t size = std::max({taken, this->Wanted, Smallest});
      this->Chunks.push_back(machine.template allocate<unsigned char>(size));
      this->Used = 0;
    }
    auto* const to = reinterpret_cast<T*>(this->Chunks.back().data() + this->Used);
    this->Used += taken;
    this->Total += taken;
    machine.toMachine(to, from, count);
    return to;
  }

  /// Forgets them all; nothing that reads them may be on its way.
  void clear()
  {
    if (this->Chunks.size() > 1) { // room for all of them in one, next time
      this->Chunks.clear();
      this->Wanted = this->Total;
    }
    this->Used = 0;
    this->Total = 0;
  }

private:
  static constexpr std::int64_t Alignment = 256;
  static constexpr std::int64_t Smallest = 1 << 16;

  std::vector<typename Machine::template Array<unsigned char>> Chunks;
  std::int64_t Used = 0;   ///< bytes of the last one
  std::int64_t Total = 0;  ///< since clear
  std::int64_t Wanted = 0; ///< of the first one
};

} // namespace cuda
} // namespace inr

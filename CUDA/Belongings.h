// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

namespace inr {
namespace cuda {

/// Arrays in a machine's memory that live together: what a frame brings, say.
template <class Machine> class Belongings
{
public:
  /// A copy of `count` numbers there; null of none.
  template <class T> T* put(Machine& machine, const T* from, std::int64_t count)
  {
    if (from == nullptr || count == 0) {
      return nullptr;
    }
    this->Arrays.push_back(
        machine.template allocate<unsigned char>(count * static_cast<std::int64_t>(sizeof(T))));
    auto* const to = reinterpret_cast<T*>(this->Arrays.back().data());
    machine.toMachine(to, from, count);
    return to;
  }

  void clear() { this->Arrays.clear(); }

private:
  std::vector<typename Machine::template Array<unsigned char>> Arrays;
};

} // namespace cuda
} // namespace inr

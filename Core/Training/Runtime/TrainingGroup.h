// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/LittleEndian.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace inr {

/// What all processes gave; its memory is kept from one time to the next.
struct GatheredBytes
{
  std::vector<char> bytes;         ///< and maybe some that were there before
  std::vector<std::size_t> begins; ///< of the processes' parts
};

/// Processes that train one model together, each from the piece of the volume that it holds. All of
/// them make the same calls in the same order; a call ends when all have made it. This one is a
/// process on its own.
class TrainingGroup
{
public:
  virtual ~TrainingGroup() = default;

  virtual int rank() const { return 0; } ///< of this process: 0 to size() - 1
  virtual int size() const { return 1; }

  /// The bytes that each process gives, in the order of ranks, the same for all. Throws Error when
  /// a process cannot be reached.
  virtual std::vector<std::string> gather(const std::string& bytes) const { return {bytes}; }

  /// The same for megabytes that are told often; less than 2 GiB in all.
  virtual void gatherInto(const char* bytes, std::size_t count, GatheredBytes& all) const;

  /// Of bytes that each process has for each of them, what is for this one: less than 2 GiB. Those
  /// for rank 0, 1, ... begin at `begins`, which also says where the last ones end.
  virtual void distribute(const char* bytes, const std::vector<std::size_t>& begins,
                          GatheredBytes& mine) const;

  /// What rank 0 gives.
  std::string fromFirst(const std::string& bytes) const;

  /// The same of a plain value.
  template <typename T> T valueOfFirst(const T& value) const
  {
    const std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
    return FromBytes<T>(this->fromFirst(bytes).data());
  }

  /// The plain values that the processes give, in the order of ranks.
  template <typename T> std::vector<T> valuesOfAll(const T& value) const
  {
    const std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
    std::vector<T> values;
    for (const std::string& other : this->gather(bytes)) {
      values.push_back(FromBytes<T>(other.data()));
    }
    return values;
  }

  /// Whether all processes say so, or any.
  bool all(bool said) const;
  bool any(bool said) const { return !this->all(!said); }

  /// Does `work`, which must not call the group, in each process. Where it throws Error in some,
  /// all throw that of the first of them, which says whose it is if it is another's.
  void together(const std::function<void()>& work) const;
};

} // namespace inr

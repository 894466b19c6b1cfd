// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// Whether a path-traced picture wants more bricks than the cache can hold, or keep for it: what is
/// known of that from one of its rounds to the next.
class PathShortage
{
public:
  /// Before a round. `first`: of its picture; what fits is tried again then, but where somebody
  /// `waits` for all of the picture, what did not fit a moment ago is taken not to. `contested`:
  /// bricks have gone since the round before.
  void begin(bool first, bool waits, bool contested)
  {
    if (first) {
      this->Known = this->Known != Knowledge::Fits && waits ? Knowledge::Guessed : Knowledge::Fits;
    } else if (contested) {
      this->Known = Knowledge::Lacks;
    }
  }

  /// After a round, which wanted so many bricks that were not there: whether a guess was right.
  void check(std::int64_t wanted, std::int64_t room)
  {
    if (this->Known == Knowledge::Guessed) {
      this->Known = wanted > room ? Knowledge::Lacks : Knowledge::Fits;
    }
  }

  /// A round wanted more bricks than there is room for.
  void note() { this->Known = Knowledge::Lacks; }

  /// As far as is known.
  bool lacks() const { return this->Known != Knowledge::Fits; }

private:
  enum class Knowledge { Fits, Guessed, Lacks };

  Knowledge Known = Knowledge::Fits;
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace inr {

/// Cores this process may run on (its affinity mask), at least 1.
int AvailableCores();

/// The same number in all processes that may run on the same cores of the same machine, and hardly
/// ever in others.
std::uint64_t AvailableCoresKey();

/// The same number in all processes of a machine, and hardly ever in others.
std::uint64_t MachineKey();

/// A set of worker threads of our own, apart from the host application's.
///
/// Work is cut into blocks whose limits depend on the arguments only, never on the number of
/// threads; a caller that reduces per block and then over blocks in order gets the same bits on
/// any machine.
class Arena
{
public:
  /// `threads` <= 0 means AvailableCores().
  explicit Arena(int threads = 0);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  int threads() const;

  /// Calls `body(begin, end)` for the blocks [k*block, min((k+1)*block, count)), block > 0.
  /// Exceptions thrown by `body` come out of this call. May be called from several threads at once.
  void forEachBlock(std::int64_t count, std::int64_t block,
                    const std::function<void(std::int64_t begin, std::int64_t end)>& body) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Self;
};

} // namespace inr

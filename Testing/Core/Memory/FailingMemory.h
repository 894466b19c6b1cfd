// SPDX-License-Identifier: BSD-3-Clause
//
// Memory that runs out when a test wants it to: this program's operators new. What libraries take
// from malloc directly is not touched.
#pragma once

#include <cstdint>

/// While it exists, the n-th allocation from its making on fails, counted over all threads; once,
/// or together with all that follow.
class FailingMemory
{
public:
  enum class For { Once, Good };

  FailingMemory(std::int64_t nth, For how);
  ~FailingMemory();
  FailingMemory(const FailingMemory&) = delete;
  FailingMemory& operator=(const FailingMemory&) = delete;

  bool hasFailed() const;     ///< at least one
  std::int64_t asked() const; ///< allocations so far
};

/// Blocks that operator new gave and operator delete has not got back.
std::int64_t BlocksInUse();

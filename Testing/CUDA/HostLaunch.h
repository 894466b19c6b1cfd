// SPDX-License-Identifier: BSD-3-Clause
//
// How the GPU's kernels run on the host: the same source, with loops in place of threads. As they
// take long to compile, they are instantiated once, in HostLaunch*.cpp, whatever machine runs them;
// a kernel that a test has of its own, by HostLaunchDefinition.h.
#pragma once

#include <cstdint>

/// How a launch is imitated.
struct HostLaunch
{
  int blocks = 3;
  bool backward = false;          ///< threads take turns from the last one on
  std::int64_t shared = 96 << 10; ///< bytes that a block may have
  bool overflows = false;         ///< else Core has nothing to repair

  /// Shared memory begins as NaNs, and its end is that of the allocation: a sanitizer sees beyond.
  template <class Kernel> void run(const Kernel& kernel, std::int64_t sharedBytes) const;
};

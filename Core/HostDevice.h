// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Marks a function that is compiled for the host and, by a CUDA compiler, for the device too.
#ifdef __CUDACC__
#define INR_HOST_DEVICE __host__ __device__
#else
#define INR_HOST_DEVICE
#endif

/// Marks one of which a kernel has a single copy, however often it calls it.
#ifdef __CUDACC__
#define INR_CALLED __noinline__
#else
#define INR_CALLED
#endif

#include <limits>

namespace inr {

/// The number, for code of both: the library's function is the host's.
constexpr double Infinite = std::numeric_limits<double>::infinity();

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {

/// How a cached voxel is kept. The integers divide a range of values evenly, so that a value of
/// it is off by at most half a quantum, (max - min)/(2^bits - 1)/2. It is that of the macro-cells
/// that the brick reaches into, which does not depend on what part of it is inferred; or of the
/// brick's values, where there are no ranges that hold.
enum class CachePrecision { Float32, Bits16, Bits8 };

INR_HOST_DEVICE constexpr std::int64_t BytesPerVoxel(CachePrecision precision)
{
  return precision == CachePrecision::Float32 ? 4 : (precision == CachePrecision::Bits16 ? 2 : 1);
}

} // namespace inr

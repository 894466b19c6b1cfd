// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cmath>

namespace inr {
namespace cuda {

INR_HOST_DEVICE inline float Mix(float a, float b, float weight) { return fmaf(b - a, weight, a); }

} // namespace cuda
} // namespace inr

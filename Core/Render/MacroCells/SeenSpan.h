// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Rays/Ray.h"

namespace inr {

/// What of a ray may show something, in t.
struct SeenSpan
{
  double begin = -Infinite;
  double end = Infinite;

  INR_HOST_DEVICE bool empty() const { return this->begin > this->end; }
};

} // namespace inr

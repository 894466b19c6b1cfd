// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Requests.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstdint>

namespace inr {

/// What rays have taken so far, and what they lacked.
struct MarchNotes
{
  FrameStatistics statistics;
  double levelSum = 0;  ///< of the levels that the samples came from
  RequestList requests; ///< bricks that are wanted
};

} // namespace inr

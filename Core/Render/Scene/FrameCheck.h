// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

namespace inr {

/// Throws Error(InvalidArgument) for values of a frame that would make no picture, as out of their
/// documented ranges, or do not go together, Error(TooLarge) for more pixels than one picture may
/// have. What its matrices must be, RayGeometry says; planes are taken as they are.
void RequireValid(const Frame& frame);

} // namespace inr

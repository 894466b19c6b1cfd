// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

namespace inr {

/// The frame as it is drawn, through a cache or not: whatever such a picture does not depend on is
/// the same in all of them, so that two frames are the same if their pictures are.
Frame AsItIsDrawn(Frame frame, bool cached);

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

namespace inr {

/// The frame as it is drawn, through a cache or not. Much of what such a picture does not depend on
/// is the same in all of them; not the seed of one that has no random offsets, nor a tolerance that
/// it is drawn without: two that differ in that are told apart.
Frame AsItIsDrawn(Frame frame, bool cached);

} // namespace inr

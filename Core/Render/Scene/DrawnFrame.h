// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

namespace inr {

/// The frame as it is drawn, through a cache or not. What such a picture does not depend on is the
/// same in all of them, as far as that can be told from the frame: a tolerance that a picture is
/// drawn without still tells two of them apart.
Frame AsItIsDrawn(Frame frame, bool cached);

} // namespace inr

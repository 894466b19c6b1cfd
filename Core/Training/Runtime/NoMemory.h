// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"

namespace inr {

/// What to say where std::bad_alloc ends a training.
Error NoMemoryToTrain();

/// The same outside of its steps, or where it is not known in what.
Error NoMemoryBesideSteps();

} // namespace inr

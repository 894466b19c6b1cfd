// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"

#include <cstdint>

namespace inr {

/// The least and the greatest of `count` values, at least one.
ValueRange RangeOfValues(const float* values, std::int64_t count);

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"

namespace inr {

class Arena;

/// Two cells, or the last one, joined along every axis.
MacroCells Joined(const MacroCells& cells, const Arena& arena);

/// The same cells, each with the range of itself and all its neighbours.
MacroCells Dilated(const MacroCells& cells, const Arena& arena);

} // namespace inr

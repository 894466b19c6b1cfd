// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/TranslucentLayers.h"
#include "Representations/Mapper/Window/PictureGroup.h"

#include <cstddef>
#include <memory>

namespace inr {

/// The surfaces that any process of `group` has found in windows of `pixels` pixels, one behind the
/// other, in all of them; at most MostLayers(). Null when nobody has any. All must call it.
std::shared_ptr<const TranslucentLayers>
ShareLayers(const PictureGroup& group, const std::shared_ptr<const TranslucentLayers>& own,
            std::size_t pixels);

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Render/Scene/ColorTable.h"
#include "Core/Render/Scene/Projection.h"

#include <cstdint>
#include <functional>

namespace inr {

/// Fills in the extinctions of `count` value ranges; 0 where no value of a range matters to the
/// picture, which is then never looked at there.
using ExtinctionRule =
    std::function<void(const ValueRange* ranges, std::int64_t count, float* extinctions)>;

/// What matters to a frame's picture. The largest extinction where opacity decides; else 1 for
/// what matters: all values where an extreme is looked for, those in `projector.averaged` where the
/// mean is, those of isosurfaces. `colors` and `projector.surfaces` must outlive the rule.
ExtinctionRule VisibilityFor(const Projector& projector, const ColorTable& colors);

/// `bounds`: of all values that rays can meet. `surfaces`, as of VisibleSurfaces, must outlive it.
Projector ProjectorFor(const Blending& blending, const VolumeInfo& volume, const ValueRange& bounds,
                       const std::vector<float>& surfaces);

} // namespace inr

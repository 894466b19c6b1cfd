// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Model.h"

#include <glm/common.hpp>

#include <algorithm>

namespace inr {

glm::i64vec3 ResolutionOf(const Model& model)
{
  const Layout layout(model.description);
  const auto isCoarser = [](const GridLevel& a, const GridLevel& b) {
    return a.resolution < b.resolution;
  };
  const std::int64_t finest =
      std::max_element(layout.levels.begin(), layout.levels.end(), isCoarser)->resolution;
  return glm::min(model.nativeDims.value_or(model.volume.dims), finest);
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Model.h"

#include "Core/Error.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace inr {

namespace {

/// By bits, which vectorises: a float without its sign grows with them.
std::uint32_t LargestMagnitudeBits(const AlignedVector<float>& values)
{
  std::uint32_t largest = 0;
  for (const float& value : values) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    largest = std::max(largest, bits & 0x7fffffffu);
  }
  return largest;
}

void RequireFinite(const AlignedVector<float>& parameters)
{
  constexpr std::uint32_t infinity = 0x7f800000u;
  if (LargestMagnitudeBits(parameters) < infinity) {
    return;
  }
  const auto bad = std::find_if(parameters.begin(), parameters.end(),
                                [](float parameter) { return !std::isfinite(parameter); });
  throw Error(ErrorCode::InvalidModel, "parameter " + std::to_string(bad - parameters.begin()) +
                                           " of the model is " + std::to_string(*bad) +
                                           "; train it again");
}

} // namespace

Layout CheckedLayout(const Model& model)
{
  Layout layout(model.description);
  if (layout.parameterCount != model.parameters.size()) {
    throw Error(ErrorCode::InvalidModel,
                "the description asks for " + std::to_string(layout.parameterCount) +
                    " parameters, the model has " + std::to_string(model.parameters.size()));
  }
  RequireFinite(model.parameters);
  return layout;
}

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

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Model.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>

namespace inr {
namespace {

struct ScalarEntry
{
  const char* name;
  std::size_t size;
};

// In the order of ScalarType.
constexpr std::array<ScalarEntry, 10> Scalars = {{{"int8", 1},
                                                  {"uint8", 1},
                                                  {"int16", 2},
                                                  {"uint16", 2},
                                                  {"int32", 4},
                                                  {"uint32", 4},
                                                  {"int64", 8},
                                                  {"uint64", 8},
                                                  {"float32", 4},
                                                  {"float64", 8}}};

} // namespace

std::size_t ScalarSize(ScalarType type) { return Scalars[static_cast<std::size_t>(type)].size; }

const char* ScalarName(ScalarType type) { return Scalars[static_cast<std::size_t>(type)].name; }

std::optional<ScalarType> ScalarFromName(const std::string& name)
{
  for (std::size_t i = 0; i < Scalars.size(); ++i) {
    if (name == Scalars[i].name) {
      return static_cast<ScalarType>(i);
    }
  }
  return std::nullopt;
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

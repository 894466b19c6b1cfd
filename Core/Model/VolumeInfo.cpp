// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/VolumeInfo.h"

#include <glm/matrix.hpp>

#include <array>
#include <cmath>
#include <limits>

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

constexpr std::size_t MaximumNameLength = 1024;

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

void RequireValidDims(const glm::i64vec3& dims, ErrorCode code)
{
  constexpr std::int64_t MaximumDimension = std::numeric_limits<std::int32_t>::max();
  constexpr std::int64_t MaximumVoxels = std::int64_t{1} << 53;
  std::int64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t size = dims[axis];
    if (size < 1 || size > MaximumDimension || size > MaximumVoxels / voxels) {
      throw Error(code, "a volume cannot have " + std::to_string(dims.x) + " x " +
                            std::to_string(dims.y) + " x " + std::to_string(dims.z) + " voxels");
    }
    voxels *= size;
  }
}

void RequireValidVolume(const VolumeInfo& volume, ErrorCode code)
{
  RequireValidDims(volume.dims, code);
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(volume.spacing[axis]) || volume.spacing[axis] == 0) {
      throw Error(code, "the spacing must be finite and not zero");
    }
    if (!std::isfinite(volume.origin[axis])) {
      throw Error(code, "the origin must be finite");
    }
  }
  const double determinant = glm::determinant(volume.direction);
  if (!std::isfinite(determinant) || determinant == 0) {
    throw Error(code, "the direction matrix must be finite and invertible");
  }
  if (!(volume.low <= volume.high) || !std::isfinite(volume.low) || !std::isfinite(volume.high)) {
    throw Error(code, "the value range must be finite, its low end not above its high end");
  }
  if (!std::isfinite(volume.high - volume.low)) {
    throw Error(code, "the values range over more than a double can tell, 1.8e308; divide them by "
                      "some number");
  }
  if (volume.time && !std::isfinite(*volume.time)) {
    throw Error(code, "the time must be finite");
  }
  if (volume.arrayName.size() > MaximumNameLength) {
    throw Error(code,
                "the array's name is longer than " + std::to_string(MaximumNameLength) + " bytes");
  }
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/VolumeInfo.h"

#include "Core/NumberText.h"

#include <glm/matrix.hpp>

#include <array>
#include <cmath>
#include <cstdint>
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

template <class Value> bool Holds(double value)
{
  return value >= static_cast<double>(std::numeric_limits<Value>::lowest()) &&
         value <= static_cast<double>(std::numeric_limits<Value>::max());
}

bool Holds(ScalarType type, double value)
{
  switch (type) {
  case ScalarType::Int8:
    return Holds<std::int8_t>(value);
  case ScalarType::UInt8:
    return Holds<std::uint8_t>(value);
  case ScalarType::Int16:
    return Holds<std::int16_t>(value);
  case ScalarType::UInt16:
    return Holds<std::uint16_t>(value);
  case ScalarType::Int32:
    return Holds<std::int32_t>(value);
  case ScalarType::UInt32:
    return Holds<std::uint32_t>(value);
  case ScalarType::Int64:
    return Holds<std::int64_t>(value);
  case ScalarType::UInt64:
    return Holds<std::uint64_t>(value);
  case ScalarType::Float32:
    return Holds<float>(value);
  case ScalarType::Float64:
    break;
  }
  return true;
}

void RequireValidGrid(const VolumeInfo& volume, ErrorCode code)
{
  RequireValidDims(volume.dims, code);
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(volume.spacing[axis]) || volume.spacing[axis] == 0) {
      throw Error(code, "the spacing must be finite and not zero");
    }
    if (!std::isfinite(volume.spacing[axis] * static_cast<double>(volume.dims[axis]))) {
      throw Error(code, "the spacing is too large: the volume has no finite size");
    }
  }
  const double determinant = glm::determinant(volume.direction);
  if (!std::isfinite(determinant) || determinant == 0) {
    throw Error(code, "the direction matrix must be finite and invertible");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(volume.origin[axis])) {
      throw Error(code, "the origin must be finite");
    }
  }
}

void RequireValidRange(const VolumeInfo& volume, ErrorCode code)
{
  if (!(volume.low <= volume.high) || !std::isfinite(volume.low) || !std::isfinite(volume.high)) {
    throw Error(code, "the value range must be finite, its low end not above its high end");
  }
  if (!std::isfinite(volume.high - volume.low)) {
    throw Error(code, "the values range over more than a double can tell, 1.8e308; divide them by "
                      "some number");
  }
  if (!Holds(volume.type, volume.low) || !Holds(volume.type, volume.high)) {
    throw Error(code, "the values range from " + NumberText(volume.low) + " to " +
                          NumberText(volume.high) + ", which a " + ScalarName(volume.type) +
                          " cannot hold");
  }
}

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
  RequireValidGrid(volume, code);
  RequireValidRange(volume, code);
  if (volume.time && !std::isfinite(*volume.time)) {
    throw Error(code, "the time must be finite");
  }
  if (volume.arrayName.size() > MaximumNameLength) {
    throw Error(code,
                "the array's name is longer than " + std::to_string(MaximumNameLength) + " bytes");
  }
}

} // namespace inr

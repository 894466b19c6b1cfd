// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/Training/Volume.h"

#include <cstdint>

namespace inr {

/// Calls `function` with a typed pointer to the volume's first value and returns what it returns.
template <class Function> decltype(auto) VisitScalars(const VolumeData& volume, Function&& function)
{
  const void* values = volume.values;
  switch (volume.type) {
  case ScalarType::Int8:
    return function(static_cast<const std::int8_t*>(values));
  case ScalarType::UInt8:
    return function(static_cast<const std::uint8_t*>(values));
  case ScalarType::Int16:
    return function(static_cast<const std::int16_t*>(values));
  case ScalarType::UInt16:
    return function(static_cast<const std::uint16_t*>(values));
  case ScalarType::Int32:
    return function(static_cast<const std::int32_t*>(values));
  case ScalarType::UInt32:
    return function(static_cast<const std::uint32_t*>(values));
  case ScalarType::Int64:
    return function(static_cast<const std::int64_t*>(values));
  case ScalarType::UInt64:
    return function(static_cast<const std::uint64_t*>(values));
  case ScalarType::Float32:
    return function(static_cast<const float*>(values));
  case ScalarType::Float64:
    return function(static_cast<const double*>(values));
  }
  throw Error(ErrorCode::InvalidArgument, "unknown scalar type");
}

} // namespace inr

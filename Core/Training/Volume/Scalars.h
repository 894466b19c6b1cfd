// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/Training/Volume/Volume.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace inr {

/// Integers of 64 bits, which a double may have to round.
template <class T> constexpr bool IsVast = std::is_integral_v<T> && sizeof(T) == 8;

/// value - origin, rounded once: vast integers that are close together differ by what they differ.
/// (As far as long double holds them; where it is a double, they are rounded first.)
template <class T> double Above(T value, double origin)
{
  if constexpr (IsVast<T>) {
    return static_cast<double>(static_cast<long double>(value) - static_cast<long double>(origin));
  } else {
    return static_cast<double>(value) - origin;
  }
}

/// The nearest doubles that are not above and not below a value.
template <class T> double DoubleBelow(T value)
{
  const auto nearest = static_cast<double>(value);
  return Above(value, nearest) < 0
             ? std::nextafter(nearest, -std::numeric_limits<double>::infinity())
             : nearest;
}
template <class T> double DoubleAbove(T value)
{
  const auto nearest = static_cast<double>(value);
  return Above(value, nearest) > 0
             ? std::nextafter(nearest, std::numeric_limits<double>::infinity())
             : nearest;
}

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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <vtkSetGet.h>
#include <vtkType.h>
#include <vtkTypeTraits.h>

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

/// `value` in the type of the source's scalars: integers round to nearest and clamp to the type,
/// NaN becomes the type's lowest integer.
template <class T> T ToScalar(double value)
{
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    const double rounded = std::nearbyint(value);
    if (!(rounded > static_cast<double>(std::numeric_limits<T>::lowest()))) {
      return std::numeric_limits<T>::lowest();
    }
    // 2^digits is exact in double where the largest value itself may not be.
    if (rounded >= std::ldexp(1.0, std::numeric_limits<T>::digits)) {
      return std::numeric_limits<T>::max();
    }
    return static_cast<T>(rounded);
  }
}

/// Calls `function` with a value of the C++ type that VTK uses for `type`.
template <class Function> auto DispatchScalar(inr::ScalarType type, Function&& function)
{
  switch (type) {
  case inr::ScalarType::Int8:
    return function(vtkTypeInt8{});
  case inr::ScalarType::UInt8:
    return function(vtkTypeUInt8{});
  case inr::ScalarType::Int16:
    return function(vtkTypeInt16{});
  case inr::ScalarType::UInt16:
    return function(vtkTypeUInt16{});
  case inr::ScalarType::Int32:
    return function(vtkTypeInt32{});
  case inr::ScalarType::UInt32:
    return function(vtkTypeUInt32{});
  case inr::ScalarType::Int64:
    return function(vtkTypeInt64{});
  case inr::ScalarType::UInt64:
    return function(vtkTypeUInt64{});
  case inr::ScalarType::Float32:
    return function(vtkTypeFloat32{});
  case inr::ScalarType::Float64:
    break;
  }
  return function(vtkTypeFloat64{});
}

/// VTK's number of the type, e.g. VTK_FLOAT.
inline int VtkTypeOf(inr::ScalarType type)
{
  return DispatchScalar(
      type, [](auto zero) { return static_cast<int>(vtkTypeTraits<decltype(zero)>::VTK_TYPE_ID); });
}

/// What a C++ type of numbers is.
template <class T> constexpr inr::ScalarType ScalarTypeOf()
{
  constexpr bool isSigned = std::numeric_limits<T>::is_signed;
  if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? inr::ScalarType::Float32 : inr::ScalarType::Float64;
  } else if constexpr (sizeof(T) == 1) {
    return isSigned ? inr::ScalarType::Int8 : inr::ScalarType::UInt8;
  } else if constexpr (sizeof(T) == 2) {
    return isSigned ? inr::ScalarType::Int16 : inr::ScalarType::UInt16;
  } else if constexpr (sizeof(T) == 4) {
    return isSigned ? inr::ScalarType::Int32 : inr::ScalarType::UInt32;
  } else {
    return isSigned ? inr::ScalarType::Int64 : inr::ScalarType::UInt64;
  }
}

/// The type with VTK's number `vtkType`; nothing for strings, bits and the like.
inline std::optional<inr::ScalarType> ScalarTypeOf(int vtkType)
{
  switch (vtkType) {
    vtkTemplateMacro(return ScalarTypeOf<VTK_TT>());
  default:
    return std::nullopt;
  }
}

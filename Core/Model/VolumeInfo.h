// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace inr {

/// VTK's scalar types, by what they are.
enum class ScalarType {
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};

std::size_t ScalarSize(ScalarType type); ///< bytes
const char* ScalarName(ScalarType type); ///< "uint8", "float64", ...
std::optional<ScalarType> ScalarFromName(const std::string& name);

/// The volume an INR stands for. Voxel i of n sits at u = (i + 0.5)/n in the unit cube and at
/// origin + direction * (i * spacing) in world space.
struct VolumeInfo
{
  glm::i64vec3 dims{1};
  glm::dvec3 spacing{1.0};
  glm::dvec3 origin{0.0};
  glm::dmat3 direction{1.0};
  std::string arrayName = "Scalars";
  ScalarType type = ScalarType::Float32;
  double low = 0.0;           ///< value at the network's normalised output 0
  double high = 1.0;          ///< and at 1
  std::optional<double> time; ///< of a step of a series, in whatever unit its source had
};

/// The network's output as everything sees it: clamped to [0, 1]; NaN becomes 0.
inline float NormalisedOutput(float output)
{
  return output > 0.0f ? (output < 1.0f ? output : 1.0f) : 0.0f;
}

/// Data value of a normalised output y; of y in [0, 1], one of the range.
inline double ValueOf(const VolumeInfo& info, float y)
{
  const double value = info.low + (info.high - info.low) * static_cast<double>(y);
  return y <= 1.0f && value > info.high ? info.high : value; // the width may have been rounded up
}

/// Throws Error(`code`) unless dims are 1 to 2^31 - 1 with a product of at most 2^53.
void RequireValidDims(const glm::i64vec3& dims, ErrorCode code);

/// The same of a volume's, and unless spacing is not zero and it, the size, origin and direction
/// are finite, the direction can be inverted, low <= high are finite with a finite difference and
/// the type holds them, and a time is finite. A name may have up to 1024 bytes.
void RequireValidVolume(const VolumeInfo& volume, ErrorCode code);

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Description.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace inr {

/// Neighbouring parameters that share a step when they are quantised: a matrix of the network, or
/// the features of a level.
struct ParameterGroup
{
  std::uint64_t offset = 0; ///< of its first parameter
  std::uint64_t count = 0;
};

/// The matrices in their order, then the levels; together every parameter once.
std::vector<ParameterGroup> ParameterGroups(const Description& description);

/// A quantised parameter is an integer of 16 bits times its group's step. Steps are normal numbers
/// whose largest multiple is finite.
constexpr float LargestMultiple = 32767.0f;
constexpr float SmallestStep = std::numeric_limits<float>::min();
constexpr float LargestStep = std::numeric_limits<float>::max() / 32768.0f;

inline bool IsStep(double step) { return step >= SmallestStep && step <= LargestStep; }

/// The finest step in which a value of this magnitude can be told.
float FinestStep(float magnitude);

/// The multiple of `step` nearest to a finite value, halves away from 0; may be beyond 16 bits.
double NearestMultiple(float value, float step);

/// What a stored multiple stands for: rounded to single precision once.
inline float ValueOfMultiple(std::int16_t multiple, float step)
{
  return static_cast<float>(multiple) * step;
}

/// Makes the parameters of a group what a file with this step gives back. All must be finite and
/// `step` at least the FinestStep of their magnitudes.
void RoundToStep(float* parameters, std::uint64_t count, float step);

} // namespace inr

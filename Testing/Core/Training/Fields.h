// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <cmath>
#include <vector>

/// A small volume with its values.
template <class T> struct Field
{
  glm::i64vec3 dims;
  inr::ScalarType type;
  std::vector<T> values;

  inr::VolumeData data() const
  {
    inr::VolumeData volume;
    volume.values = this->values.data();
    volume.type = this->type;
    volume.dims = this->dims;
    return volume;
  }
};

/// Smooth waves between about -0.9 and 0.9, mapped to [low, high] and converted to T.
template <class T>
Field<T> WaveField(const glm::i64vec3& dims, inr::ScalarType type, double low, double high)
{
  Field<T> field{dims, type, {}};
  for (std::int64_t z = 0; z < dims.z; ++z) {
    for (std::int64_t y = 0; y < dims.y; ++y) {
      for (std::int64_t x = 0; x < dims.x; ++x) {
        const double wave = std::sin(0.31 * static_cast<double>(x)) *
                            std::cos(0.23 * static_cast<double>(y) + 0.1) *
                            std::cos(0.17 * static_cast<double>(z));
        field.values.push_back(static_cast<T>(low + (high - low) * (0.5 + 0.5 * wave)));
      }
    }
  }
  return field;
}

inline Field<float> WaveField()
{
  return WaveField<float>({24, 20, 17}, inr::ScalarType::Float32, -1, 1);
}

inline inr::TrainingOptions Steps(std::uint64_t steps)
{
  inr::TrainingOptions options;
  options.maximumSteps = steps;
  options.timeLimit = 0;
  return options;
}

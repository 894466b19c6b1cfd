// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/SampleSource.h"

#include "Core/Random.h"
#include "Core/Training/Scalars.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

/// The two voxels around a coordinate, as element offsets, and the weight of the second.
struct AxisTaps
{
  std::int64_t first;
  std::int64_t second;
  double weight;
};

AxisTaps TapsAt(float u, std::int64_t size, std::int64_t step)
{
  const double position = std::clamp(static_cast<double>(u) * static_cast<double>(size) - 0.5, 0.0,
                                     static_cast<double>(size - 1));
  const std::int64_t voxel = std::min(static_cast<std::int64_t>(position), size - 1);
  const std::int64_t next = std::min(voxel + 1, size - 1);
  return {voxel * step, next * step, position - static_cast<double>(voxel)};
}

/// Values of type T around a position, interpolated in double so that no type loses digits.
template <class T>
double Trilinear(const T* values, const AxisTaps& x, const AxisTaps& y, const AxisTaps& z)
{
  const auto mix = [](double a, double b, double weight) { return a + weight * (b - a); };
  const auto row = [&](std::int64_t offset) {
    return mix(static_cast<double>(values[offset + x.first]),
               static_cast<double>(values[offset + x.second]), x.weight);
  };
  const auto plane = [&](std::int64_t offset) {
    return mix(row(offset + y.first), row(offset + y.second), y.weight);
  };
  return mix(plane(z.first), plane(z.second), z.weight);
}

template <class T>
double Nearest(const T* values, const AxisTaps& x, const AxisTaps& y, const AxisTaps& z)
{
  const auto offset = [](const AxisTaps& axis) {
    return axis.weight < 0.5 ? axis.first : axis.second;
  };
  return static_cast<double>(values[offset(x) + offset(y) + offset(z)]);
}

} // namespace

glm::vec3 RandomPosition(std::uint64_t stream, std::uint64_t k, const glm::i64vec3& dims)
{
  glm::vec3 position(0.5f);
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] > 1) {
      position[axis] = RandomUnit(stream, 3 * k + static_cast<std::uint64_t>(axis));
    }
  }
  return position;
}

InMemorySource::InMemorySource(const VolumeData& volume, double low, double high)
    : Volume(volume), Low(low), Range(high - low)
{}

void InMemorySource::sample(const glm::vec3* positions, std::int64_t count, float* targets) const
{
  const glm::i64vec3 dims = this->Volume.dims;
  const std::int64_t stride = this->Volume.stride;
  VisitScalars(this->Volume, [&](const auto* values) {
    for (std::int64_t k = 0; k < count; ++k) {
      const AxisTaps x = TapsAt(positions[k].x, dims.x, stride);
      const AxisTaps y = TapsAt(positions[k].y, dims.y, stride * dims.x);
      const AxisTaps z = TapsAt(positions[k].z, dims.z, stride * dims.x * dims.y);
      double value = Trilinear(values, x, y, z); // inf - inf and 0 * inf make it NaN, too
      if (!std::isfinite(value)) {
        value = Nearest(values, x, y, z);
      }
      // Divided, not multiplied: the inverse of a range of denormal numbers is infinite.
      targets[k] = std::isfinite(value) ? static_cast<float>((value - this->Low) / this->Range)
                                        : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

} // namespace inr

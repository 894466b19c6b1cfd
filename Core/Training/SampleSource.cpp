// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/SampleSource.h"

#include "Core/Random.h"
#include "Core/Training/Scalars.h"

#include <algorithm>
#include <array>
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

/// One axis of a piece: voxels of the volume, those of the piece, and elements from one to the
/// next.
struct Axis
{
  std::int64_t whole;
  std::int64_t first;
  std::int64_t size;
  std::int64_t step;

  AxisTaps taps(float u) const
  {
    const double last = static_cast<double>(this->whole - 1);
    const double position =
        std::clamp(static_cast<double>(u) * static_cast<double>(this->whole) - 0.5, 0.0, last);
    const auto voxel = static_cast<std::int64_t>(position);
    return {this->offset(voxel), this->offset(voxel + 1), position - static_cast<double>(voxel)};
  }

private:
  std::int64_t offset(std::int64_t voxel) const
  {
    return std::clamp<std::int64_t>(voxel - this->first, 0, this->size - 1) * this->step;
  }
};

/// Values of type T around a position, interpolated in double so that no type loses digits.
template <class T>
double Trilinear(const T* values, const AxisTaps& x, const AxisTaps& y, const AxisTaps& z,
                 double origin)
{
  const auto mix = [](double a, double b, double weight) { return a + weight * (b - a); };
  const auto at = [&](std::int64_t offset) { return Above(values[offset], origin); };
  const auto row = [&](std::int64_t offset) {
    return mix(at(offset + x.first), at(offset + x.second), x.weight);
  };
  const auto plane = [&](std::int64_t offset) {
    return mix(row(offset + y.first), row(offset + y.second), y.weight);
  };
  return mix(plane(z.first), plane(z.second), z.weight);
}

template <class T>
double Nearest(const T* values, const AxisTaps& x, const AxisTaps& y, const AxisTaps& z,
               double origin)
{
  const auto offset = [](const AxisTaps& axis) {
    return axis.weight < 0.5 ? axis.first : axis.second;
  };
  return Above(values[offset(x) + offset(y) + offset(z)], origin);
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

void SamplePiece(const VolumePiece& piece, const glm::i64vec3& dims, const glm::vec3* positions,
                 std::int64_t count, double origin, double* values)
{
  const glm::i64vec3 size = piece.data.dims;
  const std::int64_t stride = piece.data.stride;
  const Axis x{dims.x, piece.first.x, size.x, stride};
  const Axis y{dims.y, piece.first.y, size.y, stride * size.x};
  const Axis z{dims.z, piece.first.z, size.z, stride * size.x * size.y};
  VisitScalars(piece.data, [&](const auto* voxels) {
    for (std::int64_t k = 0; k < count; ++k) {
      const std::array<AxisTaps, 3> taps = {x.taps(positions[k].x), y.taps(positions[k].y),
                                            z.taps(positions[k].z)};
      values[k] = Trilinear(voxels, taps[0], taps[1], taps[2], origin);
      if (!std::isfinite(values[k])) { // inf - inf and 0 * inf make it NaN, too
        values[k] = Nearest(voxels, taps[0], taps[1], taps[2], origin);
      }
    }
  });
}

float NormalisedTarget(double value, double low, double high)
{
  // Divided, not multiplied: the inverse of a range of denormal numbers is infinite.
  return std::isfinite(value) ? static_cast<float>((value - low) / (high - low))
                              : std::numeric_limits<float>::quiet_NaN();
}

InMemorySource::InMemorySource(const VolumeData& volume, double low, double high)
    : Volume{volume, glm::i64vec3(0)}, Low(low), High(high)
{}

void InMemorySource::sample(const glm::vec3* positions, std::int64_t count, float* targets) const
{
  constexpr std::int64_t blockSize = 256;
  std::array<double, blockSize> values{};
  for (std::int64_t first = 0; first < count; first += blockSize) {
    const std::int64_t size = std::min(blockSize, count - first);
    SamplePiece(this->Volume, this->dims(), positions + first, size, this->Low, values.data());
    std::transform(values.begin(), values.begin() + size, targets + first, [this](double value) {
      return NormalisedTarget(value, 0, this->High - this->Low);
    });
  }
}

} // namespace inr

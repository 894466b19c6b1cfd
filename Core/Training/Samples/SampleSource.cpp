// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/SampleSource.h"

#include "Core/Training/Volume/Scalars.h"

#include <algorithm>
#include <array>

namespace inr {

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

namespace {

/// Samples whose voxels are on their way from memory at a time.
constexpr std::int64_t TogetherFetched = 32;

struct Taps
{
  AxisTaps x, y, z;
};

struct Axes
{
  SampledAxis x, y, z;

  Taps taps(const glm::vec3& position) const
  {
    return {this->x.taps(position.x), this->y.taps(position.y), this->z.taps(position.z)};
  }
};

/// The voxels of a row mostly lie in one cache line.
template <class T> void Fetch(const T* voxels, const Taps& taps)
{
  const T* const row = voxels + taps.x.first;
  __builtin_prefetch(row + taps.y.first + taps.z.first);
  __builtin_prefetch(row + taps.y.second + taps.z.first);
  __builtin_prefetch(row + taps.y.first + taps.z.second);
  __builtin_prefetch(row + taps.y.second + taps.z.second);
}

} // namespace

void SamplePiece(const VolumePiece& piece, const glm::i64vec3& dims, const glm::vec3* positions,
                 std::int64_t count, double origin, double* values)
{
  const glm::i64vec3 size = piece.data.dims;
  const std::int64_t stride = piece.data.stride;
  const Axes axes{{dims.x, piece.first.x, size.x, stride},
                  {dims.y, piece.first.y, size.y, stride * size.x},
                  {dims.z, piece.first.z, size.z, stride * size.x * size.y}};
  VisitScalars(piece.data, [&](const auto* voxels) {
    std::array<Taps, TogetherFetched> taps;
    for (std::int64_t first = 0; first < count; first += TogetherFetched) {
      const std::int64_t some = std::min(TogetherFetched, count - first);
      for (std::int64_t k = 0; k < some; ++k) {
        taps[k] = axes.taps(positions[first + k]);
        Fetch(voxels, taps[k]);
      }
      for (std::int64_t k = 0; k < some; ++k) {
        values[first + k] = SampleVoxels(taps[k].x, taps[k].y, taps[k].z, [&](std::int64_t offset) {
          return Above(voxels[offset], origin);
        });
      }
    }
  });
}

void SampleNormalised(const VolumePiece& piece, const glm::i64vec3& dims,
                      const glm::vec3* positions, std::int64_t count, double low, double high,
                      float* targets)
{
  constexpr std::int64_t blockSize = 256;
  std::array<double, blockSize> values{};
  for (std::int64_t first = 0; first < count; first += blockSize) {
    const std::int64_t size = std::min(blockSize, count - first);
    SamplePiece(piece, dims, positions + first, size, low, values.data());
    std::transform(values.begin(), values.begin() + size, targets + first,
                   [&](double value) { return NormalisedTarget(value, 0, high - low); });
  }
}

InMemorySource::InMemorySource(const VolumeData& volume, double low, double high)
    : Volume{volume, glm::i64vec3(0)}, Low(low), High(high)
{}

void InMemorySource::sample(const glm::vec3* positions, std::int64_t count, float* targets) const
{
  SampleNormalised(this->Volume, this->dims(), positions, count, this->Low, this->High, targets);
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LevelResampling.h"

#include "Core/Cache/Hierarchy.h"

#include <algorithm>

namespace inr {

namespace {

/// The two of `size` voxels around a place, which is clamped to them, and the far one's weight.
struct Between
{
  Between(double place, std::int64_t size)
  {
    const double inside = std::clamp(place, 0.0, static_cast<double>(size - 1));
    this->near = std::min(static_cast<std::int64_t>(inside), std::max<std::int64_t>(size - 2, 0));
    this->far = std::min(this->near + 1, size - 1);
    this->weight = inside - static_cast<double>(this->near);
  }
  std::int64_t near;
  std::int64_t far;
  double weight;
};

} // namespace

LevelResampling::LevelResampling(const VoxelSpan (&seen)[3], const glm::i64vec3& dims, int level,
                                 int points)
{
  for (int axis = 0; axis < 3; ++axis) {
    VoxelSpan& needed = this->Needed[axis];
    const std::int64_t coarse = VoxelsAtLevel(dims[axis], level);
    needed = points == 1 ? VoxelSpan{coarse - 1, 0} : seen[axis];
    for (std::int64_t voxel = seen[axis].low; voxel <= seen[axis].high; ++voxel) {
      const double place = (static_cast<double>(voxel) + 0.5) / static_cast<double>(dims[axis]) *
                               static_cast<double>(coarse) -
                           0.5;
      const Taps taps = points == 1 ? pointsAt(place, coarse) : meansAt(place, dims[axis], coarse);
      const auto end = taps.voxel.begin() + static_cast<std::ptrdiff_t>(taps.count);
      const auto [low, high] = std::minmax_element(taps.voxel.begin(), end);
      needed = {std::min(needed.low, *low), std::max(needed.high, *high)};
      this->Sums[axis].push_back(taps);
    }
  }
}

LevelResampling::Taps LevelResampling::meansAt(double place, std::int64_t size,
                                               std::int64_t coarseSize)
{
  const auto fine = static_cast<double>(size);
  const auto coarse = static_cast<double>(coarseSize);
  const Between around(place, coarseSize);
  Taps taps{};
  for (std::size_t k = 0; k < 4; ++k) { // two points of each of two coarse voxels
    const bool far = k >= 2;
    const double within = k % 2 == 0 ? 0.25 : 0.75;
    const double at = static_cast<double>(far ? around.far : around.near) + within;
    const double share = 0.5 * (far ? around.weight : 1.0 - around.weight);
    const Between point(at / coarse * fine - 0.5, size);
    taps.add(point.near, share * (1.0 - point.weight));
    taps.add(point.far, share * point.weight);
  }
  return taps;
}

LevelResampling::Taps LevelResampling::pointsAt(double place, std::int64_t coarseSize)
{
  const Between around(place, coarseSize);
  Taps taps{};
  taps.add(around.near, 1.0 - around.weight);
  taps.add(around.far, around.weight);
  return taps;
}

ValueBox LevelResampling::apply(const ValueBox& voxels, const glm::i64vec3& first) const
{
  const ValueBox z = across(voxels, 2, this->Sums[2], first.z);
  const ValueBox yz = across(z, 1, this->Sums[1], first.y);
  return alongX(yz, this->Sums[0], first.x);
}

ValueBox LevelResampling::alongX(const ValueBox& in, const std::vector<Taps>& taps,
                                 std::int64_t first)
{
  const glm::i64vec3 size(taps.size(), in.size.y, in.size.z);
  ValueBox out(size);
  for (std::int64_t line = 0; line < size.y * size.z; ++line) {
    const float* from = &in.values[static_cast<std::size_t>(line * in.size.x)];
    float* to = &out.values[static_cast<std::size_t>(line * size.x)];
    for (std::size_t x = 0; x < taps.size(); ++x) {
      float sum = 0;
      for (std::size_t k = 0; k < taps[x].count; ++k) {
        sum += taps[x].weight[k] * from[taps[x].voxel[k] - first];
      }
      to[x] = sum;
    }
  }
  return out;
}

ValueBox LevelResampling::across(const ValueBox& in, int axis, const std::vector<Taps>& taps,
                                 std::int64_t first)
{
  glm::i64vec3 size = in.size;
  size[axis] = static_cast<std::int64_t>(taps.size());
  ValueBox out(size);
  const std::int64_t stride = in.stride(axis);
  for (std::int64_t z = 0; z < size.z; ++z) {
    for (std::int64_t y = 0; y < size.y; ++y) {
      const Taps& sum = taps[static_cast<std::size_t>(axis == 1 ? y : z)];
      const float* from = &in.values[axis == 1 ? in.index(0, 0, z) : in.index(0, y, 0)];
      float* to = &out.values[out.index(0, y, z)];
      for (std::size_t k = 0; k < sum.count; ++k) {
        const float* line = from + (sum.voxel[k] - first) * stride;
        for (std::int64_t x = 0; x < size.x; ++x) {
          to[x] += sum.weight[k] * line[x];
        }
      }
    }
  }
  return out;
}

} // namespace inr

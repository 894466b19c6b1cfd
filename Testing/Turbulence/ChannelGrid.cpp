// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/ChannelGrid.h"

#include "Core/Error.h"
#include "Core/Inference/KernelTable.h"

#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

namespace inr {
namespace {

constexpr std::int64_t LargestAxis = std::int64_t{1} << 20;
constexpr std::int64_t MostPlanes = 4096; // kept, of 8 KiB each

// Rows that a thread takes at once: all of a plane, where there are planes enough to share.
std::int64_t RowBlock(const glm::i64vec3& size)
{
  constexpr std::int64_t enough = 8;
  constexpr std::int64_t few = 64;
  return size.z < enough ? few : size.y;
}

const glm::i64vec3& CheckDims(const glm::i64vec3& dims)
{
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1 || dims[axis] > LargestAxis) {
      throw Error(ErrorCode::InvalidArgument,
                  "a turbulent channel has 1 to " + std::to_string(LargestAxis) +
                      " voxels per axis, not " + std::to_string(dims[axis]));
    }
  }
  return dims;
}

std::vector<int> StreamwiseWaves(const TurbulentChannel& field)
{
  std::vector<int> waves;
  for (int wave = 0; wave < ChannelWaves; ++wave) {
    waves.push_back(field.modes()[static_cast<std::size_t>(wave)].nx);
  }
  return waves;
}

std::vector<int> SpanwiseWaves(const TurbulentChannel& field)
{
  std::vector<int> waves;
  for (const TurbulentChannel::Mode& mode : field.modes()) {
    waves.push_back(mode.ny);
  }
  return waves;
}

double Centre(std::int64_t voxel, std::int64_t voxels)
{
  return (static_cast<double>(voxel) + 0.5) / static_cast<double>(voxels);
}

} // namespace

const ChannelKernel& ChannelKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Channel); }

ChannelGrid::ChannelGrid(const TurbulentChannel& field, const glm::i64vec3& dims,
                         const std::string& kernel)
    : Field(field), Dims(CheckDims(dims)), Kernel(ChannelKernelFor(ChooseInstructionSet(kernel))),
      Streamwise(StreamwiseWaves(field), dims.x), Spanwise(SpanwiseWaves(field), dims.y)
{
  for (int wave = 0; wave < ChannelWaves; ++wave) { // a wave's numbers side by side
    for (int offset = 0; offset < ChannelTile; ++offset) {
      const int at = ChannelTile * wave + offset;
      this->WaveCosines[at] = this->Streamwise.fine(offset).cosines[wave];
      this->WaveSines[at] = this->Streamwise.fine(offset).sines[wave];
    }
  }
  for (std::int64_t k = 0; k < dims.z && dims.z <= MostPlanes; ++k) {
    this->Planes.push_back(this->makePlane(k));
  }
}

const ChannelGrid::Plane& ChannelGrid::plane(std::int64_t k, Plane& scratch) const
{
  if (!this->Planes.empty()) {
    return this->Planes[static_cast<std::size_t>(k)];
  }
  if (scratch.k != k) {
    scratch = this->makePlane(k);
  }
  return scratch;
}

ChannelGrid::Plane ChannelGrid::makePlane(std::int64_t k) const
{
  const double z = Centre(k, this->Dims.z);
  Plane plane{k, TurbulentChannel::mean(z), {}, {}};
  plane.cosines.reserve(this->Field.modes().size());
  plane.sines.reserve(this->Field.modes().size());
  const TurbulentChannel::Height height(z);
  for (const TurbulentChannel::Mode& mode : this->Field.modes()) {
    const glm::dvec2 here = height.of(mode);
    plane.cosines.push_back(here.x * std::cos(here.y));
    plane.sines.push_back(here.x * std::sin(here.y));
  }
  return plane;
}

template <class T>
void ChannelGrid::row(const Plane& plane, std::int64_t j, std::int64_t first, std::int64_t count,
                      T* values) const
{
  alignas(64) double row[2 * ChannelWaves];
  const int groups = static_cast<int>(plane.cosines.size()) / ChannelWaves;
  this->Kernel.collect({plane.cosines.data(), plane.sines.data()}, this->Spanwise.coarse(j),
                       this->Spanwise.fine(j), groups, row);
  const Phasors fine{this->WaveCosines.data(), this->WaveSines.data()};
  alignas(64) double tile[ChannelTile];
  const std::int64_t end = first + count;
  for (std::int64_t start = first / ChannelTile * ChannelTile; start < end; start += ChannelTile) {
    this->Kernel.tile(row, this->Streamwise.coarse(start), fine, plane.mean, tile);
    const std::int64_t from = std::max(first, start);
    const std::int64_t to = std::min(end, start + ChannelTile);
    std::copy(tile + (from - start), tile + (to - start), values + (from - first));
  }
}

template <class T>
void ChannelGrid::rows(const glm::i64vec3& begin, const glm::i64vec3& size, std::int64_t firstRow,
                       std::int64_t endRow, T* values) const
{
  Plane scratch;
  for (std::int64_t number = firstRow; number < endRow; ++number) {
    const Plane& plane = this->plane(begin.z + number / size.y, scratch);
    this->row(plane, begin.y + number % size.y, begin.x, size.x, values + number * size.x);
  }
}

template <class T>
void ChannelGrid::box(const Arena& arena, const glm::i64vec3& begin, const glm::i64vec3& size,
                      T* values) const
{
  arena.forEachBlock(size.y * size.z, RowBlock(size), [&](std::int64_t first, std::int64_t end) {
    this->rows(begin, size, first, end, values);
  });
}

template void ChannelGrid::row(const Plane&, std::int64_t, std::int64_t, std::int64_t,
                               float*) const;
template void ChannelGrid::row(const Plane&, std::int64_t, std::int64_t, std::int64_t,
                               double*) const;
template void ChannelGrid::box(const Arena&, const glm::i64vec3&, const glm::i64vec3&,
                               float*) const;
template void ChannelGrid::box(const Arena&, const glm::i64vec3&, const glm::i64vec3&,
                               double*) const;

} // namespace inr

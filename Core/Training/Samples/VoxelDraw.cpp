// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/VoxelDraw.h"

#include "Core/GridBox.h"
#include "Core/Random.h"
#include "Core/Training/Samples/Trilinear.h"
#include "Core/Training/Volume/Scalars.h"

#include <algorithm>
#include <limits>

namespace inr {

namespace {

constexpr std::int64_t SmallestEdge = 4;
constexpr std::int64_t MostBlocks = 1 << 21;
constexpr std::int64_t BlocksOfTask = 256;

glm::i64vec3 BlocksOf(const glm::i64vec3& dims, std::int64_t edge)
{
  return (dims + (edge - 1)) / edge;
}

std::int64_t EdgeFor(const glm::i64vec3& dims)
{
  std::int64_t edge = SmallestEdge;
  while (GridCount(BlocksOf(dims, edge)) > MostBlocks) {
    edge *= 2;
  }
  return edge;
}

/// Number `k` of a sequence in [0, 1) that begins at random and goes on by the golden ratio, which
/// leaves the smallest gaps (Knuth, "The Art of Computer Programming", volume 3, section 6.4). It
/// has so many digits that a multiple of it stays below that of 1.
double SpreadShare(std::uint64_t stream, std::uint64_t k)
{
  constexpr std::uint64_t goldenRatio = 0x9E3779B97F4A7C15ull; // of 2^64
  return static_cast<double>((RandomBits(stream, 0) + k * goldenRatio) >> 12) * 0x1p-52;
}

/// Calls `visit(voxel, value above low)` for the finite voxels of a box until it returns false.
template <class Visit>
void VisitFinite(const NormalisedVolume& normalised, const GridBox& box, const Visit& visit)
{
  const VolumeData& volume = normalised.data;
  VisitScalars(volume, [&](const auto* values) {
    for (std::int64_t z = box.first.z; z < box.end().z; ++z) {
      for (std::int64_t y = box.first.y; y < box.end().y; ++y) {
        const auto* const row = values + (z * volume.dims.y + y) * volume.dims.x * volume.stride;
        for (std::int64_t x = box.first.x; x < box.end().x; ++x) {
          const double value = Above(row[x * volume.stride], normalised.low);
          if (IsFinite(value) && !visit(glm::i64vec3(x, y, z), value)) {
            return;
          }
        }
      }
    }
  });
}

} // namespace

VoxelDraw::VoxelDraw(const NormalisedVolume& volume, const Arena& arena)
    : Volume(volume), Edge(EdgeFor(volume.data.dims)),
      Counts(BlocksOf(volume.data.dims, this->Edge))
{
  std::vector<Block> blocks(static_cast<std::size_t>(GridCount(this->Counts)));
  arena.forEachBlock(GridCount(this->Counts), BlocksOfTask,
                     [&](std::int64_t begin, std::int64_t end) {
                       for (std::int64_t k = begin; k < end; ++k) {
                         blocks[static_cast<std::size_t>(k)] = this->look(k);
                       }
                     });
  for (const Block& block : blocks) {
    this->Finite += static_cast<double>(block.finite);
    this->Contrast += static_cast<double>(block.finite) * block.contrast;
  }
  double probability = 0;
  for (const Block& block : blocks) {
    probability += static_cast<double>(block.finite) * this->density(block) / this->Finite;
    this->Probabilities.push_back(probability);
  }
}

/// Probability of a voxel over that of a uniform one.
double VoxelDraw::density(const Block& block) const
{
  return this->Contrast > 0 ? 0.5 + 0.5 * block.contrast * this->Finite / this->Contrast : 1.0;
}

GridBox VoxelDraw::box(std::int64_t block) const
{
  const glm::i64vec3 first =
      this->Edge * glm::i64vec3(block % this->Counts.x, block / this->Counts.x % this->Counts.y,
                                block / (this->Counts.x * this->Counts.y));
  return {first, glm::min(this->Volume.data.dims - first, glm::i64vec3(this->Edge))};
}

VoxelDraw::Block VoxelDraw::look(std::int64_t block) const
{
  Block seen;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  VisitFinite(this->Volume, this->box(block), [&](const glm::i64vec3&, double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    ++seen.finite;
    return true;
  });
  const double range = this->Volume.high - this->Volume.low; // which may be a denormal number
  seen.contrast = seen.finite > 0 ? (high - low) / range : 0.0;
  return seen;
}

VoxelDraw::Voxel VoxelDraw::voxel(std::uint64_t stream, std::uint64_t k) const
{
  const double share = SpreadShare(stream, k) * this->Probabilities.back();
  const auto found =
      std::upper_bound(this->Probabilities.begin(), this->Probabilities.end(), share);
  const std::int64_t number = found - this->Probabilities.begin();
  const double begin = number > 0 ? *(found - 1) : 0.0;
  const double within = (share - begin) / (*found - begin);
  const Block block = this->look(number);
  auto before = static_cast<std::int64_t>(within * static_cast<double>(block.finite));
  const GridBox box = this->box(number);
  Voxel drawn{box.first, static_cast<float>(1.0 / this->density(block))};
  VisitFinite(this->Volume, box, [&](const glm::i64vec3& at, double) {
    drawn.at = at;
    return before-- > 0;
  });
  return drawn;
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickSource.h"

#include "Core/Cache/BrickCells.h"
#include "Core/Cache/LevelVoxels.h"
#include "Core/GridBox.h"
#include "Core/Model/Model.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace inr {

namespace {

/// The part of a brick that lies inside its level.
GridBox BoxOf(const Hierarchy& hierarchy, const BrickId& id)
{
  const glm::i64vec3 first = hierarchy.firstVoxel(id);
  return {first, glm::min(glm::i64vec3(hierarchy.brickDims()), hierarchy.size(id.level) - first)};
}

LevelVoxels VoxelsOf(const Hierarchy& hierarchy, int level)
{
  return {hierarchy.dims(), level, hierarchy.points(level)};
}

/// Of all cells that a brick's voxels reach into.
ValueRange RangeWithin(const MacroCells& cells, const Hierarchy& hierarchy, BrickKey key)
{
  const CellTable ranges{cells.dims, cells.spacing, cells.ranges.data()};
  const GridBox box = CellsOfBrick(ranges, hierarchy.view(), IdOf(key));
  const glm::i64vec3 end = box.end();
  ValueRange range;
  for (std::int64_t z = box.first.z; z < end.z; ++z) {
    for (std::int64_t y = box.first.y; y < end.y; ++y) {
      for (std::int64_t x = box.first.x; x < end.x; ++x) {
        range.extend(ranges.at({x, y, z}));
      }
    }
  }
  return range;
}

class FieldBricks : public BrickSource
{
public:
  FieldBricks(std::shared_ptr<const Evaluator> field, const Hierarchy& hierarchy,
              std::shared_ptr<const MacroCells> cells)
      : BrickSource(hierarchy), Field(std::move(field)), Cells(std::move(cells))
  {}

  ValueRange rangeOf(BrickKey key) const override
  {
    if (!this->Cells) {
      return {};
    }
    const ValueRange range = RangeWithin(*this->Cells, this->hierarchy(), key);
    return {NormalisedOutput(range.low), NormalisedOutput(range.high)};
  }

  void inferLayer(BrickKey key, std::int64_t z, float* values) const override
  {
    const glm::ivec3 last = this->blocks().lastVoxel;
    this->inferRectangle(key, z, {0, last.x}, {0, last.y}, values);
  }

  bool infersParts() const override { return true; }

  void inferLayerOf(const BrickPart& part, std::int64_t z, float* values) const override
  {
    if (part.blocks.isAll()) {
      this->inferLayer(part.key, z, values);
      return;
    }
    this->rowsOf(part).forEachRectangle(static_cast<int>(z), [&](const Span& x, const Span& y) {
      this->inferRectangle(part.key, z, x, y, values);
    });
  }

private:
  using Span = BlockLattice::Span;

  void inferRectangle(BrickKey key, std::int64_t z, const Span& x, const Span& y,
                      float* values) const
  {
    const BrickId id = IdOf(key);
    const GridBox box = BoxOf(this->hierarchy(), id);
    // Voxels beyond the last one are as that.
    const glm::i64vec3 first(x.first, y.first, glm::min(z, box.size.z - 1));
    const glm::i64vec3 end(glm::min<std::int64_t>(x.last, box.size.x - 1),
                           glm::min<std::int64_t>(y.last, box.size.y - 1), first.z);
    const glm::i64vec3 count = end - first + std::int64_t{1};
    const LevelVoxels voxels = VoxelsOf(this->hierarchy(), id.level);
    const std::vector<float> inside = voxels.in({box.first + first, count}, *this->Field);
    const std::int64_t width = this->hierarchy().brickDims().x;
    for (std::int64_t row = y.first; row <= y.last; ++row) {
      const float* from = inside.data() + (glm::min(row, end.y) - first.y) * count.x;
      float* const to = std::copy_n(from, count.x, values + row * width + first.x);
      std::fill_n(to, x.last - end.x, from[count.x - 1]);
    }
  }

  std::shared_ptr<const Evaluator> Field;
  std::shared_ptr<const MacroCells> Cells;
};

} // namespace

BlockRows BrickSource::rowsOf(const BrickPart& part) const
{
  // Of a brick beyond its level, which nobody looks at, one voxel.
  const glm::i64vec3 count = glm::max(BoxOf(this->Levels, IdOf(part.key)).size, std::int64_t{1});
  return {part.blocks, this->Lattice, glm::ivec3(count) - 1};
}

std::int64_t BrickSource::points(const BrickPart& part) const
{
  const BlockRows rows = this->rowsOf(part);
  std::int64_t voxels = 0;
  for (int z = 0; z <= rows.last.z; ++z) {
    for (int y = 0; y <= rows.last.y; ++y) {
      rows.forEachRun(rows.at(y, z), [&](const BlockLattice::Span& x) {
        voxels += glm::min(x.last, rows.last.x) + 1 - x.first;
      });
    }
  }
  return voxels * VoxelsOf(this->Levels, IdOf(part.key).level).pointsPerVoxel();
}

void BrickSource::infer(const BrickKey* keys, std::int64_t count, float* values,
                        const Arena& arena) const
{
  const std::vector<BrickPart> whole(keys, keys + count);
  this->inferLayers(whole.data(), count, values, arena);
}

void BrickSource::inferParts(const BrickPart* parts, std::int64_t count, float* values,
                             const Arena& arena) const
{
  if (this->infersParts()) {
    this->inferLayers(parts, count, values, arena);
    return;
  }
  std::vector<BrickKey> keys;
  std::transform(parts, parts + count, std::back_inserter(keys),
                 [](const BrickPart& part) { return part.key; });
  this->infer(keys.data(), count, values, arena);
}

void BrickSource::inferLayers(const BrickPart* parts, std::int64_t count, float* values,
                              const Arena& arena) const
{
  const std::int64_t layers = this->Levels.brickDims().z;
  const std::int64_t layer = this->Levels.voxelsPerBrick() / layers;
  arena.forEachBlock(count * layers, 1, [&](std::int64_t k, std::int64_t) {
    const BrickPart& part = parts[k / layers];
    if (k % layers < this->layersInside(part.key)) {
      this->inferLayerOf(part, k % layers, values + k * layer);
    }
  });
  for (std::int64_t k = 0; k < count; ++k) {
    this->complete(parts[k], values + k * layers * layer);
  }
}

std::int64_t BrickSource::layersInside(BrickKey key) const
{
  return BoxOf(this->Levels, IdOf(key)).size.z;
}

void BrickSource::repeatLastLayer(BrickKey key, float* values) const
{
  const std::int64_t layers = this->Levels.brickDims().z;
  const std::int64_t layer = this->Levels.voxelsPerBrick() / layers;
  const std::int64_t inside = this->layersInside(key);
  for (std::int64_t z = inside; z < layers; ++z) {
    std::copy_n(values + (inside - 1) * layer, layer, values + z * layer);
  }
}

void BrickSource::complete(const BrickPart& part, float* values) const
{
  if (!part.blocks.isAll()) {
    this->rowsOf(part).fillRest(values);
  }
  this->repeatLastLayer(part.key, values);
}

std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const Evaluator> field,
                                                   const Hierarchy& hierarchy,
                                                   std::shared_ptr<const MacroCells> cells)
{
  return std::make_shared<FieldBricks>(std::move(field), hierarchy, std::move(cells));
}

} // namespace inr

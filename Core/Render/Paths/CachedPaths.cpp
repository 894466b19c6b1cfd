// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/CachedPaths.h"

#include "Core/Render/Bricks/OnMiss.h"
#include "Core/Render/Tiles/PassClock.h"
#include "Core/Render/Tiles/TileLoop.h"

#include <algorithm>

namespace inr {

namespace {

glm::dvec3 IndexOf(const FieldPoint& point)
{
  return glm::dvec3(point.voxel) + glm::dvec3(point.fraction);
}

float Between(float a, float b, float weight) { return a + (b - a) * weight; }

} // namespace

CachedSampler::CachedSampler(const CachedPathField& field)
    : Bricks(field.bricks), Cache(field.bricks.cache()), Missing(field.onMiss),
      Network(field.field, this->Cache.hierarchy().dims()),
      BrickStride(this->Cache.hierarchy().brickDims() - 1),
      InverseBrickStride(1.0 / this->BrickStride),
      VoxelBytes(BytesPerVoxel(this->Cache.precision())),
      StrideY(this->Cache.hierarchy().brickDims().x),
      StrideZ(this->StrideY * this->Cache.hierarchy().brickDims().y),
      LastCell(this->Cache.hierarchy().brickDims() - 2),
      BlockEdge(this->Cache.blocks().lattice().edge)
{
  const Hierarchy& hierarchy = this->Cache.hierarchy();
  for (int level = 0; level < hierarchy.levels(); ++level) {
    this->Levels.push_back({hierarchy.scale(level), hierarchy.bias(level),
                            glm::dvec3(hierarchy.size(level) - std::int64_t{1}),
                            glm::ivec3(hierarchy.bricks(level) - std::int64_t{1})});
  }
}

BrickKey CachedSampler::locate(int level, const glm::dvec3& index, glm::dvec3& local) const
{
  const Level& at = this->Levels[static_cast<std::size_t>(level)];
  const glm::dvec3 place = glm::clamp(index * at.scale + at.bias, glm::dvec3(0.0), at.last);
  const glm::ivec3 brick =
      glm::min(glm::ivec3(place * this->InverseBrickStride), at.lastBrick); // rounded down
  local = place - glm::dvec3(brick) * this->BrickStride;
  return KeyOf({level, glm::i64vec3(brick)});
}

CachedSampler::Cell CachedSampler::cellIn(std::int32_t slot, const glm::dvec3& local) const
{
  const glm::ivec3 corner = glm::min(glm::ivec3(local), this->LastCell);
  this->Cache.touch(slot);
  const Cell cell{this->Cache.view(slot),
                  corner.x + this->StrideY * corner.y + this->StrideZ * corner.z,
                  glm::vec3(local - glm::dvec3(corner))};
  // Paths lead anywhere: memory is slow to answer unless all the batch's points ask at once.
  const char* first = static_cast<const char*>(cell.brick.voxels) + cell.first * this->VoxelBytes;
  __builtin_prefetch(first);
  __builtin_prefetch(first + this->StrideY * this->VoxelBytes);
  __builtin_prefetch(first + this->StrideZ * this->VoxelBytes);
  __builtin_prefetch(first + (this->StrideY + this->StrideZ) * this->VoxelBytes);
  return cell;
}

bool CachedSampler::lookUp(BrickKey key, const glm::dvec3& local, Cell& cell)
{
  const std::int32_t slot = this->Bricks.find(key);
  if (slot == PageTable::Unmapped) {
    return false;
  }
  cell = this->cellIn(slot, local);
  // Cells that are those of coarser levels, too, lead paths to blocks that show nothing.
  const BlockSet& known = this->Cache.blocks().known(slot);
  if (!known.isAll() && !known.has(glm::min(glm::ivec3(local), this->LastCell) / this->BlockEdge)) {
    this->Unknown.push_back(&cell - this->Cells.data());
  }
  return true;
}

bool CachedSampler::find(const FieldPoint& point, Cell& cell)
{
  glm::dvec3 local;
  const BrickKey key = this->locate(point.level, IndexOf(point), local);
  if (this->lookUp(key, local, cell)) {
    this->Served.add({point.level, point.level});
    return true;
  }
  if (this->Missing != OnPathMiss::Approach) {
    this->Wishes.push_back(key);
  }
  return false;
}

void CachedSampler::findCoarser(const FieldPoint& point, Cell& cell)
{
  const glm::dvec3 index = IndexOf(point);
  glm::dvec3 local;
  BrickKey finer = this->locate(point.level, index, local);
  for (int level = point.level + 1; level < static_cast<int>(this->Levels.size()); ++level) {
    const BrickKey key = this->locate(level, index, local);
    if (this->lookUp(key, local, cell)) {
      this->Served.add({level, level});
      break;
    }
    finer = this->Cache.hierarchy().view().isOnTheWay(level) ? key : finer;
  }
  if (this->Missing == OnPathMiss::Approach) {
    this->Wishes.push_back(finer);
  }
  ++this->Missed;
}

void CachedSampler::infer(const FieldPoint* points, float* values)
{
  this->Missed += static_cast<std::int64_t>(this->Absent.size());
  this->Inferred += static_cast<std::int64_t>(this->Absent.size());
  this->AbsentPoints.clear();
  for (const std::int64_t k : this->Absent) {
    this->AbsentPoints.push_back(points[k]);
  }
  this->AbsentValues.resize(this->Absent.size());
  this->Network.sample(this->AbsentPoints.data(), static_cast<std::int64_t>(this->Absent.size()),
                       this->AbsentValues.data());
  for (std::size_t i = 0; i < this->Absent.size(); ++i) {
    values[this->Absent[i]] = this->AbsentValues[i];
  }
}

template <typename Voxel> void CachedSampler::interpolate(float* values) const
{
  for (std::size_t k = 0; k < this->Cells.size(); ++k) {
    const Cell& cell = this->Cells[k];
    const Voxel* near = static_cast<const Voxel*>(cell.brick.voxels) + cell.first;
    float layers[2];
    for (float& layer : layers) {
      const Voxel* next = near + this->StrideY;
      const float row = Between(near[0], near[1], cell.weight.x);
      layer = Between(row, Between(next[0], next[1], cell.weight.x), cell.weight.y);
      near += this->StrideZ;
    }
    values[k] = cell.brick.low + cell.brick.step * Between(layers[0], layers[1], cell.weight.z);
  }
}

void CachedSampler::sample(const FieldPoint* points, std::int64_t count, float* values)
{
  // What is absent reads some voxels in its turn until it is replaced.
  const std::int32_t anywhere = this->Cache.find(this->Cache.hierarchy().coarsest());
  this->Cells.resize(static_cast<std::size_t>(count));
  this->Absent.clear();
  this->Unknown.clear();
  for (std::int64_t k = 0; k < count; ++k) {
    Cell& cell = this->Cells[static_cast<std::size_t>(k)];
    if (this->find(points[k], cell)) {
      continue;
    }
    if (this->Missing == OnPathMiss::Infer) {
      cell = this->cellIn(anywhere, glm::dvec3(0.0));
      this->Absent.push_back(k);
    } else {
      this->findCoarser(points[k], cell);
    }
  }
  switch (this->Cache.precision()) {
  case CachePrecision::Float32:
    this->interpolate<float>(values);
    break;
  case CachePrecision::Bits16:
    this->interpolate<std::uint16_t>(values);
    break;
  case CachePrecision::Bits8:
    this->interpolate<std::uint8_t>(values);
    break;
  }
  for (const std::int64_t k : this->Unknown) {
    values[k] = Hidden;
  }
  if (!this->Absent.empty()) {
    this->infer(points, values);
  }
}

RequestList CachedSampler::requests() const
{
  std::vector<BrickKey> keys = this->Wishes;
  std::sort(keys.begin(), keys.end());
  RequestList list;
  for (auto first = keys.begin(); first != keys.end();) {
    const auto end = std::upper_bound(first, keys.end(), *first);
    list.add(*first, static_cast<float>(end - first));
    first = end;
  }
  return list;
}

namespace {

/// Asks before each look at the field whether to go on: paths may need any number of them.
class StoppableSampler : public FieldSampler
{
public:
  StoppableSampler(FieldSampler& field, const std::function<bool()>& keepGoing)
      : Field(field), KeepGoing(keepGoing)
  {}

  void sample(const FieldPoint* points, std::int64_t count, float* values) override
  {
    RequireGoing(this->KeepGoing);
    this->Field.sample(points, count, values);
  }

private:
  FieldSampler& Field;
  const std::function<bool()>& KeepGoing;
};

} // namespace

TracedTiles TraceThroughCache(const PathRound& round, const CachedPathField& field,
                              PassClock& clock, const Arena& arena,
                              const std::function<bool()>& keepGoing, RequestRanking& requests)
{
  const Timer timer;
  const Tiling tiling(round.output.rgba.width, round.output.rgba.height);
  TracedTiles traced;
  traced.tiles.resize(round.tiles.size());
  std::vector<RequestList> lists(round.tiles.size());
  traced.reached.resize(round.tiles.size());
  const auto trace = [&](std::int64_t i) {
    if (!clock.mayBegin()) {
      return;
    }
    const auto k = static_cast<std::size_t>(i);
    traced.reached[k] = 1;
    CachedSampler sampler(field);
    StoppableSampler stoppable(sampler, keepGoing);
    const Tile tile = tiling.tile(round.tiles[k]);
    traced.tiles[k] = round.tracer.trace(tile, stoppable, round.output.rgba, round.output.depth);
    traced.tiles[k].missed = sampler.missed();
    traced.tiles[k].levels = sampler.levels();
    traced.tiles[k].work.networkSamples = sampler.inferred();
    lists[k] = sampler.requests();
  };
  ForEachTile(arena, static_cast<std::int64_t>(round.tiles.size()), keepGoing, trace);
  for (const RequestList& list : lists) {
    requests.add(list);
  }
  traced.seconds = timer.seconds();
  return traced;
}

TracedTiles TraceWithNetwork(const PathRound& round, const Evaluator& field,
                             const glm::i64vec3& dims, const Arena& arena,
                             const std::function<bool()>& keepGoing)
{
  const Timer timer;
  const int edge = round.whole ? EdgeFor(field.pointsAtOnce(), 1) : Tiling::Edge;
  const Tiling tiling(round.output.rgba.width, round.output.rgba.height, edge);
  const std::int64_t tiles =
      round.whole ? tiling.count() : static_cast<std::int64_t>(round.tiles.size());
  TracedTiles traced;
  traced.tiles.resize(round.tiles.size()); // of larger tiles, there is nothing in the last ones
  ForEachTile(arena, tiles, keepGoing, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    EvaluatorSampler sampler(field, dims);
    StoppableSampler stoppable(sampler, keepGoing);
    const Tile tile = tiling.tile(round.whole ? i : round.tiles[k]);
    traced.tiles[k] = round.tracer.trace(tile, stoppable, round.output.rgba, round.output.depth);
    traced.tiles[k].work.networkSamples = traced.tiles[k].samples;
  });
  traced.seconds = timer.seconds();
  return traced;
}

} // namespace inr

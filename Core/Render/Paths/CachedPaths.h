// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Cache/Requests.h"
#include "Core/Render/Bricks/SufficientBricks.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Paths/PathTracingField.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace inr {

class Arena;
class PassClock;

/// What a path gets where the brick it wants is not there.
enum class OnPathMiss {
  UseCoarser, ///< the nearest coarser level that is, and a wish for the wanted one
  Approach,   ///< the same, but a wish for the next level on the way, as OnMiss::Approach
  Infer       ///< what the network says at the point, and a wish
};

/// What paths read.
struct CachedPathField
{
  const SufficientBricks& bricks;
  const Evaluator& field; ///< for misses
  OnPathMiss onMiss;
};

/// The field as a cache of bricks has it: trilinear between the voxels of the level asked for. The
/// coarsest level must be mapped.
class CachedSampler : public FieldSampler
{
public:
  /// What is referred to must outlive the sampler.
  explicit CachedSampler(const CachedPathField& field);

  void sample(const FieldPoint* points, std::int64_t count, float* values) override;

  /// Points so far that the cache did not have at the level they asked for.
  std::int64_t missed() const { return this->Missed; }
  /// Points so far at which the field itself was asked.
  std::int64_t inferred() const { return this->Inferred; }
  /// Levels that points came from so far.
  const LevelSpan& levels() const { return this->Served; }
  /// The bricks wished for so far, each as often as it was, by their keys.
  RequestList requests() const;

private:
  /// The voxels around a point: those of its brick, and where among them.
  struct Cell
  {
    BrickView brick;
    std::int64_t first; ///< voxel
    glm::vec3 weight;   ///< of the far neighbours
  };

  /// What the cache's hierarchy says about a level, ready for use.
  struct Level
  {
    glm::dvec3 scale;
    glm::dvec3 bias;
    glm::dvec3 last; ///< voxel
    glm::ivec3 lastBrick;
  };

  /// The brick of a place and where in it that is, as Hierarchy::locate has it but for places that
  /// two bricks share.
  BrickKey locate(int level, const glm::dvec3& index, glm::dvec3& local) const;
  bool find(const FieldPoint& point, Cell& cell);
  void findCoarser(const FieldPoint& point, Cell& cell);
  /// The voxels around a place in a brick; false where that is not there.
  bool lookUp(BrickKey key, const glm::dvec3& local, Cell& cell);
  Cell cellIn(std::int32_t slot, const glm::dvec3& local) const;
  void infer(const FieldPoint* points, float* values);
  template <typename Voxel> void interpolate(float* values) const;

  const SufficientBricks& Bricks;
  const BrickCache& Cache;
  OnPathMiss Missing;
  EvaluatorSampler Network;
  std::vector<Level> Levels;
  glm::dvec3 BrickStride; ///< voxels
  glm::dvec3 InverseBrickStride;
  std::int64_t VoxelBytes;
  std::int64_t StrideY; ///< voxels
  std::int64_t StrideZ;
  glm::ivec3 LastCell;
  int BlockEdge; ///< voxels
  std::int64_t Missed = 0;
  std::int64_t Inferred = 0;
  LevelSpan Served;
  std::vector<BrickKey> Wishes;

  std::vector<Cell> Cells; ///< of a batch
  std::vector<std::int64_t> Absent;
  std::vector<std::int64_t> Unknown; ///< in bricks that are there
  std::vector<FieldPoint> AbsentPoints;
  std::vector<float> AbsentValues;
};

/// Traces a round's tiles with what is in the cache, as many as `clock` lets begin. What was
/// missing is added to `requests` in the order of the tiles. Throws Error(Cancelled) when
/// `keepGoing` says so; see ForEachTile.
TracedTiles TraceThroughCache(const PathRound& round, const CachedPathField& field,
                              PassClock& clock, const Arena& arena,
                              const std::function<bool()>& keepGoing, RequestRanking& requests);

/// Traces a round's tiles with the field itself.
TracedTiles TraceWithNetwork(const PathRound& round, const Evaluator& field,
                             const glm::i64vec3& dims, const Arena& arena,
                             const std::function<bool()>& keepGoing);

} // namespace inr

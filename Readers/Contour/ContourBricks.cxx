// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Contour/ContourBricks.h"

#include "Core/Cache/LevelPoints.h"
#include "Core/GridBox.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace {

constexpr double SmallestEdge = 8;
constexpr double LargestEdge = 64;

/// Voxels per edge of a brick, shared ones included.
int BrickSize(const glm::i64vec3& dims, const inr::MacroCells& cells, int level)
{
  if (cells.empty()) {
    return static_cast<int>(LargestEdge) / 2 + 1;
  }
  const glm::dvec3 edges = cells.spacing * glm::dvec3(dims);
  const double edge = std::ldexp(std::max({edges.x, edges.y, edges.z}), -level);
  return static_cast<int>(std::clamp(std::floor(edge), SmallestEdge, LargestEdge)) + 1;
}

bool IsSmall(const glm::i64vec3& dims) { return std::min({dims.x, dims.y, dims.z}) < 2; }

/// On which sides of a surface the values of a cell are.
enum Side : unsigned char { Nowhere = 0, Below = 1, Above = 2, Both = 3 };

/// A surface runs between values below its own and those that are not.
std::vector<unsigned char> SidesOf(const inr::Model& model, double value)
{
  std::vector<unsigned char> sides;
  sides.reserve(model.macroCells.ranges.size());
  for (const inr::ValueRange& range : model.macroCells.ranges) {
    const bool below = !range.empty() && inr::ValueOf(model.volume, range.low) < value;
    const bool above = !range.empty() && inr::ValueOf(model.volume, range.high) >= value;
    sides.push_back(
        static_cast<unsigned char>((below ? Below : Nowhere) | (above ? Above : Nowhere)));
  }
  return sides;
}

/// Whether a cell that is on one side of the surface has a neighbour that is on the other.
bool MeetsOtherSide(const std::vector<unsigned char>& sides, const inr::MacroCells& cells,
                    const glm::i64vec3& at, unsigned char side)
{
  const glm::i64vec3 first = glm::max(at - std::int64_t{1}, glm::i64vec3(0));
  const glm::i64vec3 last = glm::min(at + std::int64_t{1}, cells.dims - std::int64_t{1});
  for (std::int64_t z = first.z; z <= last.z; ++z) {
    for (std::int64_t y = first.y; y <= last.y; ++y) {
      for (std::int64_t x = first.x; x <= last.x; ++x) {
        if ((sides[static_cast<std::size_t>(cells.index(x, y, z))] ^ side) == Both) {
          return true;
        }
      }
    }
  }
  return false;
}

} // namespace

CrossedCells::CrossedCells(const inr::Model& model, const std::vector<double>& values,
                           const inr::Arena& arena)
    : Source(model.macroCells), Crossed(model.macroCells.ranges.size(), 0)
{
  const glm::i64vec3& dims = this->Source.dims;
  for (const double value : values) {
    const std::vector<unsigned char> sides = SidesOf(model, value);
    arena.forEachBlock(this->Source.empty() ? 0 : dims.y * dims.z, 64, [&](auto begin, auto end) {
      for (std::int64_t k = begin * dims.x; k < end * dims.x; ++k) {
        const auto cell = static_cast<std::size_t>(k);
        const glm::i64vec3 at = inr::GridPlace(k, dims);
        if (sides[cell] == Both ||
            (sides[cell] != Nowhere && MeetsOtherSide(sides, this->Source, at, sides[cell]))) {
          this->Crossed[cell] = 1;
        }
      }
    });
  }
}

std::int64_t CrossedCells::Count() const
{
  return std::count(this->Crossed.begin(), this->Crossed.end(), 1);
}

int ContourBricks::CoarsestLevel(const glm::i64vec3& dims, const inr::MacroCells& cells)
{
  int level = 0;
  while (!IsSmall(inr::VoxelsAtLevel(dims, level + 1)) &&
         inr::Hierarchy(dims, BrickSize(dims, cells, level + 1)).levels() > level + 1) {
    ++level;
  }
  return level;
}

ContourBricks::ContourBricks(const inr::Model& model, int level)
    : Cells(model.macroCells), Level(level),
      Levels(model.volume.dims, BrickSize(model.volume.dims, model.macroCells, level),
             inr::ResolutionOf(model))
{}

inr::GridBox ContourBricks::BoxOf(inr::BrickKey key) const
{
  const glm::i64vec3 first = this->Levels.firstVoxel(inr::IdOf(key));
  return {first, glm::min(glm::i64vec3(this->Levels.brickDims()), this->Size() - first)};
}

double ContourBricks::SamplesPerBrick() const
{
  const glm::dvec3 voxels = glm::dvec3(this->Levels.brickDims()) + 2.0;
  return voxels.x * voxels.y * voxels.z * std::pow(this->Levels.points(this->Level), 3);
}

/// A brick needs the ranges of as few macro-cells as hold, with what they know of their
/// surroundings, all that its values are made of: up to half a voxel around on levels above 0.
std::vector<ContourBricks::Span> ContourBricks::SpansAlong(int axis) const
{
  const auto size = static_cast<double>(this->Size()[axis]);
  const auto stride = static_cast<double>(this->Levels.brickDims()[axis] - 1);
  const std::int64_t cells = this->Cells.dims[axis];
  const double margin = (this->Level > 0 ? 0.5 : 0.0) / size - this->Cells.apron[axis];
  std::vector<Span> spans(static_cast<std::size_t>(cells), Span{0, -1});
  for (std::int64_t brick = 0; brick < this->Bricks()[axis]; ++brick) {
    const double begin = (static_cast<double>(brick) * stride + 0.5) / size - margin;
    const double end =
        (std::min(static_cast<double>(brick + 1) * stride, size - 1) + 0.5) / size + margin;
    const double spacing = this->Cells.spacing[axis];
    const auto low = static_cast<std::int64_t>(std::floor(begin / spacing));
    const auto high = static_cast<std::int64_t>(std::ceil(end / spacing)) - 1;
    const std::int64_t first = std::clamp<std::int64_t>(low, 0, cells - 1);
    const std::int64_t last = std::clamp<std::int64_t>(std::max(low, high), 0, cells - 1);
    for (std::int64_t cell = first; cell <= last; ++cell) {
      Span& span = spans[static_cast<std::size_t>(cell)];
      span = span.last < span.first ? Span{brick, brick} : Span{span.first, brick};
    }
  }
  return spans;
}

namespace {

/// Bricks without repetition, up to a number.
class BrickSet
{
public:
  using Span = ContourBricks::Span;

  BrickSet(int level, std::int64_t limit) : Level(level), Limit(limit) {}

  /// False when they are too many.
  bool Add(const Span& x, const Span& y, const Span& z)
  {
    for (std::int64_t k = z.first; k <= z.last; ++k) {
      for (std::int64_t j = y.first; j <= y.last; ++j) {
        for (std::int64_t i = x.first; i <= x.last; ++i) {
          this->Keys.insert(inr::KeyOf({this->Level, {i, j, k}}));
          if (static_cast<std::int64_t>(this->Keys.size()) > this->Limit) {
            return false;
          }
        }
      }
    }
    return true;
  }

  std::vector<inr::BrickKey> Sorted() const
  {
    std::vector<inr::BrickKey> keys(this->Keys.begin(), this->Keys.end());
    std::sort(keys.begin(), keys.end());
    return keys;
  }

private:
  int Level;
  std::int64_t Limit;
  std::unordered_set<inr::BrickKey> Keys;
};

} // namespace

std::optional<std::vector<inr::BrickKey>> ContourBricks::Select(const CrossedCells& crossed,
                                                                std::int64_t limit) const
{
  if (this->Cells.empty()) {
    return this->All(limit);
  }
  BrickSet found(this->Level, limit);
  const std::vector<Span> columns = this->SpansAlong(0);
  const std::vector<Span> rows = this->SpansAlong(1);
  std::size_t cell = 0;
  for (const Span& z : this->SpansAlong(2)) {
    for (const Span& y : rows) {
      std::int64_t done = -1; // last brick of the row that is in the set
      for (const Span& x : columns) {
        const bool wanted = crossed(cell++);
        if (wanted && !found.Add({std::max(x.first, done + 1), x.last}, y, z)) {
          return std::nullopt;
        }
        done = wanted ? std::max(done, x.last) : done;
      }
    }
  }
  return found.Sorted();
}

std::optional<std::vector<inr::BrickKey>> ContourBricks::All(std::int64_t limit) const
{
  const glm::i64vec3 bricks = this->Bricks();
  const glm::dvec3 counts(bricks);
  if (counts.x * counts.y * counts.z > static_cast<double>(limit)) {
    return std::nullopt;
  }
  std::vector<inr::BrickKey> keys;
  for (std::int64_t k = 0; k < bricks.x * bricks.y * bricks.z; ++k) {
    keys.push_back(inr::KeyOf(
        {this->Level, {k % bricks.x, k / bricks.x % bricks.y, k / (bricks.x * bricks.y)}}));
  }
  return keys;
}

// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Grid/PlaneGrid.h"

#include "Readers/Grid/PresentedGrid.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

/// Rounding of positions, in steps of the grid and as part of a volume's size.
constexpr double Tolerance = 1e-9;

/// The native voxels that the bounds reach to.
struct Box
{
  explicit Box(const glm::dvec3& dims) : low(0.0), high(dims - 1.0)
  {
    for (int axis = 0; axis < 3; ++axis) {
      if (dims[axis] == 1.0) {
        this->low[axis] = -0.5;
        this->high[axis] = 0.5;
      }
    }
  }
  glm::dvec3 corner(int k) const
  {
    return {k & 1 ? this->high.x : this->low.x, k & 2 ? this->high.y : this->low.y,
            k & 4 ? this->high.z : this->low.z};
  }
  glm::dvec3 low, high;
};

/// Where a plane dot(normal, i) + offset = 0 meets a box's edges; in no order, none twice.
std::vector<glm::dvec3> Crossings(const Box& box, const glm::dvec3& normal, double offset)
{
  const double size = glm::dot(glm::abs(normal), box.high - box.low);
  double heights[8];
  std::vector<glm::dvec3> points;
  for (int k = 0; k < 8; ++k) {
    heights[k] = glm::dot(normal, box.corner(k)) + offset;
    if (std::fabs(heights[k]) <= Tolerance * size) {
      heights[k] = 0;
      points.push_back(box.corner(k));
    }
  }
  for (int k = 0; k < 8; ++k) {
    for (const int other : {k | 1, k | 2, k | 4}) {
      if (other != k && heights[k] * heights[other] < 0) {
        const double t = heights[k] / (heights[k] - heights[other]);
        points.push_back(glm::mix(box.corner(k), box.corner(other), t));
      }
    }
  }
  return points;
}

/// The volume's axis that lies closest to the plane, laid into it, and the direction across.
void DirectionsIn(const glm::dmat3& axes, const glm::dvec3& normal, glm::dvec3 (&directions)[2])
{
  int closest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double slope = std::fabs(glm::dot(glm::normalize(axes[axis]), normal));
    if (slope < least - Tolerance) {
      closest = axis;
      least = slope;
    }
  }
  const glm::dvec3 axis = axes[closest];
  directions[0] = glm::normalize(axis - normal * glm::dot(axis, normal));
  directions[1] = glm::cross(normal, directions[0]);
}

/// How far it is along `direction` until some native index has grown by one.
double LongestStep(const glm::dmat3& indices, const glm::dvec3& direction, const glm::dvec3& dims)
{
  const glm::dvec3 growth = glm::abs(indices * direction);
  double fastest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    fastest = dims[axis] > 1.0 ? std::max(fastest, growth[axis]) : fastest;
  }
  return fastest > 0 ? 1 / fastest : std::numeric_limits<double>::infinity();
}

void SortAroundCentre(std::vector<glm::dvec2>& outline)
{
  glm::dvec2 centre(0.0);
  for (const glm::dvec2& point : outline) {
    centre += point / static_cast<double>(outline.size());
  }
  const auto angle = [&](const glm::dvec2& point) {
    return std::atan2(point.y - centre.y, point.x - centre.x);
  };
  std::sort(outline.begin(), outline.end(),
            [&](const glm::dvec2& a, const glm::dvec2& b) { return angle(a) < angle(b); });
}

/// First and last; empty when last < first.
struct Interval
{
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();
  void extend(double x)
  {
    this->first = std::min(this->first, x);
    this->last = std::max(this->last, x);
  }
};

/// The x that a convex outline has at heights from `low` to `high`.
Interval SpanOf(const std::vector<glm::dvec2>& outline, double low, double high)
{
  Interval extent;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const glm::dvec2 a = outline[k];
    const glm::dvec2 b = outline[(k + 1) % outline.size()];
    if (a.y >= low && a.y <= high) {
      extent.extend(a.x);
    }
    for (const double y : {low, high}) {
      if ((a.y < y) != (b.y < y)) {
        extent.extend(glm::mix(a.x, b.x, (y - a.y) / (b.y - a.y)));
      }
    }
  }
  return extent;
}

/// A corner of a cell while it is cut; `id` is -1 for a point that is no node of the grid.
struct Corner
{
  glm::dvec2 place;
  std::int64_t id;
};

/// The part of a convex polygon to the left of the line from a to b.
std::vector<Corner> LeftOf(const std::vector<Corner>& polygon, const glm::dvec2& a,
                           const glm::dvec2& b)
{
  const glm::dvec2 along = glm::normalize(b - a);
  const auto height = [&](const Corner& corner) {
    const glm::dvec2 way = corner.place - a;
    return along.x * way.y - along.y * way.x;
  };
  std::vector<Corner> left;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& from = polygon[k];
    const Corner& to = polygon[(k + 1) % polygon.size()];
    const double h0 = height(from);
    const double h1 = height(to);
    if (h0 >= -Tolerance) {
      left.push_back(from);
    }
    if ((h0 < -Tolerance && h1 > Tolerance) || (h0 > Tolerance && h1 < -Tolerance)) {
      left.push_back({glm::mix(from.place, to.place, h0 / (h0 - h1)), -1});
    }
  }
  return left;
}

double Area(const std::vector<Corner>& polygon)
{
  double sum = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const glm::dvec2 a = polygon[k - 1].place - polygon[0].place;
    const glm::dvec2 b = polygon[k].place - polygon[0].place;
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

/// Builds a mesh stripe by stripe, from the bottom row of nodes up.
class Mesher
{
public:
  explicit Mesher(const std::vector<glm::dvec2>& outline) : Outline(outline) {}

  void AddStripe(std::int64_t row)
  {
    const Row below = row == this->NextRow ? this->Upper : this->MakeRow(row);
    this->Upper = this->MakeRow(row + 1);
    this->NextRow = row + 1;
    const auto y = static_cast<double>(row);
    const Interval span = SpanOf(this->Outline, y - Tolerance, y + 1 + Tolerance);
    const auto first = static_cast<std::int64_t>(std::floor(span.first + Tolerance));
    const auto last = static_cast<std::int64_t>(std::ceil(span.last - Tolerance));
    for (std::int64_t x = first; x < last; ++x) {
      const Corner corners[4] = {below.At(x), below.At(x + 1), this->Upper.At(x + 1),
                                 this->Upper.At(x)};
      this->AddCell({corners, corners + 4});
    }
  }

  PlaneMesh Mesh;

private:
  struct Row
  {
    std::int64_t y = 0;
    std::int64_t first = 0; ///< node within the outline
    std::int64_t count = 0;
    std::int64_t firstId = 0;
    Corner At(std::int64_t x) const
    {
      const bool within = x >= this->first && x < this->first + this->count;
      return {{x, this->y}, within ? this->firstId + x - this->first : -1};
    }
  };

  Row MakeRow(std::int64_t y)
  {
    const auto height = static_cast<double>(y);
    const Interval span = SpanOf(this->Outline, height - Tolerance, height + Tolerance);
    Row row;
    row.y = y;
    row.firstId = static_cast<std::int64_t>(this->Mesh.points.size());
    if (span.first <= span.last) {
      row.first = static_cast<std::int64_t>(std::ceil(span.first - Tolerance));
      const auto last = static_cast<std::int64_t>(std::floor(span.last + Tolerance));
      row.count = std::max<std::int64_t>(0, last - row.first + 1);
    }
    for (std::int64_t x = row.first; x < row.first + row.count; ++x) {
      this->Mesh.points.emplace_back(x, y);
    }
    return row;
  }

  void AddCell(std::vector<Corner> polygon)
  {
    const bool whole = std::all_of(polygon.begin(), polygon.end(),
                                   [](const Corner& corner) { return corner.id >= 0; });
    for (std::size_t k = 0; !whole && k < this->Outline.size(); ++k) {
      polygon = LeftOf(polygon, this->Outline[k], this->Outline[(k + 1) % this->Outline.size()]);
    }
    if (Area(polygon) <= Tolerance) {
      return;
    }
    for (Corner& corner : polygon) {
      if (corner.id < 0) {
        corner.id = static_cast<std::int64_t>(this->Mesh.points.size());
        this->Mesh.points.push_back(corner.place);
      }
      this->Mesh.connectivity.push_back(corner.id);
    }
    this->Mesh.offsets.push_back(static_cast<std::int64_t>(this->Mesh.connectivity.size()));
  }

  const std::vector<glm::dvec2>& Outline;
  Row Upper;
  std::int64_t NextRow = -1; ///< that `Upper` is
};

} // namespace

PlaneGrid::PlaneGrid(const NativeGrid& grid, const Plane& plane, std::int64_t maximumPoints)
    : Dims(grid.model->volume.dims), Indices(glm::inverse(grid.Axes())), Origin(grid.origin)
{
  const glm::dmat3 axes = grid.Axes();
  const glm::dvec3 normal = glm::transpose(axes) * plane.normal;
  std::vector<glm::dvec3> corners =
      Crossings(Box(this->Dims), normal, glm::dot(plane.normal, this->Origin) + plane.offset);
  if (corners.size() < 3) {
    return; // beside the volume, or touching it
  }
  for (glm::dvec3& corner : corners) {
    corner = this->Origin + axes * corner;
  }
  glm::dvec3 directions[2];
  DirectionsIn(axes, plane.normal, directions);
  this->Span(directions, corners, maximumPoints);
}

void PlaneGrid::Span(const glm::dvec3 (&directions)[2], const std::vector<glm::dvec3>& corners,
                     std::int64_t maximumPoints)
{
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 way = corner - corners[0];
    const glm::dvec2 place(glm::dot(way, directions[0]), glm::dot(way, directions[1]));
    this->Outline.push_back(place);
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  glm::i64vec3 nodes(1);
  for (int k = 0; k < 2; ++k) {
    const double step = LongestStep(this->Indices, directions[k], this->Dims);
    const double cells = std::ceil((high[k] - low[k]) / step - Tolerance);
    nodes[k] = std::max<std::int64_t>(1, static_cast<std::int64_t>(cells)) + 1;
  }
  this->Nodes = glm::i64vec2(FinestDims(nodes, static_cast<double>(maximumPoints)));
  this->Corner = corners[0] + directions[0] * low.x + directions[1] * low.y;
  const glm::dvec2 steps = (high - low) / glm::dvec2(this->Nodes - std::int64_t{1});
  for (int k = 0; k < 2; ++k) {
    this->Steps[k] = directions[k] * steps[k];
  }
  for (glm::dvec2& point : this->Outline) {
    point = (point - low) / steps;
  }
  SortAroundCentre(this->Outline);
}

PlaneMesh PlaneGrid::Mesh(int piece, int pieces) const
{
  Mesher mesher(this->Outline);
  const std::int64_t stripes = std::max<std::int64_t>(0, this->Nodes.y - 1);
  for (std::int64_t row = stripes * piece / pieces; row < stripes * (piece + 1) / pieces; ++row) {
    mesher.AddStripe(row);
  }
  return std::move(mesher.Mesh);
}

glm::dvec3 PlaneGrid::Unit(const glm::dvec2& point) const
{
  const glm::dvec3 index = this->Indices * (this->World(point) - this->Origin);
  return (glm::clamp(index, glm::dvec3(0.0), this->Dims - 1.0) + 0.5) / this->Dims;
}

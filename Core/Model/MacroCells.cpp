// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/MacroCells.h"

#include <cmath>
#include <string>

namespace inr {
namespace {

constexpr int SmallestEdge = 16;
constexpr std::int64_t WantedCells = std::int64_t{1} << 22;
// Their table has to fit a file of under 2 GiB.
constexpr std::int64_t MaximumCells = (std::int64_t{1} << 28) - 1;
// Keeps products of three counts within 64 bits.
constexpr std::int64_t MaximumDimension = std::int64_t{1} << 31;

std::int64_t CellsAlong(std::int64_t voxels, std::int64_t edge) { return (voxels - 1) / edge + 1; }

// Cells in all, or something over the limit where the product would be.
std::int64_t CellCount(const glm::i64vec3& dims, std::int64_t edge)
{
  const std::int64_t x = CellsAlong(dims.x, edge);
  const std::int64_t y = CellsAlong(dims.y, edge);
  const std::int64_t z = CellsAlong(dims.z, edge);
  return x > MaximumCells / y || x * y > MaximumCells / z ? MaximumCells + 1 : x * y * z;
}

void RequireVolume(const glm::i64vec3& dims)
{
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1 || dims[axis] > MaximumDimension) {
      throw Error(ErrorCode::InvalidArgument,
                  "a volume cannot have " + std::to_string(dims[axis]) + " voxels along an axis");
    }
  }
}

} // namespace

void RequireValidGeometry(const MacroCells& cells, ErrorCode code)
{
  constexpr double largest = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = cells.spacing[axis];
    const double covered = static_cast<double>(cells.dims[axis]) * edge;
    if (!(edge > 0 && edge <= largest) || !(covered >= 1.0 - 1e-6)) {
      throw Error(code, "the spacings of macro-cells must be positive, at most 1e9, and let the "
                        "cells cover the unit cube");
    }
    if (!(cells.apron[axis] >= 0) || !std::isfinite(cells.apron[axis])) {
      throw Error(code, "the apron of macro-cells must be finite and not negative");
    }
  }
}

int DefaultMacroCellSize(const glm::i64vec3& volumeDims)
{
  RequireVolume(volumeDims);
  int edge = SmallestEdge;
  while (CellCount(volumeDims, edge) > WantedCells) {
    edge *= 2;
  }
  return edge;
}

std::int64_t CountMacroCells(const glm::i64vec3& volumeDims, int edge)
{
  RequireVolume(volumeDims);
  if (edge < 1) {
    throw Error(ErrorCode::InvalidArgument,
                "a macro-cell cannot have an edge of " + std::to_string(edge) + " voxels");
  }
  const std::int64_t count = CellCount(volumeDims, edge);
  if (count > MaximumCells) {
    throw Error(ErrorCode::TooLarge, "macro-cells of " + std::to_string(edge) +
                                         " voxels are too many for this volume; choose larger "
                                         "ones");
  }
  return count;
}

MacroCells MakeMacroCells(const glm::i64vec3& volumeDims, int edge)
{
  const std::int64_t count = CountMacroCells(volumeDims, edge);
  MacroCells cells;
  for (int axis = 0; axis < 3; ++axis) {
    cells.dims[axis] = CellsAlong(volumeDims[axis], edge);
    cells.spacing[axis] = static_cast<double>(edge) / static_cast<double>(volumeDims[axis]);
  }
  cells.ranges.resize(static_cast<std::size_t>(count));
  return cells;
}

} // namespace inr

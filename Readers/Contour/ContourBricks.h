// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Hierarchy.h"
#include "Core/GridBox.h"
#include "Core/Model/Model.h"
#include "Core/Parallel.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// The macro-cells of a volume that isosurfaces may run through, as far as the ranges know.
class CrossedCells
{
public:
  CrossedCells(const inr::Model& model, const std::vector<double>& values, const inr::Arena& arena);

  const inr::MacroCells& Cells() const { return this->Source; }
  bool operator()(std::size_t cell) const { return this->Crossed[cell] != 0; }
  std::int64_t Count() const;

private:
  const inr::MacroCells& Source;
  std::vector<unsigned char> Crossed;
};

/// The bricks of one level of a volume, and which of them isosurfaces may run through. A brick's
/// edge is that of a macro-cell, where that is from 8 to 64 voxels of the level.
class ContourBricks
{
public:
  /// Numbers of bricks along an axis, both inclusive.
  struct Span
  {
    std::int64_t first;
    std::int64_t last;
  };

  /// The last level that has two voxels or more along every axis, or is a single brick.
  static int CoarsestLevel(const glm::i64vec3& dims, const inr::MacroCells& cells);

  /// Throws inr::Error for too many bricks along an axis. `level` is CoarsestLevel at most. `model`
  /// must outlive this.
  ContourBricks(const inr::Model& model, int level);

  int GetLevel() const { return this->Level; }
  glm::i64vec3 Size() const { return this->Levels.size(this->Level); } ///< in voxels
  glm::i64vec3 Bricks() const { return this->Levels.bricks(this->Level); }

  /// A brick's voxels; those of the last layer are the next brick's, too.
  inr::GridBox BoxOf(inr::BrickKey key) const;

  /// What deciding on a brick costs: evaluations of the network, with the voxels around it.
  double SamplesPerBrick() const;

  /// Those that reach into one of the cells, by rising key; nothing where they are more than
  /// `limit`. All of them where the model has no macro-cells.
  std::optional<std::vector<inr::BrickKey>> Select(const CrossedCells& crossed,
                                                   std::int64_t limit) const;

private:
  /// For every macro-cell along an axis the bricks that take its range into account.
  std::vector<Span> SpansAlong(int axis) const;
  std::optional<std::vector<inr::BrickKey>> All(std::int64_t limit) const;

  const inr::MacroCells& Cells;
  int Level;
  inr::Hierarchy Levels;
};

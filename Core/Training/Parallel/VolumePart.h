// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Samples/SampleSource.h"
#include "Core/Training/Volume/Volume.h"

#include <cstdint>

namespace inr {

/// The part of a volume that one process trains on: cells between neighbouring voxels, which the
/// processes share out among them, and the voxels that go with them. An axis of one voxel has one
/// cell.
class VolumePart
{
public:
  /// `piece` is what this process holds of a volume of `dims` voxels: two processes whose pieces
  /// touch both hold the voxels between them. A piece that a process of lower rank holds, too, is
  /// left to that; one without voxels is fine. Throws Error(InvalidArgument) in all processes when
  /// the pieces overlap otherwise or leave gaps.
  VolumePart(const VolumePiece& piece, const glm::i64vec3& dims, const TrainingGroup& group);

  const VolumePiece& piece() const { return this->Piece; }
  const glm::i64vec3& dims() const { return this->Dims; }

  /// Every voxel of the volume is one of exactly one process.
  GridBox voxels() const;

  /// Whether a position in the unit cube lies in a cell of this process; it does in exactly one's.
  bool holds(const glm::vec3& position) const;

  /// Whether a box of the unit cube may have to do with this process, if what is in there moves by
  /// up to a voxel.
  bool isNear(const glm::vec3& corner, const glm::vec3& extent) const;

  /// Normalised values at positions that it holds.
  void sample(const glm::vec3* positions, std::int64_t count, double low, double high,
              float* targets) const;

private:
  VolumePiece Piece;
  glm::i64vec3 Dims;
  GridBox Cells;
};

/// A volume that is asked by all processes at once: each answers for its part, and all know all
/// answers. Only for the thread that calls the group.
class SharedSource : public SampleSource
{
public:
  SharedSource(const VolumePart& part, const TrainingGroup& group, double low, double high)
      : Part(part), Group(group), Low(low), High(high)
  {}

  const glm::i64vec3& dims() const override { return this->Part.dims(); }
  void sample(const glm::vec3* positions, std::int64_t count, float* targets) const override;

private:
  const VolumePart& Part;
  const TrainingGroup& Group;
  double Low;
  double High;
};

} // namespace inr

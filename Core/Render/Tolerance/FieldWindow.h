// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Render/Tolerance/ValueBox.h"

namespace inr {

/// A part of a volume's voxels that grows: the field is asked once for each.
class FieldWindow
{
public:
  /// Into a volume of `dims` voxels; of none at first.
  FieldWindow(const Evaluator& field, const glm::i64vec3& dims);

  /// Makes it hold these, and all others of the smallest box around them and what it holds.
  void extendTo(const VoxelSpan (&spans)[3]);

  /// Normalised values of voxels that it holds, those of a NormalisedOutput.
  ValueBox cut(const VoxelSpan (&spans)[3]) const;

  std::int64_t points() const { return this->Held.count(); } ///< that the field was asked for

private:
  ValueBox sample(const VoxelSpan (&spans)[3]) const;
  void put(const ValueBox& box, const VoxelSpan (&spans)[3]);

  const Evaluator& Field;
  glm::i64vec3 Dims;
  VoxelSpan Spans[3]; ///< that it holds
  ValueBox Held{glm::i64vec3(0)};
};

} // namespace inr

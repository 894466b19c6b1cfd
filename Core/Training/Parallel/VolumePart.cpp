// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Parallel/VolumePart.h"

#include "Core/Error.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <vector>

namespace inr {

namespace {

glm::i64vec3 CellsOf(const glm::i64vec3& dims)
{
  return glm::max(dims - glm::i64vec3(1), glm::i64vec3(1));
}

/// The cells between the voxels of a piece; none where it is a mere layer of a thick volume.
GridBox CellsOf(const VolumePiece& piece, const glm::i64vec3& dims)
{
  GridBox cells{piece.first, glm::i64vec3(0)};
  for (int axis = 0; axis < 3; ++axis) {
    cells.size[axis] = dims[axis] == 1 ? std::min<std::int64_t>(piece.data.dims[axis], 1)
                                       : std::max<std::int64_t>(piece.data.dims[axis] - 1, 0);
  }
  return cells.count() > 0 ? cells : GridBox();
}

bool Overlap(const GridBox& a, const GridBox& b)
{
  return glm::all(glm::lessThan(glm::max(a.first, b.first), glm::min(a.end(), b.end())));
}

bool Same(const GridBox& a, const GridBox& b) { return a.first == b.first && a.size == b.size; }

/// Leaves every cell to the first who has it.
void RequirePartition(std::vector<GridBox>& boxes, const GridBox& whole)
{
  std::int64_t cells = 0;
  bool apart = true;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    for (std::size_t before = 0; before < k; ++before) {
      if (boxes[k].count() > 0 && Same(boxes[k], boxes[before])) {
        boxes[k] = GridBox();
      }
      apart = apart && !Overlap(boxes[k], boxes[before]);
    }
    cells += boxes[k].count();
  }
  if (!apart || cells != whole.count()) {
    throw Error(ErrorCode::InvalidArgument,
                apart ? "the pieces of the processes leave gaps in the volume"
                      : "the pieces of the processes overlap by more than a layer of points");
  }
}

} // namespace

VolumePart::VolumePart(const VolumePiece& piece, const glm::i64vec3& dims,
                       const TrainingGroup& group)
    : Piece(piece), Dims(dims), Cells(CellsOf(piece, dims))
{
  std::vector<GridBox> boxes = group.valuesOfAll(this->Cells);
  RequirePartition(boxes, {glm::i64vec3(0), CellsOf(dims)});
  this->Cells = boxes[static_cast<std::size_t>(group.rank())];
}

GridBox VolumePart::voxels() const
{
  GridBox voxels = this->Cells;
  for (int axis = 0; axis < 3; ++axis) { // the last layer of the volume begins no cell
    const bool last = voxels.end()[axis] == this->Dims[axis] - 1;
    voxels.size[axis] += this->Cells.count() > 0 && last ? 1 : 0;
  }
  return voxels;
}

bool VolumePart::holds(const glm::vec3& position) const
{
  for (int axis = 0; axis < 3; ++axis) {
    const auto size = static_cast<double>(this->Dims[axis]);
    const double place =
        std::clamp(static_cast<double>(position[axis]) * size - 0.5, 0.0, size - 1);
    const std::int64_t last = std::max<std::int64_t>(this->Dims[axis] - 2, 0);
    const std::int64_t cell = std::min(static_cast<std::int64_t>(place), last);
    if (cell < this->Cells.first[axis] || cell >= this->Cells.end()[axis]) {
      return false;
    }
  }
  return true;
}

bool VolumePart::isNear(const glm::vec3& corner, const glm::vec3& extent) const
{
  constexpr double margin =
      2.0; // voxels: half a one to its centre, half a one to the cell, rounding
  const glm::dvec3 size(this->Dims);
  const glm::dvec3 low = glm::dvec3(corner) * size - margin;
  const glm::dvec3 high = glm::dvec3(corner + extent) * size + margin;
  return glm::all(glm::lessThan(low, glm::dvec3(this->Cells.end() + glm::i64vec3(1)))) &&
         glm::all(glm::greaterThan(high, glm::dvec3(this->Cells.first)));
}

void VolumePart::sample(const glm::vec3* positions, std::int64_t count, double low, double high,
                        float* targets) const
{
  SampleNormalised(this->Piece, this->Dims, positions, count, low, high, targets);
}

void SharedSource::sample(const glm::vec3* positions, std::int64_t count, float* targets) const
{
  struct Answer
  {
    std::int64_t index;
    float value;
  };
  std::string mine;
  for (std::int64_t k = 0; k < count; ++k) {
    if (this->Part.holds(positions[k])) {
      Answer answer{k, 0};
      this->Part.sample(positions + k, 1, this->Low, this->High, &answer.value);
      mine.append(reinterpret_cast<const char*>(&answer), sizeof(Answer));
    }
  }
  for (const std::string& answers : this->Group.gather(mine)) {
    for (std::size_t at = 0; at < answers.size(); at += sizeof(Answer)) {
      const auto answer = FromBytes<Answer>(answers.data() + at);
      targets[answer.index] = answer.value;
    }
  }
}

} // namespace inr

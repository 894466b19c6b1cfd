// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/FieldWindow.h"

#include "Core/Cache/LevelVoxels.h"

#include <algorithm>

namespace inr {

namespace {

/// A part of `size`, from `begin` on, to where another begins.
void Copy(const ValueBox& from, const glm::i64vec3& begin, ValueBox& to, const glm::i64vec3& place,
          const glm::i64vec3& size)
{
  for (std::int64_t z = 0; z < size.z; ++z) {
    for (std::int64_t y = 0; y < size.y; ++y) {
      const float* row = &from.values[from.index(begin.x, begin.y + y, begin.z + z)];
      std::copy_n(row, size.x, &to.values[to.index(place.x, place.y + y, place.z + z)]);
    }
  }
}

} // namespace

FieldWindow::FieldWindow(const Evaluator& field, const glm::i64vec3& dims)
    : Field(field), Dims(dims), Spans{{0, -1}, {0, -1}, {0, -1}}
{}

void FieldWindow::extendTo(const VoxelSpan (&spans)[3])
{
  if (this->points() == 0) {
    std::copy_n(spans, 3, this->Spans);
    this->Held = this->sample(spans);
    return;
  }
  for (int axis = 2; axis >= 0; --axis) { // one after the other: slabs on either side
    VoxelSpan& held = this->Spans[axis];
    const VoxelSpan before = held;
    const VoxelSpan all{std::min(held.low, spans[axis].low), std::max(held.high, spans[axis].high)};
    if (all.count() == before.count()) {
      continue;
    }
    const ValueBox old = std::move(this->Held);
    VoxelSpan parts[3] = {this->Spans[0], this->Spans[1], this->Spans[2]};
    held = all;
    this->Held = ValueBox(SizeOf(this->Spans));
    this->put(old, parts);
    for (const VoxelSpan& slab :
         {VoxelSpan{all.low, before.low - 1}, VoxelSpan{before.high + 1, all.high}}) {
      if (slab.count() > 0) {
        parts[axis] = slab;
        this->put(this->sample(parts), parts);
      }
    }
  }
}

ValueBox FieldWindow::sample(const VoxelSpan (&spans)[3]) const
{
  const glm::i64vec3 size = SizeOf(spans);
  return {size, LevelVoxels(this->Dims, 0, 1).in({LowOf(spans), size}, this->Field)};
}

void FieldWindow::put(const ValueBox& box, const VoxelSpan (&spans)[3])
{
  Copy(box, glm::i64vec3(0), this->Held, LowOf(spans) - LowOf(this->Spans), box.size);
}

ValueBox FieldWindow::cut(const VoxelSpan (&spans)[3]) const
{
  ValueBox box(SizeOf(spans));
  Copy(this->Held, LowOf(spans) - LowOf(this->Spans), box, glm::i64vec3(0), box.size);
  return box;
}

} // namespace inr

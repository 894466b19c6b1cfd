// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickPool.h"

#include "Core/Cache/Quantisation.h"
#include "Core/Cache/RangeOfValues.h"

#include <cstring>

namespace inr {

namespace {

constexpr std::int64_t RoomBehind = 64;

template <typename Stored>
void Quantise(const float* values, std::int64_t count, float low, float step, unsigned char* to)
{
  const float inverse = InverseOf(step);
  auto* stored = reinterpret_cast<Stored*>(to);
  for (std::int64_t k = 0; k < count; ++k) {
    stored[k] = Quantised<Stored>(values[k], low, inverse);
  }
}

} // namespace

BrickPool::BrickPool(CachePrecision precision, std::int64_t voxelsPerBrick, std::int64_t room)
    : Precision(precision), VoxelsPerBrick(voxelsPerBrick),
      BytesPerBrick(voxelsPerBrick * BytesPerVoxel(precision)),
      Voxels(room * this->BytesPerBrick + RoomBehind), Scales(room)
{}

std::int64_t BrickPool::bytesPerSlot(CachePrecision precision, std::int64_t voxelsPerBrick)
{
  return voxelsPerBrick * BytesPerVoxel(precision) + static_cast<std::int64_t>(sizeof(Scale));
}

void BrickPool::resize(std::int64_t slots)
{
  this->Voxels.resize(slots * this->BytesPerBrick);
  this->Scales.resize(slots);
}

void BrickPool::copy(std::int32_t from, std::int32_t to)
{
  this->Scales[to] = this->Scales[from];
  std::memcpy(this->brick(to), this->brick(from), static_cast<std::size_t>(this->BytesPerBrick));
}

void BrickPool::store(std::int32_t slot, const float* values, const ValueRange& within)
{
  Scale& scale = this->Scales[slot];
  if (this->Precision == CachePrecision::Float32) {
    scale = {0.0f, 1.0f};
    std::memcpy(this->brick(slot), values, static_cast<std::size_t>(this->BytesPerBrick));
    return;
  }
  const ValueRange range = within.empty() ? RangeOfValues(values, this->VoxelsPerBrick) : within;
  const bool wide = this->Precision == CachePrecision::Bits16;
  scale = {range.low, StepOf(range.low, range.high, wide ? 65535.0f : 255.0f)};
  const auto quantise = wide ? Quantise<std::uint16_t> : Quantise<std::uint8_t>;
  quantise(values, this->VoxelsPerBrick, scale.low, scale.step, this->brick(slot));
}

BrickView BrickPool::view(std::int32_t slot) const
{
  const Scale& scale = this->Scales[slot];
  return {this->brick(slot), scale.low, scale.step};
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickPool.h"

#include "Core/Cache/RangeOfValues.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace inr {

namespace {

constexpr std::int64_t RoomBehind = 64;

/// Zero for a constant brick, else at least the smallest step whose inverse is finite.
float StepOf(const ValueRange& range, float steps)
{
  const float width = range.high - range.low;
  return width > 0 ? std::max(width / steps, std::numeric_limits<float>::min()) : 0.0f;
}

template <typename Stored>
void Quantise(const float* values, std::int64_t count, float low, float step, unsigned char* to)
{
  constexpr auto most = static_cast<float>(std::numeric_limits<Stored>::max());
  const float inverse = step > 0 ? 1.0f / step : 0.0f;
  auto* stored = reinterpret_cast<Stored*>(to);
  for (std::int64_t k = 0; k < count; ++k) {
    const float scaled = (values[k] - low) * inverse + 0.5f;
    // By way of int, which vectors convert to.
    stored[k] = static_cast<Stored>(static_cast<int>(scaled < most ? scaled : most));
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

void BrickPool::store(std::int32_t slot, const float* values)
{
  Scale& scale = this->Scales[slot];
  if (this->Precision == CachePrecision::Float32) {
    scale = {0.0f, 1.0f};
    std::memcpy(this->brick(slot), values, static_cast<std::size_t>(this->BytesPerBrick));
    return;
  }
  const ValueRange range = RangeOfValues(values, this->VoxelsPerBrick);
  const bool wide = this->Precision == CachePrecision::Bits16;
  scale = {range.low, StepOf(range, wide ? 65535.0f : 255.0f)};
  const auto quantise = wide ? Quantise<std::uint16_t> : Quantise<std::uint8_t>;
  quantise(values, this->VoxelsPerBrick, scale.low, scale.step, this->brick(slot));
}

BrickView BrickPool::view(std::int32_t slot) const
{
  const Scale& scale = this->Scales[slot];
  return {this->brick(slot), scale.low, scale.step};
}

} // namespace inr

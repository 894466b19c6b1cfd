// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Core/Inference/Lanes.h.
#include "Core/Render/BrickKernel.h"

#include "Core/Inference/Lanes.h"

namespace inr {
namespace INR_ISA {

namespace {

struct AxisLocation
{
  Ints cell;
  Floats weight;
};

AxisLocation Locate(const BrickPath& path, int axis, Floats t)
{
  const Floats along = MultiplyAdd(t, Spread(path.direction[axis]), Spread(path.origin[axis]));
  const Floats inside = Minimum(Maximum(along, Floats{}), Spread(path.last[axis]));
  Ints cell = __builtin_convertvector(inside, Ints); // not negative, so truncation is floor
  const Ints last = path.lastCell[axis] - Ints{};
  cell = cell < last ? cell : last;
  return {cell, inside - __builtin_convertvector(cell, Floats)};
}

/// The two neighbours along x of LaneCount places.
struct Pair
{
  Floats first;
  Floats second;
};

Pair LoadPairs(const float* voxels, const std::int32_t* offset)
{
  float lanes[2][LaneCount];
  for (int k = 0; k < LaneCount; ++k) {
    lanes[0][k] = voxels[offset[k]];
    lanes[1][k] = voxels[offset[k] + 1];
  }
  return {Load(lanes[0]), Load(lanes[1])};
}

/// Both voxels come in one load, which is what makes integers faster than floats.
template <typename Word>
Pair LoadPairs(const void* voxels, const std::int32_t* offset, std::int32_t mask, int shift)
{
  std::int32_t lanes[LaneCount];
  const char* bytes = static_cast<const char*>(voxels);
  for (int k = 0; k < LaneCount; ++k) {
    Word word;
    std::memcpy(&word, bytes + static_cast<std::int64_t>(offset[k]) * (shift / 8), sizeof(word));
    lanes[k] = static_cast<std::int32_t>(word);
  }
  UInts both;
  std::memcpy(&both, lanes, sizeof(both));
  const UInts first = both & SpreadInt(static_cast<std::uint32_t>(mask));
  return {__builtin_convertvector((Ints)first, Floats),
          __builtin_convertvector((Ints)(both >> shift), Floats)};
}

struct FloatVoxels
{
  static Pair load(const void* voxels, const std::int32_t* offset)
  {
    return LoadPairs(static_cast<const float*>(voxels), offset);
  }
  static constexpr int Bytes = 4;
};

struct ShortVoxels
{
  static Pair load(const void* voxels, const std::int32_t* offset)
  {
    return LoadPairs<std::uint32_t>(voxels, offset, 0xFFFF, 16);
  }
  static constexpr int Bytes = 2;
};

struct ByteVoxels
{
  static Pair load(const void* voxels, const std::int32_t* offset)
  {
    return LoadPairs<std::uint16_t>(voxels, offset, 0xFF, 8);
  }
  static constexpr int Bytes = 1;
};

Floats Mix(Floats a, Floats b, Floats weight) { return MultiplyAdd(b - a, weight, a); }

template <typename Voxels>
Floats MixPair(const void* voxels, std::int64_t shift, const std::int32_t* offset, Floats weight)
{
  const Pair pair = Voxels::load(static_cast<const char*>(voxels) + shift * Voxels::Bytes, offset);
  return Mix(pair.first, pair.second, weight);
}

template <typename Voxels>
void SampleAs(const BrickPath& path, const float* t, int count, float* values)
{
  for (int k = 0; k < count; k += LaneCount) {
    const Floats at = Load(t + k);
    const AxisLocation x = Locate(path, 0, at);
    const AxisLocation y = Locate(path, 1, at);
    const AxisLocation z = Locate(path, 2, at);
    const Ints offset = x.cell + y.cell * path.strideY + z.cell * path.strideZ;
    std::int32_t offsets[LaneCount];
    std::memcpy(offsets, &offset, sizeof(offset));
    const std::int64_t dy = path.strideY;
    const std::int64_t dz = path.strideZ;
    const Floats front = Mix(MixPair<Voxels>(path.voxels, 0, offsets, x.weight),
                             MixPair<Voxels>(path.voxels, dy, offsets, x.weight), y.weight);
    const Floats back = Mix(MixPair<Voxels>(path.voxels, dz, offsets, x.weight),
                            MixPair<Voxels>(path.voxels, dz + dy, offsets, x.weight), y.weight);
    const Floats stored = Mix(front, back, z.weight);
    Store(values + k, MultiplyAdd(stored, Spread(path.step), Spread(path.low)));
  }
}

void Sample(const BrickPath& path, const float* t, int count, float* values)
{
  switch (path.format) {
  case VoxelBytes::Four:
    SampleAs<FloatVoxels>(path, t, count, values);
    break;
  case VoxelBytes::Two:
    SampleAs<ShortVoxels>(path, t, count, values);
    break;
  case VoxelBytes::One:
    SampleAs<ByteVoxels>(path, t, count, values);
    break;
  }
}

/// Table positions of a batch.
struct Classified
{
  std::int32_t entry[SampleBatch::Capacity];
  float weight[SampleBatch::Capacity];
};

/// A value off its range by less than this is the storage format's rounding, not a broken bound.
constexpr float RoundingOfStorage = 0x1p-14f;

/// -1 in the lanes of existing samples that were moved.
Ints Moved(Floats value, Floats inside, int valid)
{
  Ints lane;
  for (int k = 0; k < LaneCount; ++k) {
    lane[k] = k;
  }
  const Floats off = Maximum(value - inside, inside - value);
  return (off > Spread(RoundingOfStorage)) & (lane < valid);
}

void Classify(const StepLookup& lookup, const SampleBatch& batch, int count, Classified& out,
              std::int64_t& clamped)
{
  const Floats top = Spread(static_cast<float>(lookup.rows - 3));
  const Floats two = Spread(2.0f);
  Ints moved{};
  for (int k = 0; k < count; k += LaneCount) {
    const Floats value = Load(batch.value + k);
    const Floats inside = Minimum(Maximum(value, Load(batch.low + k)), Load(batch.high + k));
    moved -= Moved(value, inside, count - k);
    Floats position = MultiplyAdd(inside, Spread(lookup.scale), Spread(lookup.bias));
    // Outside the transfer function's range there is a step, not a slope.
    const Ints below = position < two;
    const Ints above = position > top;
    position = Minimum(Maximum(position, two), top);
    Ints entry = __builtin_convertvector(position, Ints);
    const Floats weight = position - __builtin_convertvector(entry, Floats);
    entry = below ? Ints{} : (above ? (lookup.rows - 2) - Ints{} : entry);
    std::memcpy(out.entry + k, &entry, sizeof(entry));
    Store(out.weight + k, below | above ? Floats{} : weight);
  }
  for (int k = 0; k < LaneCount; ++k) {
    clamped += moved[k];
  }
}

typedef float Rgba __attribute__((vector_size(16)));

Rgba LoadRgba(const float* from)
{
  Rgba value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

int Composite(const StepLookup& lookup, SampleBatch& batch, int count, float opaque,
              RayColor& color, std::int64_t& clamped)
{
  Classified at;
  Classify(lookup, batch, count, at, clamped);
  Rgba sum = {color.rgb[0], color.rgb[1], color.rgb[2], 0};
  float transmittance = color.transmittance;
  int used = 0;
  while (used < count && transmittance > opaque) {
    const std::int64_t row =
        static_cast<std::int64_t>(batch.multiple[used]) * lookup.rows + at.entry[used];
    const Rgba first = LoadRgba(lookup.entries + 4 * row);
    const Rgba second = LoadRgba(lookup.entries + 4 * row + 4);
    const Rgba entry = first + (second - first) * at.weight[used];
    batch.opacity[used] = 1.0f - transmittance;
    const float weight = transmittance * entry[3];
    sum += entry * weight;
    transmittance -= weight;
    ++used;
  }
  color = {{sum[0], sum[1], sum[2]}, transmittance};
  return used;
}

} // namespace

const BrickKernel Bricks = {Sample, Composite};

} // namespace INR_ISA
} // namespace inr

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

AxisLocation Locate(const float* places, int lastCell)
{
  const Floats place = Load(places);
  Ints cell = __builtin_convertvector(place, Ints); // not negative, so truncation is floor
  const Ints last = lastCell - Ints{};
  cell = cell < last ? cell : last;
  return {cell, place - __builtin_convertvector(cell, Floats)};
}

/// Where samples are in their bricks.
struct Located
{
  const void* voxels[SampleBatch::Room];
  float place[3][SampleBatch::Room];
  float base[SampleBatch::Room];
  float quantum[SampleBatch::Room];
};

/// Samples [first, end) of one path; may write up to LaneCount - 1 places past the end.
void Follow(const BrickPath& path, const float* along, int first, int end, Located& out)
{
  for (int k = first; k < end; k += LaneCount) {
    const Floats t = Load(along + k);
    for (int axis = 0; axis < 3; ++axis) {
      const Floats place = MultiplyAdd(t, Spread(path.direction[axis]), Spread(path.origin[axis]));
      Store(out.place[axis] + k, Minimum(Maximum(place, Floats{}), Spread(path.last[axis])));
    }
    Store(out.base + k, Spread(path.base));
    Store(out.quantum + k, Spread(path.quantum));
    for (int lane = k; lane < k + LaneCount; ++lane) {
      out.voxels[lane] = path.voxels;
    }
  }
}

void LocateAll(const SampleBatch& batch, int count, Located& out)
{
  int first = 0;
  while (first < count) {
    int end = first + 1;
    while (end < count && batch.path[end] == batch.path[first]) {
      ++end;
    }
    Follow(batch.paths[batch.path[first]], batch.along, first, end, out);
    first = end;
  }
  for (int lane = count; lane % LaneCount != 0; ++lane) { // whatever can be read
    out.voxels[lane] = out.voxels[count - 1];
    out.place[0][lane] = out.place[1][lane] = out.place[2][lane] = 0.0f;
  }
}

/// The two neighbours along x of LaneCount places.
struct Pair
{
  Floats first;
  Floats second;
};

/// Where LaneCount samples find their cells.
struct Places
{
  const void* const* voxels;
  std::int32_t offset[LaneCount];
};

/// Both voxels come in one load, which is what makes integers faster than floats.
template <typename Word, typename Stored> Pair LoadPairs(const Places& places, std::int64_t shift)
{
  constexpr int bits = 8 * sizeof(Stored);
  std::uint32_t lanes[LaneCount];
  for (int k = 0; k < LaneCount; ++k) {
    Word word;
    std::memcpy(&word, static_cast<const Stored*>(places.voxels[k]) + places.offset[k] + shift,
                sizeof(word));
    lanes[k] = word;
  }
  Ints both;
  std::memcpy(&both, lanes, sizeof(both));
  const Ints mask = ((1 << bits) - 1) - Ints{};
  return {__builtin_convertvector(both & mask, Floats),
          __builtin_convertvector((Ints)((UInts)both >> bits), Floats)};
}

struct FloatVoxels
{
  static Pair load(const Places& places, std::int64_t shift)
  {
    float lanes[2][LaneCount];
    for (int k = 0; k < LaneCount; ++k) {
      const float* from = static_cast<const float*>(places.voxels[k]) + places.offset[k] + shift;
      lanes[0][k] = from[0];
      lanes[1][k] = from[1];
    }
    return {Load(lanes[0]), Load(lanes[1])};
  }
};

struct ShortVoxels
{
  static Pair load(const Places& places, std::int64_t shift)
  {
    return LoadPairs<std::uint32_t, std::uint16_t>(places, shift);
  }
};

struct ByteVoxels
{
  static Pair load(const Places& places, std::int64_t shift)
  {
    return LoadPairs<std::uint16_t, std::uint8_t>(places, shift);
  }
};

Floats Mix(Floats a, Floats b, Floats weight) { return MultiplyAdd(b - a, weight, a); }

template <typename Voxels> Floats MixPair(const Places& places, std::int64_t shift, Floats weight)
{
  const Pair pair = Voxels::load(places, shift);
  return Mix(pair.first, pair.second, weight);
}

template <typename Voxels>
void SampleAs(const BrickFormat& format, const Located& located, int count, float* values)
{
  const std::int64_t dy = format.strideY;
  const std::int64_t dz = format.strideZ;
  for (int k = 0; k < count; k += LaneCount) {
    const AxisLocation x = Locate(located.place[0] + k, format.lastCell[0]);
    const AxisLocation y = Locate(located.place[1] + k, format.lastCell[1]);
    const AxisLocation z = Locate(located.place[2] + k, format.lastCell[2]);
    const Ints offset = x.cell + y.cell * format.strideY + z.cell * format.strideZ;
    Places places;
    places.voxels = located.voxels + k;
    std::memcpy(places.offset, &offset, sizeof(offset));
    const Floats front =
        Mix(MixPair<Voxels>(places, 0, x.weight), MixPair<Voxels>(places, dy, x.weight), y.weight);
    const Floats back = Mix(MixPair<Voxels>(places, dz, x.weight),
                            MixPair<Voxels>(places, dz + dy, x.weight), y.weight);
    const Floats stored = Mix(front, back, z.weight);
    Store(values + k, MultiplyAdd(stored, Load(located.quantum + k), Load(located.base + k)));
  }
}

void Sample(const BrickFormat& format, SampleBatch& batch, int count)
{
  Located located;
  LocateAll(batch, count, located);
  switch (format.bytes) {
  case VoxelBytes::Four:
    SampleAs<FloatVoxels>(format, located, count, batch.value);
    break;
  case VoxelBytes::Two:
    SampleAs<ShortVoxels>(format, located, count, batch.value);
    break;
  case VoxelBytes::One:
    SampleAs<ByteVoxels>(format, located, count, batch.value);
    break;
  }
}

/// Table positions of a batch.
struct Classified
{
  std::int32_t entry[SampleBatch::Capacity];
  float weight[SampleBatch::Capacity];
};

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

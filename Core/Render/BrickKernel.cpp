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

void StoreInts(std::int32_t* to, Ints value) { std::memcpy(to, &value, sizeof(value)); }

/// Where samples are in their bricks.
struct Located
{
  float place[3][SampleBatch::Room];
  float base[SampleBatch::Room];
  float quantum[SampleBatch::Room];
};

/// A path, or in each lane one of two.
struct Way
{
  Floats origin[3];
  Floats direction[3];
  Floats last[3];
  Floats base;
  Floats quantum;
};

Way SpreadWay(const BrickPath& path)
{
  Way way;
  for (int axis = 0; axis < 3; ++axis) {
    way.origin[axis] = Spread(path.origin[axis]);
    way.direction[axis] = Spread(path.direction[axis]);
    way.last[axis] = Spread(path.last[axis]);
  }
  way.base = Spread(path.base);
  way.quantum = Spread(path.quantum);
  return way;
}

Way ChooseWay(Ints second, const BrickPath& a, const BrickPath& b)
{
  const auto choose = [second](float one, float other) {
    return second ? Spread(other) : Spread(one);
  };
  Way way;
  for (int axis = 0; axis < 3; ++axis) {
    way.origin[axis] = choose(a.origin[axis], b.origin[axis]);
    way.direction[axis] = choose(a.direction[axis], b.direction[axis]);
    way.last[axis] = choose(a.last[axis], b.last[axis]);
  }
  way.base = choose(a.base, b.base);
  way.quantum = choose(a.quantum, b.quantum);
  return way;
}

/// LaneCount places from `at` on, but for their voxels.
void PutPlaces(const Way& way, Floats along, int at, Located& out)
{
  for (int axis = 0; axis < 3; ++axis) {
    const Floats place = MultiplyAdd(along, way.direction[axis], way.origin[axis]);
    Store(out.place[axis] + at, Minimum(Maximum(place, Floats{}), way.last[axis]));
  }
  Store(out.base + at, way.base);
  Store(out.quantum + at, way.quantum);
}

/// Samples [first, end) of one path; may write up to LaneCount - 1 places past the end.
void Follow(const BrickPath& path, const float* along, int first, int end, Located& out)
{
  const Way way = SpreadWay(path);
  for (int k = first; k < end; k += LaneCount) {
    PutPlaces(way, Load(along + k), k, out);
  }
}

/// Whatever can be read, behind the last sample up to a whole vector.
void PadPlaces(int count, SampleBatch& batch, Located& out)
{
  for (int lane = count; lane % LaneCount != 0; ++lane) {
    batch.path[lane] = batch.path[count - 1];
    out.place[0][lane] = out.place[1][lane] = out.place[2][lane] = 0.0f;
  }
}

void LocateAll(SampleBatch& batch, int count, Located& out)
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
  PadPlaces(count, batch, out);
}

/// LaneCount samples of a run, from number `first` of it on, at `at` in the batch.
struct Lanes
{
  Ints number; ///< of the samples in their run
  int at;
};

Floats AlongOf(const SampleRun& run, int path, const Lanes& lanes)
{
  const Floats number = __builtin_convertvector(lanes.number, Floats);
  return (number * run.spacing + run.start[path]) + run.offset;
}

void PutOnPath(const SampleRun& run, const Way& way, const Lanes& lanes, SampleBatch& batch,
               Located& out)
{
  const Floats along = AlongOf(run, 0, lanes);
  PutPlaces(way, along, lanes.at, out);
  Store(batch.along + lanes.at, along);
  StoreInts(batch.path + lanes.at, run.path[0] - Ints{});
}

/// RandomUnit32 of the samples.
Floats RandomUnits(const SampleRun& run, const Lanes& lanes)
{
  UInts x = ((UInts)lanes.number * run.stride + run.counter) ^ run.seed;
  x = (x ^ (x >> 16)) * 0x7FEB352Du;
  x = (x ^ (x >> 15)) * 0x846CA68Bu;
  return __builtin_convertvector((Ints)((x ^ (x >> 16)) >> 8), Floats) * 0x1p-24f;
}

void PutOnTwoPaths(const SampleRun& run, const Lanes& lanes, SampleBatch& batch, Located& out)
{
  const BrickPath& a = batch.paths[run.path[0]];
  const BrickPath& b = batch.paths[run.path[1]];
  const Floats fine = AlongOf(run, 0, lanes);
  const Floats fraction = MultiplyAdd(fine, Spread(run.growth), Spread(run.fraction));
  const Ints coarser = RandomUnits(run, lanes) < fraction;
  const Floats along = coarser ? AlongOf(run, 1, lanes) : fine;
  PutPlaces(ChooseWay(coarser, a, b), along, lanes.at, out);
  Store(batch.along + lanes.at, along);
  StoreInts(batch.path + lanes.at, coarser ? run.path[1] - Ints{} : run.path[0] - Ints{});
}

void PutCommon(const SampleRun& run, int at, SampleBatch& batch)
{
  Store(batch.low + at, Spread(run.low));
  Store(batch.high + at, Spread(run.high));
  StoreInts(batch.length + at, run.length - Ints{});
}

/// Lays out a run from `at` on; may write up to LaneCount - 1 samples past its end.
void LayOut(const SampleRun& run, int at, SampleBatch& batch, Located& out)
{
  Lanes lanes{{}, at};
  for (int lane = 0; lane < LaneCount; ++lane) {
    lanes.number[lane] = lane;
  }
  const Way way = SpreadWay(batch.paths[run.path[0]]);
  const int end = at + run.count;
  while (lanes.at < end) {
    if (run.ways > 1) {
      PutOnTwoPaths(run, lanes, batch, out);
    } else {
      PutOnPath(run, way, lanes, batch, out);
    }
    PutCommon(run, lanes.at, batch);
    lanes.at += LaneCount;
    lanes.number += LaneCount;
  }
}

/// Voxels as they are stored: of each lane one and its neighbour along x.
struct FloatVoxels
{
  using Stored = float;
  float first[LaneCount];
  float second[LaneCount];

  void load(int lane, const float* from)
  {
    this->first[lane] = from[0];
    this->second[lane] = from[1];
  }
  Floats mix(Floats weight) const;
};

/// Both voxels come in one load, which is what makes integers faster than floats.
template <typename Word, typename Voxel> struct PackedVoxels
{
  using Stored = Voxel;
  static constexpr int Bits = 8 * sizeof(Voxel);
  std::uint32_t both[LaneCount];

  void load(int lane, const Voxel* from)
  {
    Word word;
    std::memcpy(&word, from, sizeof(word));
    this->both[lane] = word;
  }
  Floats mix(Floats weight) const;
};

using ShortVoxels = PackedVoxels<std::uint32_t, std::uint16_t>;
using ByteVoxels = PackedVoxels<std::uint16_t, std::uint8_t>;

Floats Mix(Floats a, Floats b, Floats weight) { return MultiplyAdd(b - a, weight, a); }

Floats FloatVoxels::mix(Floats weight) const
{
  return Mix(Load(this->first), Load(this->second), weight);
}

template <typename Word, typename Voxel> Floats PackedVoxels<Word, Voxel>::mix(Floats weight) const
{
  Ints words;
  std::memcpy(&words, this->both, sizeof(words));
  const Ints mask = ((1 << Bits) - 1) - Ints{};
  return Mix(__builtin_convertvector(words & mask, Floats),
             __builtin_convertvector((Ints)((UInts)words >> Bits), Floats), weight);
}

/// Stored values, interpolated, of LaneCount samples from k on.
template <typename Voxels>
Floats Interpolate(const BrickFormat& format, const SampleBatch& batch, const Located& located,
                   int k)
{
  const AxisLocation x = Locate(located.place[0] + k, format.lastCell[0]);
  const AxisLocation y = Locate(located.place[1] + k, format.lastCell[1]);
  const AxisLocation z = Locate(located.place[2] + k, format.lastCell[2]);
  const Ints cells = x.cell + y.cell * format.strideY + z.cell * format.strideZ;
  std::int32_t offset[LaneCount];
  StoreInts(offset, cells);
  const std::int64_t dy = format.strideY;
  const std::int64_t dz = format.strideZ;
  Voxels rows[4];
  for (int lane = 0; lane < LaneCount; ++lane) {
    const void* brick = batch.paths[batch.path[k + lane]].voxels;
    const auto* from = static_cast<const typename Voxels::Stored*>(brick) + offset[lane];
    rows[0].load(lane, from);
    rows[1].load(lane, from + dy);
    rows[2].load(lane, from + dz);
    rows[3].load(lane, from + dz + dy);
  }
  const Floats front = Mix(rows[0].mix(x.weight), rows[1].mix(x.weight), y.weight);
  const Floats back = Mix(rows[2].mix(x.weight), rows[3].mix(x.weight), y.weight);
  return Mix(front, back, z.weight);
}

template <typename Voxels>
void SampleAs(const BrickFormat& format, SampleBatch& batch, const Located& located, int count)
{
  for (int k = 0; k < count; k += LaneCount) {
    const Floats stored = Interpolate<Voxels>(format, batch, located, k);
    Store(batch.value + k, MultiplyAdd(stored, Load(located.quantum + k), Load(located.base + k)));
  }
}

void SampleLocated(const BrickFormat& format, SampleBatch& batch, const Located& located, int count)
{
  switch (format.bytes) {
  case VoxelBytes::Four:
    SampleAs<FloatVoxels>(format, batch, located, count);
    break;
  case VoxelBytes::Two:
    SampleAs<ShortVoxels>(format, batch, located, count);
    break;
  case VoxelBytes::One:
    SampleAs<ByteVoxels>(format, batch, located, count);
    break;
  }
}

void Sample(const BrickFormat& format, SampleBatch& batch, int count)
{
  Located located;
  LocateAll(batch, count, located);
  SampleLocated(format, batch, located, count);
}

void SampleRuns(const BrickFormat& format, SampleBatch& batch, int runs)
{
  Located located;
  int count = 0;
  for (int k = 0; k < runs; ++k) {
    LayOut(batch.runs[k], count, batch, located);
    count += batch.runs[k].count;
  }
  PadPlaces(count, batch, located);
  SampleLocated(format, batch, located, count);
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
typedef double ExactRgba __attribute__((vector_size(32)));

Rgba LoadRgba(const float* from)
{
  Rgba value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

/// With colours and opacities of type Vector, four of Number.
template <typename Number, typename Vector>
int CompositeAs(const StepLookup& lookup, SampleBatch& batch, int count, float opaque,
                const Classified& at, RayColor& color)
{
  const auto number = [](double value) { return static_cast<Number>(value); };
  Vector sum = {number(color.rgb[0]), number(color.rgb[1]), number(color.rgb[2]), 0};
  Number transmittance = number(color.transmittance);
  int used = 0;
  while (used < count && transmittance > opaque) {
    const std::int64_t row =
        static_cast<std::int64_t>(batch.length[used]) * lookup.rows + at.entry[used];
    const Rgba first = LoadRgba(lookup.entries + 4 * row);
    const Rgba second = LoadRgba(lookup.entries + 4 * row + 4);
    const Vector entry =
        __builtin_convertvector(first + (second - first) * at.weight[used], Vector);
    batch.opacity[used] = static_cast<float>(1 - transmittance);
    sum += entry * (transmittance * entry[3]);
    transmittance *= 1 - entry[3]; // one step after another: the shorter way
    ++used;
  }
  color.rgb[0] = sum[0];
  color.rgb[1] = sum[1];
  color.rgb[2] = sum[2];
  color.transmittance = transmittance;
  return used;
}

int Composite(const StepLookup& lookup, SampleBatch& batch, int count, float opaque,
              RayColor& color, std::int64_t& clamped)
{
  Classified at;
  Classify(lookup, batch, count, at, clamped);
  return color.ofMany ? CompositeAs<double, ExactRgba>(lookup, batch, count, opaque, at, color)
                      : CompositeAs<float, Rgba>(lookup, batch, count, opaque, at, color);
}

} // namespace

const BrickKernel Bricks = {SampleRuns, Sample, Composite};

} // namespace INR_ISA
} // namespace inr

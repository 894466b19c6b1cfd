// SPDX-License-Identifier: BSD-3-Clause
//
// Where the samples of a batch are in their bricks. Only for sources that are built once per
// instruction set; see Core/Inference/Lanes.h.
#pragma once

#include "Core/CacheLine.h"
#include "Core/Inference/Lanes.h"
#include "Core/Render/Bricks/BrickKernel.h"

#include <cstring>

namespace inr {
namespace INR_ISA {

namespace {

void StoreInts(std::int32_t* to, Ints value) { std::memcpy(to, &value, sizeof(value)); }

static_assert(LaneCount <= SampleBatch::Room - SampleBatch::Capacity,
              "vectors reach past the last sample");

/// Where samples are in their bricks.
struct Located
{
  alignas(CacheLineBytes) float place[3][SampleBatch::Room];
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

/// Where `along` is on a path.
void FindPlaces(const Way& way, Floats along, Floats* places)
{
  for (int axis = 0; axis < 3; ++axis) {
    const Floats place = MultiplyAdd(along, way.direction[axis], way.origin[axis]);
    places[axis] = Minimum(Maximum(place, Floats{}), way.last[axis]);
  }
}

/// LaneCount places from `at` on, but for their voxels.
void PutPlaces(const Way& way, Floats along, int at, Located& out)
{
  Floats places[3];
  FindPlaces(way, along, places);
  for (int axis = 0; axis < 3; ++axis) {
    Store(out.place[axis] + at, places[axis]);
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

/// LaneCount samples of a run, at `at` in the batch.
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

/// Samples on one of two paths each.
struct Dithered
{
  Ints coarser; ///< -1 on the second path, else 0
  Floats along; ///< their path
};

Dithered Dither(const SampleRun& run, const Lanes& lanes)
{
  const Floats fine = AlongOf(run, 0, lanes);
  const Floats fraction = MultiplyAdd(fine, Spread(run.growth), Spread(run.fraction));
  const Ints coarser = RandomUnits(run, lanes) < fraction;
  return {coarser, coarser ? AlongOf(run, 1, lanes) : fine};
}

void PutOnTwoPaths(const SampleRun& run, const Lanes& lanes, SampleBatch& batch, Located& out)
{
  const BrickPath& a = batch.paths[run.path[0]];
  const BrickPath& b = batch.paths[run.path[1]];
  const Dithered is = Dither(run, lanes);
  PutPlaces(ChooseWay(is.coarser, a, b), is.along, lanes.at, out);
  Store(batch.along + lanes.at, is.along);
  StoreInts(batch.path + lanes.at, is.coarser ? run.path[1] - Ints{} : run.path[0] - Ints{});
}

void PutCommon(const SampleRun& run, int at, SampleBatch& batch)
{
  Store(batch.low + at, Spread(run.low));
  Store(batch.high + at, Spread(run.high));
  StoreInts(batch.length + at, run.length - Ints{});
}

/// The numbers of the run's samples that are taken.
void ListShown(const SampleRun& run, std::int32_t* numbers)
{
  std::uint64_t rest = run.shown;
  for (int k = 0; k < run.count; ++k) {
    numbers[k] = __builtin_ctzll(rest);
    rest &= rest - 1;
  }
}

/// Lays out a run from `at` on, numberOf(k) being the k-th and following ones' numbers; may write
/// up to LaneCount - 1 samples past its end.
template <typename NumberOf>
void LayOutBy(const NumberOf& numberOf, const SampleRun& run, int at, SampleBatch& batch,
              Located& out)
{
  const Way way = SpreadWay(batch.paths[run.path[0]]);
  for (int k = 0; k < run.count; k += LaneCount) {
    const Lanes lanes{numberOf(k), at + k};
    if (run.ways > 1) {
      PutOnTwoPaths(run, lanes, batch, out);
    } else {
      PutOnPath(run, way, lanes, batch, out);
    }
    PutCommon(run, lanes.at, batch);
  }
}

void LayOut(const SampleRun& run, int at, SampleBatch& batch, Located& out)
{
  const bool hasGaps = (run.shown & (run.shown + 1)) != 0;
  if (hasGaps) {
    std::int32_t numbers[SampleRow::Most + LaneCount] = {};
    ListShown(run, numbers);
    const auto listed = [&](int k) {
      Ints number;
      std::memcpy(&number, numbers + k, sizeof(number));
      return number;
    };
    LayOutBy(listed, run, at, batch, out);
    return;
  }
  Ints first;
  for (int lane = 0; lane < LaneCount; ++lane) {
    first[lane] = lane;
  }
  LayOutBy([&](int k) { return first + k; }, run, at, batch, out);
}

} // namespace

} // namespace INR_ISA
} // namespace inr

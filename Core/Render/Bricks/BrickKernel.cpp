// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Core/Inference/Lanes.h.
#include "Core/Render/Bricks/BrickKernel.h"

#include "Core/Inference/Lanes.h"
#include "Core/Render/Bricks/DirectionalShading.h"
#include "Core/Render/Bricks/FrontToBack.h"
#include "Core/Render/Bricks/GradientSamples.h"
#include "Core/Render/Bricks/IntegralCompositing.h"
#include "Core/Render/Bricks/SampleLayout.h"
#include "Core/Render/Bricks/StoredVoxels.h"

namespace inr {
namespace INR_ISA {

namespace {

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
  const Floats front = Mix(rows[0].pair().mix(x.weight), rows[1].pair().mix(x.weight), y.weight);
  const Floats back = Mix(rows[2].pair().mix(x.weight), rows[3].pair().mix(x.weight), y.weight);
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

/// A bit for each lane: whether its block of a brick is shown.
std::uint32_t LookUp(const ShownBlocks& blocks, Ints block)
{
#if defined(__AVX512F__)
  const __m512i words = _mm512_loadu_si512(blocks.words);
  const __m512i word = _mm512_maskz_permutexvar_epi32(0xffff, (__m512i)(block >> 5), words);
  return _mm512_test_epi32_mask(word, (__m512i)(1 << (block & 31)));
#elif defined(__AVX2__)
  const __m256i word =
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(blocks.words), (__m256i)(block >> 5), 4);
  const Ints sign = (Ints)word << (31 - (block & 31));
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)sign));
#else
  std::uint32_t bits = 0;
  for (int lane = 0; lane < LaneCount; ++lane) {
    const std::uint64_t bit = blocks.words[block[lane] >> 6] >> (block[lane] & 63) & 1;
    bits |= static_cast<std::uint32_t>(bit) << lane;
  }
  return bits;
#endif
}

/// Of samples in bricks, the numbers of their blocks.
Ints BlocksAt(const BrickFormat& format, const Way& way, Floats along)
{
  Floats places[3];
  FindPlaces(way, along, places);
  Ints block{};
  for (int axis = 2; axis >= 0; --axis) {
    Ints at = __builtin_convertvector(places[axis] * format.blocksPerVoxel, Ints);
    const Ints last = format.lastBlock[axis] - Ints{};
    at = at < last ? at : last;
    block = block * ShownBlocks::Words + at;
  }
  return block;
}

Ints FirstNumbers()
{
  Ints number;
  for (int lane = 0; lane < LaneCount; ++lane) {
    number[lane] = lane;
  }
  return number;
}

/// Not LowestBits: nothing inline comes from elsewhere.
std::uint64_t FirstBits(std::uint64_t bits, int count)
{
  return count < 64 ? bits & ((std::uint64_t{1} << count) - 1) : bits;
}

std::uint64_t FindShown(const BrickFormat& format, const ShownBlocks& blocks, const BrickPath& path,
                        const SampleRow& row, int count)
{
  Ints number = FirstNumbers();
  const Way way = SpreadWay(path);
  std::uint64_t shown = 0;
  for (int k = 0; k < count; k += LaneCount) {
    const Floats along =
        (__builtin_convertvector(number, Floats) * row.spacing + row.start) + row.offset;
    const Ints block = BlocksAt(format, way, along);
    shown |= static_cast<std::uint64_t>(LookUp(blocks, block)) << k;
    number += LaneCount;
  }
  return FirstBits(shown, count);
}

/// The same where a brick may be shown as a whole, or not at all.
std::uint32_t LookUpAny(const ShownBlocks& blocks, Ints block)
{
  switch (blocks.kind) {
  case ShownBlocks::Kind::All:
    return ~std::uint32_t{0};
  case ShownBlocks::Kind::None:
    return 0;
  case ShownBlocks::Kind::Some:
    break;
  }
  return LookUp(blocks, block);
}

std::uint32_t BitsOf(Ints mask)
{
#if defined(__AVX512F__)
  return _mm512_test_epi32_mask((__m512i)mask, (__m512i)mask);
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask));
#else
  std::uint32_t bits = 0;
  for (int lane = 0; lane < LaneCount; ++lane) {
    bits |= (mask[lane] & 1u) << lane;
  }
  return bits;
#endif
}

std::uint64_t FindShownOnTwo(const BrickFormat& format, const ShownBlocks* const (&blocks)[2],
                             const BrickPath* const (&paths)[2], const SampleRun& run, int count)
{
  constexpr std::uint64_t lanes = (std::uint64_t{1} << LaneCount) - 1;
  Ints number = FirstNumbers();
  std::uint64_t shown = 0;
  for (int k = 0; k < count; k += LaneCount) {
    const Dithered is = Dither(run, {number, k});
    const Ints block = BlocksAt(format, ChooseWay(is.coarser, *paths[0], *paths[1]), is.along);
    const std::uint32_t coarser = BitsOf(is.coarser);
    const std::uint64_t bits =
        (LookUpAny(*blocks[0], block) & ~coarser) | (LookUpAny(*blocks[1], block) & coarser);
    shown |= (bits & lanes) << k;
    number += LaneCount;
  }
  return FirstBits(shown, count);
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

/// Straight RGB and opacity of a sample that Classify has found. `Exact`: also where entries are
/// steep.
template <bool Exact>
Rgba ColorOf(const StepLookup& lookup, const Classified& at, const SampleBatch& batch, int k)
{
  const std::int64_t row = static_cast<std::int64_t>(batch.length[k]) * lookup.rows + at.entry[k];
  const Rgba first = LoadRgba(lookup.entries + 4 * row);
  const Rgba second = LoadRgba(lookup.entries + 4 * row + 4);
  Rgba color = first + (second - first) * at.weight[k];
  if (Exact && color[3] > 1.0f) {
    color[3] = SteepOpacityOf(lookup, batch.length[k], first[3], second[3], at.weight[k]);
  }
  return color;
}

void FindColors(const StepLookup& lookup, const SampleBatch& batch, int count, float* colors)
{
  Classified at;
  std::int64_t clamped = 0; // none: they are in their ranges
  Classify(lookup, batch, count, at, clamped);
  for (int k = 0; k < count; ++k) {
    const Rgba color = ColorOf<true>(lookup, at, batch, k);
    std::memcpy(colors + 4 * k, &color, sizeof(color));
  }
}

template <bool Exact>
int AddUpClassified(const StepLookup& lookup, const Classified& at, SampleBatch& batch, int count,
                    float opaque, RayColor& color)
{
  const auto sampleAt = [&](int k) {
    const Rgba entry = ColorOf<Exact>(lookup, at, batch, k);
    return ShownSample{entry, entry[3], entry[3]};
  };
  return AddUp(count, opaque, sampleAt, batch.opacity, color);
}

int Composite(const StepLookup& lookup, SampleBatch& batch, int count, float opaque,
              RayColor& color, std::int64_t& clamped)
{
  Classified at;
  Classify(lookup, batch, count, at, clamped);
  const RayColor before = color;
  const int used = AddUpClassified<false>(lookup, at, batch, count, opaque, color);
  if (color.transmittance >= 0) {
    return used;
  }
  color = before; // a steep entry, behind which there is less than nothing: once more, with care
  return AddUpClassified<true>(lookup, at, batch, count, opaque, color);
}

} // namespace

const BrickKernel Bricks = {FindShown, FindShownOnTwo, SampleRuns,
                            Sample,    Differentiate,  FindColors,
                            Light,     Composite,      CompositeIntegrated};

} // namespace INR_ISA
} // namespace inr

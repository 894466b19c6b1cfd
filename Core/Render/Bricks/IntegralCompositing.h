// SPDX-License-Identifier: BSD-3-Clause
//
// Compositing of samples that have the colours of all values between two. Only for sources that are
// built once per instruction set; see Core/Inference/Lanes.h.
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/FrontToBack.h"

#include <cstring>

namespace inr {
namespace INR_ISA {

namespace {

/// Where values are in a transfer function.
struct Positions
{
  float place[SampleBatch::Room];
  float way[SampleBatch::Room];         ///< from the node before to there
  std::int32_t node[SampleBatch::Room]; ///< that one, in IntegralLookup::nodes
};

void FindPositions(const IntegralLookup& lookup, const float* values, int count, Positions& out)
{
  const Floats last = Spread(static_cast<float>(lookup.last));
  for (int k = 0; k < count; k += LaneCount) {
    Floats place = MultiplyAdd(Load(values + k), Spread(lookup.scale), Spread(lookup.bias));
    place = Maximum(place, Spread(-1e30f)); // a beginning may be no number: below all colours
    const Floats inside = Minimum(Maximum(place, Floats{}), last);
    Ints node = __builtin_convertvector(inside, Ints);
    const Ints most = (lookup.last - 1) - Ints{};
    node = node < most ? node : most;
    node = place < Floats{} ? Ints{} - 1 : (place > last ? lookup.last - Ints{} : node);
    Store(out.place + k, place);
    Store(out.way + k, place - __builtin_convertvector(node, Floats));
    node = node + 1;
    std::memcpy(out.node + k, &node, sizeof(node));
  }
}

/// 1 / (end - begin), or 0 where that leaves too few digits, or where there is no node in between.
void FindSlopes(const Positions& begins, const Positions& ends, int count, float* slopes)
{
  for (int k = 0; k < count; k += LaneCount) {
    const Floats rise = Load(ends.place + k) - Load(begins.place + k);
    Ints from;
    Ints to;
    std::memcpy(&from, begins.node + k, sizeof(from));
    std::memcpy(&to, ends.node + k, sizeof(to));
    const Ints isFar = (Maximum(rise, -rise) > Spread(0.01f)) & (from != to);
    Store(slopes + k, isFar ? 1.0f / rise : Floats{});
  }
}

/// Density at a position, and its integral from the node before to there.
struct Reached
{
  Rgba density;
  Rgba integral;
};

Reached Reach(const IntegralNode& node, float way)
{
  const Rgba begin = LoadRgba(node.density);
  const Rgba density = begin + (LoadRgba(node.next) - begin) * way;
  return {density, (begin + density) * (0.5f * way)};
}

/// Mean densities from begins to ends.
void FindDensities(const IntegralLookup& lookup, const Positions& begins, const Positions& ends,
                   int count, float* densities)
{
  float slopes[SampleBatch::Room];
  FindSlopes(begins, ends, count, slopes);
  Reached end{};
  for (int k = 0; k < count; ++k) {
    const IntegralNode& from = lookup.nodes[begins.node[k]];
    const IntegralNode& to = lookup.nodes[ends.node[k]];
    const bool isNext = k > 0 && begins.place[k] == ends.place[k - 1];
    const Reached begin = isNext ? end : Reach(from, begins.way[k]);
    end = Reach(to, ends.way[k]);
    Rgba mean = (begin.density + end.density) * 0.5f;
    if (slopes[k] != 0.0f) {
      // In double: what is opaque elsewhere must not round away what is faint here.
      const ExactRgba between = LoadExactRgba(to.integral) - LoadExactRgba(from.integral);
      mean = (__builtin_convertvector(between, Rgba) + (end.integral - begin.integral)) * slopes[k];
    }
    std::memcpy(densities + 4 * k, &mean, sizeof(mean));
  }
}

constexpr float Opaque = 32; ///< depth

/// 1 - exp(-depth) for depths that are not negative, to a few units in the last place.
Floats OpacityOf(Floats depth)
{
  constexpr int halvings = 5;
  const Floats part = Minimum(depth, Spread(Opaque)) * (1.0f / (1 << halvings));
  // The series of (1 - exp(-x)) / x, for x up to 1.
  constexpr float factors[] = {-1.0f / 3628800, 1.0f / 362880, -1.0f / 40320, 1.0f / 5040,
                               -1.0f / 720,     1.0f / 120,    -1.0f / 24,    1.0f / 6,
                               -1.0f / 2,       1.0f};
  Floats sum = Spread(factors[0]);
  for (int k = 1; k < 10; ++k) {
    sum = MultiplyAdd(sum, part, Spread(factors[k]));
  }
  Floats opacity = sum * part;
  for (int k = 0; k < halvings; ++k) { // of twice the depth
    opacity = opacity * (2.0f - opacity);
  }
  return opacity;
}

/// Of the samples of which `densities` are, opacities, and by what these are to be multiplied.
void FindWeights(const IntegralLookup& lookup, const float* densities, const std::int32_t* lengths,
                 int count, float* opacities, float* weights)
{
  for (int k = 0; k < count; k += LaneCount) {
    Floats extinction;
    for (int lane = 0; lane < LaneCount; ++lane) {
      extinction[lane] = densities[4 * (k + lane) + 3];
    }
    extinction = Maximum(extinction, Floats{});
    Ints length;
    std::memcpy(&length, lengths + k, sizeof(length));
    const Ints steps = ((length & 1) * 2 + 1) << (length >> 1); // StepsOf
    const Floats depth = extinction * (__builtin_convertvector(steps, Floats) * lookup.step);
    const Ints isOpaque = extinction >= Spread(OpaqueFrom);
    const Floats opacity = OpacityOf(isOpaque ? Spread(Opaque) : depth);
    Store(opacities + k, opacity);
    Store(weights + k, opacity / Maximum(extinction, Spread(1e-30f)));
  }
}

int CompositeIntegrated(const IntegralLookup& lookup, SampleBatch& batch, int first, int end,
                        float opaque, RayColor& color)
{
  const int count = end - first;
  Positions begins;
  Positions ends;
  float densities[4 * SampleBatch::Room];
  float opacities[SampleBatch::Room];
  float weights[SampleBatch::Room];
  FindPositions(lookup, batch.begin + first, count, begins);
  FindPositions(lookup, batch.value + first, count, ends);
  FindDensities(lookup, begins, ends, count, densities);
  for (int lane = count; lane % LaneCount != 0; ++lane) { // whatever can be computed with
    std::memset(densities + 4 * lane, 0, 4 * sizeof(float));
  }
  FindWeights(lookup, densities, batch.length + first, count, opacities, weights);
  const auto sampleAt = [&](int k) {
    return ShownSample{LoadRgba(densities + 4 * k), weights[k], opacities[k]};
  };
  return AddUp(count, opaque, sampleAt, batch.opacity + first, color);
}

} // namespace

} // namespace INR_ISA
} // namespace inr

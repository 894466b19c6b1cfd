// SPDX-License-Identifier: BSD-3-Clause
// What the brick cache itself costs: looking up, storing, evicting. No network is involved.
#include "Core/Cache/BrickCache.h"
#include "Core/Random.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>

namespace {

constexpr std::int64_t Mapped = 100000;

/// The k-th of many bricks all over level 0 of a volume of 131072 voxels along every axis.
inr::BrickKey FarApart(std::int64_t k, std::int64_t bricksPerAxis)
{
  const auto axis = [&](std::uint64_t seed) {
    const std::uint64_t bits = inr::RandomBits(seed, static_cast<std::uint64_t>(k));
    return static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(bricksPerAxis));
  };
  return inr::KeyOf({0, {axis(1), axis(2), axis(3)}});
}

/// The k-th of a block of neighbours, 64 bricks a side.
inr::BrickKey Near(std::int64_t k)
{
  return inr::KeyOf({0, {1000 + k % 64, 1000 + k / 64 % 64, 1000 + k / 4096}});
}

/// `near`: keys of neighbours, asked for along x; else far apart, asked for in random order.
void Find(benchmark::State& state, bool near)
{
  const inr::Hierarchy levels({131072, 131072, 131072}, 40);
  std::vector<inr::BrickKey> keys(Mapped);
  inr::PageTable table(Mapped);
  for (std::int64_t k = 0; k < Mapped; ++k) {
    inr::BrickKey& key = keys[static_cast<std::size_t>(k)];
    key = near ? Near(k) : FarApart(k, levels.bricks(0).x);
    if (table.find(key) < 0) {
      table.map(key, static_cast<std::int32_t>(k));
    }
  }
  if (!near) {
    std::sort(keys.begin(), keys.end(),
              [](inr::BrickKey a, inr::BrickKey b) { return inr::MixBits(a) < inr::MixBits(b); });
  }
  std::size_t next = 0;
  for (auto step : state) {
    benchmark::DoNotOptimize(table.find(keys[next]));
    next = next + 1 == keys.size() ? 0 : next + 1;
  }
}
BENCHMARK_CAPTURE(Find, neighbours, true);
BENCHMARK_CAPTURE(Find, far_apart, false);

/// Storing, mapping and evicting one brick of 40 voxels a side.
void Insert(benchmark::State& state, inr::CachePrecision precision)
{
  const inr::Hierarchy levels({131072, 131072, 131072}, 40);
  inr::BrickCache cache(levels, precision, std::int64_t{64} << 20);
  std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()));
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = inr::RandomUnit(1, k);
  }
  std::int64_t next = 0;
  for (auto step : state) {
    cache.beginFrame(cache.frame() + 1);
    cache.insert(FarApart(next++, levels.bricks(0).x), values.data());
  }
}
BENCHMARK_CAPTURE(Insert, float32, inr::CachePrecision::Float32)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Insert, bits16, inr::CachePrecision::Bits16)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Insert, bits8, inr::CachePrecision::Bits8)->Unit(benchmark::kMicrosecond);

/// Of this thread, in seconds: what others do on the machine must not count.
double ProcessorTime()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A frame that uses every third of 10^5 bricks and 40 new ones after it; bricks are tiny, so that
/// it is the choice of the 40 victims that takes time. Touching is not timed.
void EvictForty(benchmark::State& state)
{
  const inr::Hierarchy levels({131072, 131072, 131072}, 4);
  const std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()), 0.5f);
  inr::BrickCache cache(levels, inr::CachePrecision::Bits8, std::int64_t{40} << 20);
  std::int64_t next = 0;
  while (cache.mapped() < cache.capacity()) {
    cache.insert(FarApart(next++, levels.bricks(0).x), values.data());
  }
  double longest = 0;
  for (auto step : state) {
    cache.beginFrame(cache.frame() + 1);
    for (std::int64_t slot = 0; slot < cache.capacity(); slot += 3) {
      cache.touch(static_cast<std::int32_t>(slot));
    }
    const double begin = ProcessorTime();
    for (int k = 0; k < 40; ++k) {
      cache.insert(FarApart(next++, levels.bricks(0).x), values.data());
    }
    const double taken = ProcessorTime() - begin;
    state.SetIterationTime(taken);
    longest = std::max(longest, taken);
  }
  state.counters["slots"] = static_cast<double>(cache.capacity());
  state.counters["longest_us"] = 1e6 * longest;
}
BENCHMARK(EvictForty)->UseManualTime()->Unit(benchmark::kMicrosecond);

} // namespace

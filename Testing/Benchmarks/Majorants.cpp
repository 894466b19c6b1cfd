// SPDX-License-Identifier: BSD-3-Clause
//
// Macro-cells per second of a change of transfer function, and of rays through empty space.
#include "Core/Render/MacroCells/Majorants.h"

#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Core/Render/MacroCells/CellWalker.h"

#include <benchmark/benchmark.h>

#include <algorithm>

namespace {

/// Cells of 1/edge with narrow ranges anywhere in [0, 1].
inr::MacroCells RandomCells(std::int64_t edge)
{
  inr::MacroCells cells;
  cells.dims = glm::i64vec3(edge);
  cells.spacing = glm::dvec3(1.0 / static_cast<double>(edge));
  for (std::int64_t k = 0; k < edge * edge * edge; ++k) {
    const auto low = static_cast<float>(inr::RandomUnit(3, static_cast<std::uint64_t>(k)));
    cells.ranges.push_back({low, std::min(1.0f, low + 0.05f)});
  }
  return cells;
}

/// Opacity rises from 0 at `first`.
inr::ColorTable Ramp(double first)
{
  constexpr int entries = 1024;
  inr::TransferFunction function;
  for (int k = 0; k < entries; ++k) {
    const double opacity = std::max(0.0, k / double{entries} - first);
    function.table.push_back({1, 1, 1, static_cast<float>(opacity)});
  }
  function.above = function.table.back();
  return {function, inr::VolumeInfo{}};
}

void Change(benchmark::State& state)
{
  const inr::Arena arena(static_cast<int>(state.range(1)));
  const inr::MacroCells cells = RandomCells(state.range(0));
  inr::Majorants majorants(cells, std::int64_t{16} * cells.dims, arena);
  const inr::ColorTable colors = Ramp(0.5);
  for (auto _ : state) {
    majorants.update(colors, arena);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cells.ranges.size()));
}
BENCHMARK(Change)
    ->ArgNames({"edge", "threads"})
    ->ArgsProduct({{16, 161, 256}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// Rays through a table of which next to nothing is visible.
void Leave(benchmark::State& state)
{
  const std::int64_t edge = state.range(0);
  inr::MajorantGrid majorants(RandomCells(edge));
  majorants.update(Ramp(1.0 - 0x1p-20), inr::Arena());
  const auto length = static_cast<double>(edge);
  std::uint64_t number = 0;
  for (auto _ : state) {
    const auto random = [&] { return inr::RandomUnit(7, number++); };
    inr::Ray ray;
    ray.entry = {random() * length, random() * length, -0.5};
    ray.direction = glm::normalize(glm::dvec3(random() - 0.5, random() - 0.5, 1.0));
    ray.inverse = 1.0 / ray.direction;
    ray.length = length;
    inr::GridWalker walker(majorants.view(), glm::dvec3(length), ray);
    walker.moveTo(0);
    benchmark::DoNotOptimize(walker.moveToVisible(ray.length));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(Leave)->ArgName("edge")->Arg(16)->Arg(161)->Arg(256);

} // namespace

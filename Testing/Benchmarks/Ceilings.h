// SPDX-License-Identifier: BSD-3-Clause
//
// What one core could do at most: the arithmetic of the network, or the loads of the grid.
#pragma once

#include "Core/AlignedVector.h"
#include "Core/Inference/HugePages.h"
#include "Core/Model/GridIndex.h"
#include "Testing/Benchmarks/Models.h"
#include "Testing/Core/RandomModel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>
#ifdef __x86_64__
#include <immintrin.h>
#endif

/// Runs `rounds` rounds of independent fused multiply-adds; returns how many were in a round.
using FusedOperations = std::int64_t (*)(std::int64_t rounds);

#ifdef __x86_64__
__attribute__((target("avx512f"))) inline std::int64_t FusedOperations512(std::int64_t rounds)
{
  constexpr int chains = 16;
  __m512 sums[chains]; // all different, or a compiler computes one for all
  for (int k = 0; k < chains; ++k) {
    sums[k] = _mm512_set1_ps(static_cast<float>(k));
  }
  const __m512 factor = _mm512_set1_ps(0.5f);
  for (std::int64_t k = 0; k < rounds; ++k) {
#pragma GCC unroll 16
    for (__m512& sum : sums) {
      sum = _mm512_fmadd_ps(sum, factor, factor);
    }
  }
  __m512 total = sums[0];
  for (const __m512& sum : sums) {
    total = _mm512_add_ps(total, sum);
  }
  benchmark::DoNotOptimize(total);
  return chains * 16;
}

__attribute__((target("avx2,fma"))) inline std::int64_t FusedOperations256(std::int64_t rounds)
{
  constexpr int chains = 12;
  __m256 sums[chains]; // all different, or a compiler computes one for all
  for (int k = 0; k < chains; ++k) {
    sums[k] = _mm256_set1_ps(static_cast<float>(k));
  }
  const __m256 factor = _mm256_set1_ps(0.5f);
  for (std::int64_t k = 0; k < rounds; ++k) {
#pragma GCC unroll 12
    for (__m256& sum : sums) {
      sum = _mm256_fmadd_ps(sum, factor, factor);
    }
  }
  __m256 total = sums[0];
  for (const __m256& sum : sums) {
    total = _mm256_add_ps(total, sum);
  }
  benchmark::DoNotOptimize(total);
  return chains * 8;
}
#endif

/// Null where the kernel's instruction set has no such operation.
inline FusedOperations FusedOperationsOf([[maybe_unused]] const std::string& kernel)
{
#ifdef __x86_64__
  return kernel == "avx512" ? FusedOperations512 : kernel == "avx2" ? FusedOperations256 : nullptr;
#else
  return nullptr;
#endif
}

inline void Arithmetic(benchmark::State& state, FusedOperations operations)
{
  constexpr std::int64_t rounds = 1 << 20;
  std::int64_t each = 0;
  for (auto step : state) {
    each = operations(rounds);
  }
  state.SetItemsProcessed(state.iterations() * rounds * each);
}

/// The table entries that inference reads at random positions, counted from the grid's start: of as
/// many samples as a vector of AVX-512 holds, one level's after the other's.
inline std::vector<std::uint32_t> EntriesOfSamples(const inr::Description& description,
                                                   std::int64_t samples)
{
  constexpr std::int64_t lanes = 16;
  const inr::Layout layout(description);
  const std::vector<glm::vec3> positions = RandomPositions(samples);
  std::vector<std::uint32_t> entries;
  for (std::int64_t first = 0; first < samples; first += lanes) {
    for (const inr::GridLevel& level : layout.levels) {
      for (std::int64_t k = first; k < std::min(first + lanes, samples); ++k) {
        const glm::uvec3 cell(positions[static_cast<std::size_t>(k)] * level.scale + 0.5f);
        for (unsigned c = 0; c < 8; ++c) {
          const std::uint32_t entry =
              inr::GridIndex(level, description.grid.hash, cell.x + (c & 1u),
                             cell.y + ((c >> 1) & 1u), cell.z + (c >> 2));
          entries.push_back(static_cast<std::uint32_t>(level.offset) + entry);
        }
      }
    }
  }
  return entries;
}

/// Samples of the default model whose table entries are read and added up, no more: where they are
/// is known before, and they are fetched ahead.
inline void EntryLoads(benchmark::State& state)
{
  constexpr std::int64_t samples = 1 << 16;
  constexpr std::size_t ahead = 512; // 256 to 1024 are alike on Zen 4, 64 and 2048 slower
  constexpr std::size_t features = 8;
  const inr::Description description = DefaultDescription();
  const std::vector<std::uint32_t> entries = EntriesOfSamples(description, samples);
  const inr::Layout layout(description);
  inr::AlignedVector<float> table(layout.parameterCount - layout.gridOffset, 1.0f); // as a model's
  inr::PreferHugePages(table.data(), table.size() * sizeof(float));
  for (auto step : state) {
    float sums[features] = {};
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const std::size_t later = std::min(k + ahead, entries.size() - 1);
      __builtin_prefetch(&table[entries[later] * features], 0, 2); // as inference does
      const float* const entry = &table[entries[k] * features];
      for (std::size_t f = 0; f < features; ++f) {
        sums[f] += entry[f];
      }
    }
    benchmark::DoNotOptimize(sums);
  }
  state.SetItemsProcessed(state.iterations() * samples);
}

// SPDX-License-Identifier: BSD-3-Clause
//
// What one core could do at most: the arithmetic of the network, or the loads of the grid.
#pragma once

#include "Core/AlignedVector.h"
#include "Core/Inference/HugePages.h"
#include "Core/Random.h"

#include <benchmark/benchmark.h>

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

/// Reads of eight floats each at random places of a table of `rows` times as many. The places come
/// from a list, as they come from hashes in inference.
inline void RandomLoads(benchmark::State& state, std::uint64_t rows)
{
  inr::AlignedVector<float> table(rows * 8, 1.0f); // as a model's
  inr::PreferHugePages(table.data(), table.size() * sizeof(float));
  std::vector<std::uint32_t> places(1 << 16);
  for (std::size_t k = 0; k < places.size(); ++k) {
    places[k] = static_cast<std::uint32_t>(inr::RandomBits(1, k) % rows);
  }
  std::uint64_t shift = 0;
  for (auto step : state) {
    float sums[8] = {};
    shift = (shift + 7919) % rows; // other places every time
    for (const std::uint32_t place : places) {
      const std::uint64_t at = place + shift;
      const float* const row = &table[(at < rows ? at : at - rows) * 8];
      for (int f = 0; f < 8; ++f) {
        sums[f] += row[f];
      }
    }
    benchmark::DoNotOptimize(sums);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}

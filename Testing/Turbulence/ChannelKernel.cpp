// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set (see INRInstructionSets.cmake), so neither the standard library's
// templates nor inline functions from elsewhere are used here.
#include "Testing/Turbulence/ChannelKernel.h"

#include <cstring>

namespace inr {
namespace INR_ISA {

namespace {

#if defined(__AVX512F__)
constexpr int Lanes = 8;
#elif defined(__AVX2__)
constexpr int Lanes = 4;
#else
constexpr int Lanes = 2;
#endif
using Doubles = double __attribute__((vector_size(8 * Lanes)));
constexpr int WaveVectors = ChannelWaves / Lanes;
constexpr int SumsAtOnce = 8; // enough to hide an addition's latency, few enough for the registers

inline Doubles Load(const double* from)
{
  Doubles value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

inline void Store(double* to, Doubles value) { std::memcpy(to, &value, sizeof(value)); }
inline Doubles Spread(double value) { return value - Doubles{}; }

void Collect(Phasors plane, Phasors coarse, Phasors fine, int groups, double* row)
{
  Doubles cosines[WaveVectors] = {};
  Doubles sines[WaveVectors] = {};
  for (int group = 0; group < groups; ++group) {
    for (int k = 0; k < WaveVectors; ++k) {
      const int mode = ChannelWaves * group + Lanes * k;
      const Doubles a = Load(coarse.cosines + mode);
      const Doubles b = Load(coarse.sines + mode);
      const Doubles c = Load(fine.cosines + mode);
      const Doubles d = Load(fine.sines + mode);
      const Doubles turnCosine = a * c - b * d;
      const Doubles turnSine = b * c + a * d;
      const Doubles p = Load(plane.cosines + mode);
      const Doubles q = Load(plane.sines + mode);
      cosines[k] += p * turnCosine - q * turnSine;
      sines[k] -= q * turnCosine + p * turnSine;
    }
  }
  for (int k = 0; k < WaveVectors; ++k) {
    Store(row + Lanes * k, cosines[k]);
    Store(row + ChannelWaves + Lanes * k, sines[k]);
  }
}

// The row's numbers with their origin moved to the tile's first voxel.
void Turn(const double* row, Phasors coarse, double* turned)
{
  for (int k = 0; k < ChannelWaves; k += Lanes) {
    const Doubles c = Load(row + k);
    const Doubles s = Load(row + ChannelWaves + k);
    const Doubles turnCosine = Load(coarse.cosines + k);
    const Doubles turnSine = Load(coarse.sines + k);
    Store(turned + k, c * turnCosine + s * turnSine);
    Store(turned + ChannelWaves + k, s * turnCosine - c * turnSine);
  }
}

void Tile(const double* row, Phasors coarse, Phasors fine, double mean, double* values)
{
  double turned[2 * ChannelWaves];
  Turn(row, coarse, turned);
  for (int first = 0; first < ChannelTile; first += SumsAtOnce * Lanes) {
    Doubles sums[SumsAtOnce];
    for (Doubles& sum : sums) {
      sum = Spread(mean);
    }
    for (int wave = 0; wave < ChannelWaves; ++wave) {
      const Doubles c = Spread(turned[wave]);
      const Doubles s = Spread(turned[ChannelWaves + wave]);
      const int at = ChannelTile * wave + first;
      for (int k = 0; k < SumsAtOnce; ++k) {
        sums[k] += c * Load(fine.cosines + at + Lanes * k);
        sums[k] += s * Load(fine.sines + at + Lanes * k);
      }
    }
    for (int k = 0; k < SumsAtOnce; ++k) {
      Store(values + first + Lanes * k, sums[k]);
    }
  }
}

} // namespace

const ChannelKernel Channel = {Collect, Tile};

} // namespace INR_ISA
} // namespace inr

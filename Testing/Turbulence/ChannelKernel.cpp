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

constexpr int PointVectors = ChannelPoints / Lanes;
constexpr double Undamped = 40; // exp(-40) is lost in 1

inline Doubles Nearest(Doubles value) // whole number; of less than 2^51
{
  constexpr double shift = 0x1.8p52;
  return (value + shift) - shift;
}

// cos(2 pi turns) within 1e-13: the Taylor series of the sine, a quarter turn on.
inline Doubles CosineOfTurns(Doubles turns)
{
  constexpr double series[] = {-1.0 / 121645100408832000,
                               1.0 / 355687428096000,
                               -1.0 / 1307674368000,
                               1.0 / 6227020800,
                               -1.0 / 39916800,
                               1.0 / 362880,
                               -1.0 / 5040,
                               1.0 / 120,
                               -1.0 / 6,
                               1.0};
  const Doubles part = turns - Nearest(turns);
  const Doubles angle = 6.283185307179586 * (0.25 - (part < 0 ? -part : part));
  const Doubles square = angle * angle;
  Doubles sum = Doubles{};
  for (const double factor : series) {
    sum = sum * square + factor;
  }
  return angle * sum;
}

// exp(-x), 0 <= x <= Undamped, within 1e-12 of itself: the series at a 64th of it, squared.
inline Doubles Decay(Doubles x)
{
  constexpr double series[] = {1.0 / 479001600,
                               1.0 / 39916800,
                               1.0 / 3628800,
                               1.0 / 362880,
                               1.0 / 40320,
                               1.0 / 5040,
                               1.0 / 720,
                               1.0 / 120,
                               1.0 / 24,
                               1.0 / 6,
                               0.5,
                               1.0,
                               1.0};
  const Doubles small = x * (-1.0 / 64);
  Doubles sum = Doubles{};
  for (const double factor : series) {
    sum = sum * small + factor;
  }
  for (int k = 0; k < 6; ++k) {
    sum *= sum;
  }
  return sum;
}

inline Doubles Damping(Doubles room)
{
  const Doubles square = room * room;
  return 1.0 - Decay(square < Undamped ? square : Spread(Undamped));
}

void Points(const PointMode* modes, int count, const PointPlaces& places, double* sums)
{
  double nearest = places.distance[0];
  for (const double distance : places.distance) {
    nearest = distance < nearest ? distance : nearest;
  }
  Doubles total[PointVectors] = {};
  for (const PointMode* mode = modes; mode < modes + count; ++mode) {
    const double least = nearest * mode->across;
    const bool isDamped = least * least < Undamped;
    for (int k = 0; k < PointVectors; ++k) {
      const Doubles distance = Load(places.distance + Lanes * k);
      const Doubles turns = Load(places.x + Lanes * k) * mode->nx +
                            Load(places.y + Lanes * k) * mode->ny + mode->phase +
                            Load(places.stretched + Lanes * k) * mode->vertical -
                            distance * mode->along;
      const Doubles wave = mode->amplitude * CosineOfTurns(turns);
      total[k] += isDamped ? wave * Damping(distance * mode->across) : wave;
    }
  }
  for (int k = 0; k < PointVectors; ++k) {
    Store(sums + Lanes * k, total[k]);
  }
}

} // namespace

const ChannelKernel Channel = {Collect, Tile, Points};

} // namespace INR_ISA
} // namespace inr

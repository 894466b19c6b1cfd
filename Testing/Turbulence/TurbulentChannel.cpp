// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/TurbulentChannel.h"

#include "Core/Error.h"
#include "Core/Random.h"
#include "Testing/Turbulence/ChannelKernel.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace inr {
namespace {

constexpr double TwoPi = 6.283185307179586;
constexpr int Groups = 32;           // modes for each streamwise wave number
constexpr double LargestScale = 2.0; // wave number across the stream where the octaves begin
constexpr double LeastSlender = 1.5; // of a structure: length over width
constexpr double MostSlender = 64.0;
constexpr double Convection = 0.8; // speed that carries all structures downstream
constexpr double Decay = 0.3;      // how fast they change on the way

double Smallest(int octaves) { return std::ldexp(LargestScale, octaves); }

double Uniform(std::uint64_t seed, std::uint64_t counter)
{
  return static_cast<double>(RandomBits(seed, counter) >> 11) * 0x1p-53;
}

// Waves in the channel's length, evenly spread over the octaves from the longest on.
int StreamwiseWaves(int wave, int octaves)
{
  const double most = Smallest(octaves) / (2 * LeastSlender) * TurbulentChannel::Size.x / TwoPi;
  return static_cast<int>(std::lround(std::pow(most, wave / (ChannelWaves - 1.0))));
}

double Octave(const TurbulentChannel::Mode& mode)
{
  return std::floor(std::log2(mode.across / LargestScale));
}

// Draws everything but the amplitude. The wave numbers across the stream that suit the streamwise
// one are drawn one from each of `Groups` equal parts of their range, by octaves.
TurbulentChannel::Mode DrawMode(const TurbulentChannel::Parameters& parameters, int group, int wave)
{
  const auto number = static_cast<std::uint64_t>(4 * (ChannelWaves * group + wave));
  TurbulentChannel::Mode mode{};
  mode.nx = StreamwiseWaves(wave, parameters.octaves);
  const double along = TwoPi * mode.nx / TurbulentChannel::Size.x;
  const double low = std::max(LargestScale, LeastSlender * along);
  const double high = std::min(Smallest(parameters.octaves), MostSlender * along);
  const double part = (group + Uniform(parameters.seed, number)) / Groups;
  mode.across = low * std::pow(high / low, part);
  const double angle = TwoPi * Uniform(parameters.seed, number + 1);
  mode.ny = static_cast<int>(
      std::lround(mode.across * std::cos(angle) * TurbulentChannel::Size.y / TwoPi));
  mode.vertical = mode.across * std::sin(angle);
  const double turnover =
      (2 * Uniform(parameters.seed, number + 2) - 1) * Decay * std::cbrt(mode.across * mode.across);
  mode.phase = TwoPi * Uniform(parameters.seed, number + 3) -
               (Convection * along + turnover) * parameters.time;
  return mode;
}

// Energy per octave falls as the wave number to the power -2/3, which is -5/3 per wave number.
void ShareEnergy(const TurbulentChannel::Parameters& parameters,
                 std::vector<TurbulentChannel::Mode>& modes)
{
  std::vector<double> energy(static_cast<std::size_t>(parameters.octaves) + 1, 0.0);
  std::vector<int> count(energy.size(), 0);
  double total = 0;
  for (const TurbulentChannel::Mode& mode : modes) {
    const auto octave = static_cast<std::size_t>(Octave(mode));
    energy[octave] = std::exp2(-2.0 / 3.0 * Octave(mode));
    ++count[octave];
  }
  for (const double part : energy) {
    total += part;
  }
  for (TurbulentChannel::Mode& mode : modes) {
    const auto octave = static_cast<std::size_t>(Octave(mode));
    mode.amplitude = parameters.intensity * std::sqrt(2 * energy[octave] / count[octave] / total);
  }
}

// Distance from the nearer wall in half-heights, smooth in the middle, where it is 1/2.
double WallDistance(double z) { return 2 * z * (1 - z); }

// Fraction of a turn of `waves` waves at u: exact up to the last rounding, however many there are.
double Turns(int waves, double u)
{
  const double product = waves * u;
  const double error = std::fma(waves, u, -product);
  return product - std::rint(product) + error;
}

void Require(bool condition, const std::string& message)
{
  if (!condition) {
    throw Error(ErrorCode::InvalidArgument, message);
  }
}

} // namespace

TurbulentChannel::TurbulentChannel(const Parameters& parameters) : Chosen(parameters)
{
  Require(parameters.octaves >= 1 && parameters.octaves <= 8,
          "a turbulent channel has 1 to 8 octaves, not " + std::to_string(parameters.octaves));
  Require(parameters.intensity >= 0 && parameters.intensity <= 1,
          "a turbulent channel's intensity is 0 to 1");
  Require(std::abs(parameters.time) <= 1e6,
          "a turbulent channel's time is a number from -1e6 to 1e6");
  for (int group = 0; group < Groups; ++group) {
    for (int wave = 0; wave < ChannelWaves; ++wave) {
      this->Modes.push_back(DrawMode(parameters, group, wave));
    }
  }
  ShareEnergy(parameters, this->Modes);
}

double TurbulentChannel::at(const glm::dvec3& u) const
{
  const Height height(u.z);
  double sum = 0;
  for (const Mode& mode : this->Modes) {
    const glm::dvec2 here = height.of(mode);
    const double turns = Turns(mode.nx, u.x) + Turns(mode.ny, u.y);
    sum += here.x * std::cos(TwoPi * turns + here.y);
  }
  return mean(u.z) + sum;
}

// Reichardt's profile ("Vollstaendige Darstellung der turbulenten Geschwindigkeitsverteilung in
// glatten Leitungen", ZAMM 31, 1951) at a friction Reynolds number of 500.
double TurbulentChannel::mean(double z)
{
  constexpr double karman = 0.41;
  const auto profile = [](double y) {
    return std::log1p(karman * y) / karman +
           7.8 * (1 - std::exp(-y / 11) - y / 11 * std::exp(-y / 3));
  };
  constexpr double reynolds = 500;
  return profile(reynolds * WallDistance(z)) / profile(reynolds * 0.5);
}

// Near a wall there is room for small structures only, which are the stronger for it; the closer,
// the finer they are. Away from it they lean downstream.
TurbulentChannel::Height::Height(double z) : Distance(WallDistance(z))
{
  const double height = 2 * z - 1;
  this->Stretched = height + 0.12 * std::pow(height, 5);
  this->Strength = 1.4 - 0.8 * this->Distance;
}

glm::dvec2 TurbulentChannel::Height::of(const Mode& mode) const
{
  const double room = this->Distance * mode.across;
  const double damping = this->Strength * (1 - std::exp(-room * room));
  const double along = TwoPi * mode.nx / Size.x;
  return {mode.amplitude * damping,
          mode.phase + mode.vertical * this->Stretched - along * this->Distance};
}

} // namespace inr

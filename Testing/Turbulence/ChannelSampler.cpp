// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/ChannelSampler.h"

#include <algorithm>
#include <iterator>

namespace inr {
namespace {

constexpr double TwoPi = 6.283185307179586;

PointMode ForPoints(const TurbulentChannel::Mode& mode)
{
  const double along = TwoPi * mode.nx / TurbulentChannel::Size.x;
  return {static_cast<double>(mode.nx),
          static_cast<double>(mode.ny),
          mode.phase / TwoPi,
          mode.vertical / TwoPi,
          along / TwoPi,
          mode.across,
          mode.amplitude};
}

} // namespace

ChannelSampler::ChannelSampler(const TurbulentChannel& field, const std::string& kernel)
    : Kernel(ChannelKernelFor(ChooseInstructionSet(kernel)))
{
  std::transform(field.modes().begin(), field.modes().end(), std::back_inserter(this->Modes),
                 ForPoints);
}

void ChannelSampler::at(const glm::dvec3* points, std::int64_t count, double* values) const
{
  for (std::int64_t first = 0; first < count; first += ChannelPoints) {
    const std::int64_t left = std::min<std::int64_t>(ChannelPoints, count - first);
    this->block(points + first, static_cast<int>(left), values + first);
  }
}

void ChannelSampler::block(const glm::dvec3* points, int count, double* values) const
{
  PointPlaces places;
  double means[ChannelPoints];
  double strengths[ChannelPoints];
  for (int k = 0; k < ChannelPoints; ++k) {
    const glm::dvec3& point = points[std::min(k, count - 1)]; // the last again, to fill the block
    const TurbulentChannel::Height height(point.z);
    places.x[k] = point.x;
    places.y[k] = point.y;
    places.distance[k] = height.distance();
    places.stretched[k] = height.stretched();
    means[k] = TurbulentChannel::mean(point.z);
    strengths[k] = height.strength();
  }
  double sums[ChannelPoints];
  this->Kernel.points(this->Modes.data(), static_cast<int>(this->Modes.size()), places, sums);
  for (int k = 0; k < count; ++k) {
    values[k] = means[k] + strengths[k] * sums[k];
  }
}

} // namespace inr

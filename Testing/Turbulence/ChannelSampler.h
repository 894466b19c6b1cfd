// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Testing/Turbulence/ChannelKernel.h"
#include "Testing/Turbulence/TurbulentChannel.h"

#include <cstdint>
#include <string>
#include <vector>

namespace inr {

/// TurbulentChannel::at for many points at once, some ten times as fast and within 1e-12 of it.
/// Immutable: any number of threads may use one at once. A value depends on nothing but the field
/// and the point, on any processor.
class ChannelSampler
{
public:
  /// `kernel` asks for an instruction set by name (for tests).
  explicit ChannelSampler(const TurbulentChannel& field, const std::string& kernel = "");

  /// The values at `count` points of the unit cube.
  void at(const glm::dvec3* points, std::int64_t count, double* values) const;

private:
  void block(const glm::dvec3* points, int count, double* values) const;

  const ChannelKernel& Kernel;
  std::vector<PointMode> Modes;
};

} // namespace inr

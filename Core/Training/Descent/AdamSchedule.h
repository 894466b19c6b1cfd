// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace inr {

/// What differs from update to update.
struct AdamStep
{
  float rate;  ///< learning rate, the correction of the moments' bias included
  float beta2; ///< how much of the second moment is kept
};

/// A parameter's t-th update, t = 1 .. last, with a learning rate of 1; then it stays.
struct AdamSchedule
{
  const AdamStep* steps;
  std::uint16_t last;
};

/// Share of the first moment that every update keeps.
constexpr float FirstMomentKept = 0.9f;

/// From this many updates of a parameter on all are alike.
constexpr std::uint16_t LastAdamUpdate = 16384;

/// A parameter's t-th update for t = 0, which never happens, to LastAdamUpdate, for a learning rate
/// of 1: rates correct for the zeros that the moments begin with (Kingma and Ba, "Adam", ICLR 2015,
/// section 3).
std::vector<AdamStep> AdamUpdates();

} // namespace inr

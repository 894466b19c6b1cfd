// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Runtime/StateArray.h"

#include <cstdint>
#include <vector>

/// Such arrays as a checkpoint holds, but small.
struct CheckpointArrays
{
  std::vector<float> values{0.0f, 1.0f, 2.0f};
  std::vector<std::uint16_t> counts{7, 65535};

  inr::StateArrays list()
  {
    return {{"values", this->values.data(), 12},
            {"counts", this->counts.data(), 4},
            {"nothing", nullptr, 0}};
  }
  bool operator==(const CheckpointArrays& other) const
  {
    return this->values == other.values && this->counts == other.counts;
  }
};

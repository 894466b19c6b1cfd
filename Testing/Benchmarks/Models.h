// SPDX-License-Identifier: BSD-3-Clause
//
// The models and bricks that several benchmarks time.
#pragma once

#include "Core/Cache/Hierarchy.h"
#include "Core/Random.h"
#include "Core/Training/Trainer.h"

#include <algorithm>
#include <vector>

/// instantvnr's default model: 8 levels of 8 features, 64 x 4; 23 M parameters.
inline inr::Description DefaultDescription()
{
  inr::Description description;
  description.grid.levels = 8;
  description.grid.features = 8;
  description.network.neurons = 64;
  description.network.hiddenLayers = 4;
  return description;
}

/// What the writer chooses for 256^3 bytes.
inline inr::Description ChosenDescription()
{
  return inr::ChooseDescription({256, 256, 256}, inr::ScalarType::UInt8, 0);
}

/// Bricks all over a level that lie whole inside it.
inline std::vector<inr::BrickKey> SomeBricks(const inr::Hierarchy& levels, int level, int count)
{
  std::vector<inr::BrickKey> keys;
  const auto whole =
      static_cast<std::uint64_t>(std::max<std::int64_t>(1, levels.bricks(level).x - 1));
  for (int k = 0; k < count; ++k) {
    const auto axis = [&](std::uint64_t seed) {
      return static_cast<std::int64_t>(inr::RandomBits(seed, static_cast<std::uint64_t>(k)) %
                                       whole);
    };
    keys.push_back(inr::KeyOf({level, {axis(1), axis(2), axis(3)}}));
  }
  return keys;
}

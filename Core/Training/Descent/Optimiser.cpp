// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Descent/Optimiser.h"

#include <algorithm>
#include <cmath>

namespace inr {

int OrthogonalisedLayers(const NetworkDescription& network)
{
  constexpr int widest = 128;
  return network.neurons <= widest ? network.hiddenLayers : 0;
}

float OrthogonalRate(std::uint64_t update)
{
  return static_cast<float>(std::min(8.0, 40.0 / std::sqrt(static_cast<double>(update))));
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
//
// Frames that are timed beside each other, in turn and again and again: on a machine that does
// something else, too, only the ratio of two that were drawn one right after the other says much.
#pragma once

#include "Core/Render/Renderer.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>
#include <string>
#include <vector>

/// Of some numbers.
struct Spread
{
  double low; ///< quartile
  double median;
  double high;

  /// For a line of Report.
  std::string json() const
  {
    std::ostringstream text;
    text << ", \"low\": " << this->low << ", \"high\": " << this->high;
    return text.str();
  }
};

inline Spread SpreadOf(std::vector<double> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  const auto at = [&](double part) {
    const double place = part * static_cast<double>(numbers.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, numbers.size() - 1);
    return numbers[below] + (place - std::floor(place)) * (numbers[above] - numbers[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

/// Of the process, for a frame.
inline double ProcessorSecondsOf(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image picture;
  const std::clock_t start = std::clock();
  renderer.render(frame, picture);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// The time of a frame as a part of another's, so many times; each is drawn first every other time.
inline std::vector<double> RatiosInTurn(inr::Renderer& renderer, const inr::Frame& frame,
                                        const inr::Frame& other, int rounds)
{
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const bool first = round % 2 == 0;
    const double before = ProcessorSecondsOf(renderer, first ? frame : other);
    const double after = ProcessorSecondsOf(renderer, first ? other : frame);
    ratios.push_back(first ? before / after : after / before);
  }
  return ratios;
}

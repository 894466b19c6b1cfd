// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of more bricks than their cache on the device holds, and how tests draw them.
#pragma once

#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/SmallCache.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace test::overfull {

constexpr double Hurry = 1e-9;  ///< s: a call brings some ray further, and no more
constexpr int MostCalls = 2000; ///< that any of these pictures takes

inline inr::Frame Hurried(inr::Frame frame)
{
  frame.timeLimit = Hurry;
  return frame;
}

inline inr::Frame LitFrame(inr::RenderMode mode)
{
  inr::Frame frame = FullResolution(mode);
  Shade(frame);
  return frame;
}

/// Of the same size, from elsewhere.
inline inr::Frame OtherFrame(inr::RenderMode mode)
{
  inr::Frame frame = FullResolution(mode);
  frame.clipToWorld[0][0] *= 1.1;
  return frame;
}

/// Turned round by half.
inline inr::Frame FromBehind(inr::Frame frame)
{
  const glm::dvec3 center = 0.5 * glm::dvec3(TrainedModel()->volume.dims);
  glm::dmat4 turn = glm::translate(glm::dmat4(1.0), center);
  turn = glm::rotate(turn, glm::radians(180.0), glm::dvec3(0, 1, 0));
  frame.clipToWorld = glm::translate(turn, -center) * frame.clipToWorld;
  return frame;
}

/// Pixels that show something, and the same to the last bit.
inline int PixelsOfBoth(const inr::Image& one, const inr::Image& other)
{
  int both = 0;
  for (std::size_t k = 0; k < one.pixels.size(); k += 4) {
    const auto begin = one.pixels.begin() + static_cast<std::ptrdiff_t>(k);
    const bool shows = begin[0] > 0;
    both +=
        shows && std::equal(begin, begin + 4, other.pixels.begin() + static_cast<std::ptrdiff_t>(k))
            ? 1
            : 0;
  }
  return both;
}

/// Pixels that show neither what they showed `before` nor what they are to show in the end.
inline int PixelsInBetween(const inr::Image& now, const inr::Image& before, const inr::Image& end)
{
  int others = 0;
  for (std::size_t k = 0; k < now.pixels.size(); k += 4) {
    const auto is = [&](const inr::Image& other) {
      return std::equal(now.pixels.begin() + static_cast<std::ptrdiff_t>(k),
                        now.pixels.begin() + static_cast<std::ptrdiff_t>(k + 4),
                        other.pixels.begin() + static_cast<std::ptrdiff_t>(k));
    };
    others += is(before) || is(end) ? 0 : 1;
  }
  return others;
}

/// Draws until a picture waits for more than the cache holds; what there is of it.
inline inr::FrameStatistics Begin(inr::Renderer& renderer, const inr::Frame& frame,
                                  inr::Image& image)
{
  inr::FrameStatistics statistics;
  int calls = 0;
  do {
    statistics = renderer.render(frame, image);
  } while (statistics.missed > 0 && ++calls < MostCalls);
  EXPECT_FALSE(statistics.complete);
  return statistics;
}

/// Draws what a few calls bring.
inline void DrawSome(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  for (int call = 0; call < 20; ++call) {
    EXPECT_FALSE(renderer.render(frame, image).complete) << call;
  }
}

/// Draws until a picture is complete.
inline inr::FrameStatistics End(inr::Renderer& renderer, const inr::Frame& frame, inr::Image& image)
{
  inr::FrameStatistics statistics;
  int calls = 0;
  do {
    statistics = renderer.render(frame, image);
  } while (!statistics.complete && ++calls < MostCalls);
  EXPECT_TRUE(statistics.complete);
  return statistics;
}

} // namespace test::overfull

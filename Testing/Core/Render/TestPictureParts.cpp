// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/PictureParts.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace test::picture_parts {

std::int64_t Pixels(const inr::PixelBox& box) { return std::int64_t{box.size().x} * box.size().y; }

bool Has(const inr::PixelBox& box, const glm::ivec2& pixel)
{
  return glm::all(glm::greaterThanEqual(pixel, box.first)) &&
         glm::all(glm::lessThan(pixel, box.end));
}

/// A camera that looks past the middle of a volume from so many voxels away.
inr::Frame Look(const glm::dvec3& dims, double away, double angle)
{
  inr::Frame frame;
  frame.width = 97;
  frame.height = 61;
  const glm::dvec3 middle = 0.5 * dims;
  const glm::dvec3 eye = middle + away * glm::dvec3(std::cos(angle), 0.4, std::sin(angle));
  const glm::dvec3 target = middle + 0.3 * dims;
  const glm::dmat4 view = glm::lookAt(eye, target, glm::dvec3(0.1, 1.0, 0.0));
  const glm::dmat4 toClip = glm::perspective(0.6, 97.0 / 61.0, 0.1, 4000.0) * view;
  frame.clipToWorld = glm::inverse(toClip);
  return frame;
}

TEST(PictureParts, MakeUpTheWhole)
{
  const inr::PixelBox box{{3, 5}, {40, 29}};
  for (int processes = 1; processes <= 40; ++processes) {
    std::vector<int> drawn(std::size_t{45} * 35, 0);
    for (int process = 0; process < processes; ++process) {
      const inr::PixelBox part = inr::PartOf(box, process, processes);
      std::vector<float> depth;
      inr::KeepOnly(part, {45, 35}, depth);
      ASSERT_EQ(depth.size(), drawn.size());
      for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
        drawn[pixel] += depth[pixel] > 0 ? 1 : 0;
      }
    }
    for (int pixel = 0; pixel < 45 * 35; ++pixel) {
      const bool inside = Has(box, {pixel % 45, pixel / 45});
      ASSERT_EQ(drawn[pixel], inside ? 1 : 0) << pixel << " by " << processes;
    }
  }
}

TEST(PictureParts, AreAsLargeAsEachOtherAndCompact)
{
  const inr::PixelBox box{{0, 0}, {1920, 1080}};
  for (int processes = 2; processes <= 300; ++processes) {
    for (int process = 0; process < processes; ++process) {
      const inr::PixelBox part = inr::PartOf(box, process, processes);
      const double share = 1920.0 * 1080.0 / processes;
      EXPECT_NEAR(static_cast<double>(Pixels(part)), share, 0.05 * share) << processes;
      const glm::ivec2 size = part.size();
      EXPECT_LE(std::max(size.x, size.y), 3 * std::min(size.x, size.y) + 3) << processes;
    }
  }
}

TEST(PictureParts, AreThereWhereNothingIs)
{
  for (const inr::PixelBox& box : {inr::PixelBox{{7, 7}, {7, 7}}, inr::PixelBox{{7, 7}, {8, 8}}}) {
    std::int64_t pixels = 0;
    for (int process = 0; process < 5; ++process) {
      pixels += Pixels(inr::PartOf(box, process, 5));
    }
    EXPECT_EQ(pixels, Pixels(box));
  }
}

TEST(PictureParts, KeepWhatIsThere)
{
  std::vector<float> depth(6, 0.25f);
  inr::KeepOnly({{1, 0}, {2, 2}}, {3, 2}, depth);
  EXPECT_EQ(depth, (std::vector<float>{0, 0.25f, 0, 0, 0.25f, 0}));
}

/// All points of the volume, but those outside the picture, are in the box; and it is no larger
/// than they are, from outside.
TEST(PictureParts, ShowTheVolume)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0.0, 1.0);
  const glm::i64vec3 dims(40, 25, 9);
  for (int look = 0; look < 60; ++look) {
    const inr::Frame frame = Look(dims, look < 20 ? 10.0 : 300.0, 0.1 * look);
    const inr::PixelBox box = inr::PixelsOf(frame, dims);
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    const glm::dmat4 toClip = glm::inverse(frame.clipToWorld);
    for (int point = 0; point < 20000; ++point) {
      glm::dvec3 index(anywhere(random), anywhere(random), anywhere(random));
      const int face = point % 6; // most of the points lie on the faces
      index[face / 2] = face % 2;
      const glm::dvec4 clip = toClip * glm::dvec4(index * glm::dvec3(dims) - 0.5, 1.0);
      const glm::dvec2 at =
          0.5 * (glm::dvec2(clip) / clip.w + 1.0) * glm::dvec2(frame.width, frame.height);
      const glm::ivec2 pixel(glm::floor(at));
      const bool seen = clip.w > 0 && Has({{0, 0}, {frame.width, frame.height}}, pixel);
      ASSERT_TRUE(!seen || Has(box, pixel)) << look;
      low = seen ? glm::min(low, at) : low;
      high = seen ? glm::max(high, at) : high;
    }
    if (look >= 20) {
      EXPECT_LE(glm::length(glm::dvec2(box.first) - low), 4.0) << look;
      EXPECT_LE(glm::length(glm::dvec2(box.end) - high), 4.0) << look;
    }
  }
}

} // namespace test::picture_parts

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Testing/Core/Image/RandomImage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

TEST(ImagePsnr, CountsOnlyCoveredPixels)
{
  inr::Image a(2, 1, 4);
  inr::Image b(2, 1, 4);
  b.pixel(0, 0)[3] = 0.1f; // one covered pixel, one of four values differs by 0.1
  EXPECT_NEAR(inr::ImagePsnr(a, b), -10 * std::log10(0.01 / 4), 1e-5);
  EXPECT_EQ(inr::ImagePsnr(a, a), HUGE_VAL);
}

TEST(ImageSsim, IsOneForEqualImagesAndLowForNoise)
{
  const inr::Image a = RandomImage(20, 15, 3, 1);
  EXPECT_NEAR(inr::ImageSsim(a, a), 1.0, 1e-12);
  EXPECT_LT(inr::ImageSsim(a, RandomImage(20, 15, 3, 2)), 0.2);
}

TEST(ImageSsim, ShiftByAConstantHasAClosedForm)
{
  inr::Image a(9, 9, 1);
  inr::Image b(9, 9, 1);
  std::fill(a.pixels.begin(), a.pixels.end(), 0.5f);
  std::fill(b.pixels.begin(), b.pixels.end(), 0.7f);
  // Flat images: only the luminance term is left.
  const double expected = (2 * 0.5 * 0.7 + 1e-4) / (0.25 + 0.49 + 1e-4);
  EXPECT_NEAR(inr::ImageSsim(a, b), expected, 1e-6);
}

TEST(ImageSsim, SeesStructureNotOnlyLuminance)
{
  inr::Image stripes(16, 16, 1);
  inr::Image inverse(16, 16, 1);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      *stripes.pixel(x, y) = x % 2 == 0 ? 0.2f : 0.8f;
      *inverse.pixel(x, y) = x % 2 == 0 ? 0.8f : 0.2f;
    }
  }
  EXPECT_LT(inr::ImageSsim(stripes, inverse), -0.9);
}

TEST(ImageMetrics, RefuseDifferentShapes)
{
  const inr::Image a = RandomImage(8, 8, 4, 1);
  EXPECT_THROW(inr::ImagePsnr(a, RandomImage(8, 9, 4, 1)), inr::Error);
  EXPECT_THROW(inr::ImagePsnr(RandomImage(8, 8, 3, 1), RandomImage(8, 8, 3, 1)), inr::Error);
  EXPECT_THROW(inr::ImageSsim(a, RandomImage(8, 8, 3, 1)), inr::Error);
  EXPECT_THROW(inr::ImageSsim(RandomImage(6, 8, 4, 1), RandomImage(6, 8, 4, 1)), inr::Error);
}

} // namespace

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Testing/Core/Image/RandomImage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::metrics {

/// Two pictures that differ by a quarter of noise.
struct NoisyPair
{
  NoisyPair() : clean(RandomImage(23, 17, 4, 1)), noisy(RandomImage(23, 17, 4, 2))
  {
    for (std::size_t k = 0; k < noisy.pixels.size(); ++k) {
      noisy.pixels[k] = 0.75f * clean.pixels[k] + 0.25f * noisy.pixels[k];
    }
  }
  inr::Image clean;
  inr::Image noisy;
};

/// The mean of f(x, y) over the 7 by 7 window at (x0, y0).
template <typename Function> double WindowMean(int x0, int y0, const Function& f)
{
  double sum = 0;
  for (int y = y0; y < y0 + 7; ++y) {
    for (int x = x0; x < x0 + 7; ++x) {
      sum += f(x, y);
    }
  }
  return sum / 49;
}

/// Luminance times contrast times structure, each as the paper defines it, moments in two passes.
double SlowWindowSsim(const inr::Image& a, const inr::Image& b, int x0, int y0, int channel)
{
  const auto valueA = [&](int x, int y) { return double{a.pixel(x, y)[channel]}; };
  const auto valueB = [&](int x, int y) { return double{b.pixel(x, y)[channel]}; };
  const double meanA = WindowMean(x0, y0, valueA);
  const double meanB = WindowMean(x0, y0, valueB);
  const auto covariance = [&](const auto& f, double meanF, const auto& g, double meanG) {
    const auto product = [&](int x, int y) { return (f(x, y) - meanF) * (g(x, y) - meanG); };
    return WindowMean(x0, y0, product) * 49 / 48;
  };
  const double sigmaA = std::sqrt(covariance(valueA, meanA, valueA, meanA));
  const double sigmaB = std::sqrt(covariance(valueB, meanB, valueB, meanB));
  const double sigmaAB = covariance(valueA, meanA, valueB, meanB);
  const double luminance = (2 * meanA * meanB + 1e-4) / (meanA * meanA + meanB * meanB + 1e-4);
  const double contrast = (2 * sigmaA * sigmaB + 9e-4) / (sigmaA * sigmaA + sigmaB * sigmaB + 9e-4);
  const double structure = (sigmaAB + 4.5e-4) / (sigmaA * sigmaB + 4.5e-4);
  return luminance * contrast * structure;
}

double SlowSsim(const inr::Image& a, const inr::Image& b)
{
  double sum = 0;
  int windows = 0;
  for (int y = 0; y <= a.height - 7; ++y) {
    for (int x = 0; x <= a.width - 7; ++x) {
      for (int channel = 0; channel < a.channels; ++channel, ++windows) {
        sum += SlowWindowSsim(a, b, x, y, channel);
      }
    }
  }
  return sum / windows;
}

TEST(ImagePsnr, CountsOnlyCoveredPixels)
{
  inr::Image a(2, 1, 4);
  inr::Image b(2, 1, 4);
  b.pixel(0, 0)[3] = 0.1f; // one covered pixel, one of four values differs by 0.1
  EXPECT_NEAR(inr::ImagePsnr(a, b), -10 * std::log10(0.01 / 4), 1e-5);
  EXPECT_EQ(inr::ImagePsnr(a, a), HUGE_VAL);
}

TEST(ImagePsnr, AgreesWithNumPy)
{
  const NoisyPair pair;
  EXPECT_NEAR(inr::ImagePsnr(pair.clean, pair.noisy), 19.859032163655282, 1e-9);
}

TEST(ImagePsnr, IsNotANumberWhereAPictureHoldsNone)
{
  const inr::Image a = RandomImage(8, 8, 4, 1);
  for (const int channel : {0, 3}) {
    inr::Image b = a;
    b.pixel(3, 3)[channel] = std::nanf("");
    EXPECT_TRUE(std::isnan(inr::ImagePsnr(a, b))) << channel;
    EXPECT_TRUE(std::isnan(inr::ImagePsnr(b, b))) << channel;
  }
}

TEST(ImageSsim, AgreesWithSciPy)
{
  const NoisyPair pair; // moments by scipy.ndimage.uniform_filter in float64
  EXPECT_NEAR(inr::ImageSsim(pair.clean, pair.noisy), 0.9227175905059849, 1e-9);
}

TEST(ImageSsim, AgreesWithThePapersThreeFactors)
{
  const NoisyPair pair;
  EXPECT_NEAR(inr::ImageSsim(pair.clean, pair.noisy), SlowSsim(pair.clean, pair.noisy), 1e-9);
  const inr::Image other = RandomImage(23, 17, 4, 3);
  EXPECT_NEAR(inr::ImageSsim(pair.clean, other), SlowSsim(pair.clean, other), 1e-9);
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

TEST(ImageMaximumError, IsTheLargestOfAllChannelsAndPixels)
{
  const inr::Image a = RandomImage(8, 6, 4, 1);
  EXPECT_EQ(inr::ImageMaximumError(a, a), 0.0);
  for (const int channel : {0, 3}) {
    inr::Image b = a;
    b.pixel(2, 3)[1] += 0.125f;
    b.pixel(7, 5)[channel] -= 0.25f;
    EXPECT_NEAR(inr::ImageMaximumError(a, b), 0.25, 1e-6);
    EXPECT_NEAR(inr::ImageMaximumError(b, a), 0.25, 1e-6);
    b.pixel(4, 4)[channel] = std::nanf("");
    EXPECT_TRUE(std::isnan(inr::ImageMaximumError(a, b)));
    EXPECT_TRUE(std::isnan(inr::ImageMaximumError(b, b)));
  }
}

TEST(ImageMetrics, RefuseDifferentShapes)
{
  const inr::Image a = RandomImage(8, 8, 4, 1);
  EXPECT_THROW(inr::ImagePsnr(a, RandomImage(8, 9, 4, 1)), inr::Error);
  EXPECT_THROW(inr::ImagePsnr(RandomImage(8, 8, 3, 1), RandomImage(8, 8, 3, 1)), inr::Error);
  EXPECT_THROW(inr::ImageSsim(a, RandomImage(8, 8, 3, 1)), inr::Error);
  EXPECT_THROW(inr::ImageMaximumError(a, RandomImage(9, 8, 4, 1)), inr::Error);
  EXPECT_THROW(inr::ImageSsim(RandomImage(6, 8, 4, 1), RandomImage(6, 8, 4, 1)), inr::Error);
}

} // namespace test::metrics

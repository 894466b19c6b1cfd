// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/Metrics.h"

#include "Core/Error.h"

#include <cmath>

namespace inr {

namespace {

constexpr int Window = 7;

void RequireSameShape(const Image& a, const Image& b)
{
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) {
    throw Error(ErrorCode::InvalidArgument, "images of different sizes cannot be compared");
  }
}

/// SSIM of the window whose lower left pixel is (x, y), in one channel.
double WindowSsim(const Image& a, const Image& b, int x, int y, int channel)
{
  constexpr double n = Window * Window;
  constexpr double c1 = 0.01 * 0.01;
  constexpr double c2 = 0.03 * 0.03;
  double sumA = 0;
  double sumB = 0;
  double sumAA = 0;
  double sumBB = 0;
  double sumAB = 0;
  for (int k = 0; k < Window * Window; ++k) {
    const double valueA = a.pixel(x + k % Window, y + k / Window)[channel];
    const double valueB = b.pixel(x + k % Window, y + k / Window)[channel];
    sumA += valueA;
    sumB += valueB;
    sumAA += valueA * valueA;
    sumBB += valueB * valueB;
    sumAB += valueA * valueB;
  }
  const double meanA = sumA / n;
  const double meanB = sumB / n;
  const double varianceA = (sumAA - n * meanA * meanA) / (n - 1);
  const double varianceB = (sumBB - n * meanB * meanB) / (n - 1);
  const double covariance = (sumAB - n * meanA * meanB) / (n - 1);
  return (2 * meanA * meanB + c1) * (2 * covariance + c2) /
         ((meanA * meanA + meanB * meanB + c1) * (varianceA + varianceB + c2));
}

} // namespace

double ImagePsnr(const Image& a, const Image& b)
{
  RequireSameShape(a, b);
  if (a.channels != 4) {
    throw Error(ErrorCode::InvalidArgument, "PSNR is defined for RGBA images");
  }
  double squared = 0;
  std::int64_t values = 0;
  for (std::size_t k = 0; k < a.pixels.size(); k += 4) {
    if (a.pixels[k + 3] <= 0 && b.pixels[k + 3] <= 0) {
      continue;
    }
    for (std::size_t c = k; c < k + 4; ++c) {
      const double difference = static_cast<double>(a.pixels[c]) - b.pixels[c];
      squared += difference * difference;
    }
    values += 4;
  }
  // Not "squared > 0 ? ... : infinity": that would call a picture of NaNs a perfect one.
  return squared == 0 ? HUGE_VAL : -10.0 * std::log10(squared / static_cast<double>(values));
}

double ImageSsim(const Image& a, const Image& b)
{
  RequireSameShape(a, b);
  if (a.width < Window || a.height < Window || a.channels < 1) {
    throw Error(ErrorCode::InvalidArgument, "SSIM needs images of at least 7 by 7 pixels");
  }
  double sum = 0;
  for (int y = 0; y + Window <= a.height; ++y) {
    for (int x = 0; x + Window <= a.width; ++x) {
      for (int channel = 0; channel < a.channels; ++channel) {
        sum += WindowSsim(a, b, x, y, channel);
      }
    }
  }
  const double windows = static_cast<double>(a.width - Window + 1) * (a.height - Window + 1);
  return sum / (windows * a.channels);
}

double ImageMaximumError(const Image& a, const Image& b)
{
  RequireSameShape(a, b);
  double largest = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    const double difference = std::abs(static_cast<double>(a.pixels[k]) - b.pixels[k]);
    if (!(difference <= largest)) { // a NaN, too, after which no number is larger
      largest = difference;
    }
    if (std::isnan(largest)) {
      break;
    }
  }
  return largest;
}

} // namespace inr

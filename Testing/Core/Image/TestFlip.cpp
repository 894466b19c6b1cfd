// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Image/Flip.h"
#include "Testing/Core/Image/RandomImage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace test::flip {

/// The picture of `color(x, y)`, which gives three channels.
template <typename Function> inr::Image Drawn(int width, int height, const Function& color)
{
  inr::Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::vector<double> values = color(x, y);
      std::copy(values.begin(), values.end(), image.pixel(x, y));
    }
  }
  return image;
}

inr::Image Waves(double shift)
{
  return Drawn(48, 40, [shift](double x, double y) {
    return std::vector<double>{0.5 + 0.5 * std::sin(0.21 * x + 0.05 * y + shift),
                               0.5 + 0.5 * std::cos(0.13 * y - 0.02 * x), (x + y) / 88};
  });
}

inr::Image Disc(const std::vector<double>& color, double radius = 9.5)
{
  return Drawn(40, 36, [&](double x, double y) {
    const bool inside = (x - 18) * (x - 18) + (y - 20) * (y - 20) < radius * radius;
    return inside ? color : std::vector<double>(3, 0.0);
  });
}

inr::Image Noise(std::uint64_t seed) { return RandomImage(37, 29, 3, seed); }

inr::Image Mixed(const inr::Image& a, const inr::Image& b, float partOfB)
{
  inr::Image mixed = a;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    mixed.pixels[k] = (1 - partOfB) * a.pixels[k] + partOfB * b.pixels[k];
  }
  return mixed;
}

inr::Image Flat(double red, double green, double blue)
{
  return Drawn(9, 7, [&](int, int) { return std::vector<double>{red, green, blue}; });
}

struct Expected
{
  std::string name;
  inr::Image reference;
  inr::Image test;
  double pixelsPerDegree;
  double mean;
  double pixels[3]; ///< at (0, 0), (11, 20) and (36, 28)
};

TEST(ImageFlip, AgreesWithTheAuthorsPackage)
{
  // By flip-evaluator 1.7, which computes in float32; flip_reference.py prints these.
  const double usual = inr::UsualPixelsPerDegree;
  const std::vector<Expected> cases = {
      {"noise",
       Noise(1),
       Mixed(Noise(1), Noise(2), 0.25f),
       usual,
       0.2446347,
       {0.425391, 0.112881, 0.245625}},
      {"other noise", Noise(1), Noise(2), usual, 0.4472845, {0.970072, 0.257265, 0.768306}},
      {"waves", Waves(0), Waves(0.3), usual, 0.2353681, {0.360170, 0.351164, 0.386323}},
      {"waves, near", Waves(0), Waves(0.3), 20, 0.2284150, {0.348894, 0.336432, 0.386665}},
      {"waves, far", Waves(0), Waves(0.3), 150, 0.2212544, {0.348233, 0.318101, 0.330912}},
      {"colours",
       Disc({1, 0, 0}),
       Disc({0, 0, 1}),
       usual,
       0.3308571,
       {0.000000, 0.969037, 0.002477}},
      {"sizes",
       Disc({0.2, 0.9, 0.4}),
       Disc({0.2, 0.9, 0.4}, 10.5),
       usual,
       0.1988305,
       {0.000000, 0.270647, 0.003999}}};
  for (const Expected& expected : cases) {
    inr::Image map;
    const double mean =
        inr::ImageFlip(expected.reference, expected.test, expected.pixelsPerDegree, &map);
    EXPECT_NEAR(mean, expected.mean, 3e-5) << expected.name;
    EXPECT_NEAR(*map.pixel(0, 0), expected.pixels[0], 1e-4) << expected.name;
    EXPECT_NEAR(*map.pixel(11, 20), expected.pixels[1], 1e-4) << expected.name;
    EXPECT_NEAR(*map.pixel(36, 28), expected.pixels[2], 1e-4) << expected.name;
  }
}

TEST(ImageFlip, IsZeroForEqualPicturesAndTheSameBothWays)
{
  const inr::Image a = Noise(3);
  const inr::Image b = Noise(4);
  EXPECT_EQ(inr::ImageFlip(a, a), 0.0);
  EXPECT_EQ(inr::ImageFlip(a, b), inr::ImageFlip(b, a));
}

TEST(ImageFlip, OfFlatPicturesIsTheirColorsAlone)
{
  // Greys differ by their lightness, and black and white by 100 of it.
  const double largest = 203.30498; // of green and blue, in NumPy
  const double blackAndWhite = std::pow(100 / largest, 0.7);
  EXPECT_NEAR(inr::ImageFlip(Flat(0, 0, 0), Flat(1, 1, 1)),
              0.95 + (blackAndWhite - 0.4) / 0.6 * 0.05, 1e-4);
  // 0.5 and 0.6 of a display are 0.21404 and 0.31855 of its light.
  const double lightness = 116 * (std::cbrt(0.318547) - std::cbrt(0.214041));
  EXPECT_NEAR(inr::ImageFlip(Flat(0.5, 0.5, 0.5), Flat(0.6, 0.6, 0.6)),
              std::pow(lightness / largest, 0.7) * 0.95 / 0.4, 1e-4);
  EXPECT_NEAR(inr::ImageFlip(Flat(0, 1, 0), Flat(0, 0, 1)), 1.0, 1e-12);
}

TEST(ImageFlip, SeesThePicturesThatADisplayShows)
{
  // Beyond the display's range there is nothing to see,
  EXPECT_NEAR(inr::ImageFlip(Flat(1, 1, 0), Flat(1.5, 7, -1)), 0.0, 1e-12);
  // and alpha alone shows nothing over black.
  const inr::Image a = RandomImage(12, 9, 4, 1);
  inr::Image b = a;
  for (std::size_t k = 3; k < b.pixels.size(); k += 4) {
    b.pixels[k] = 0.5f;
  }
  EXPECT_EQ(inr::ImageFlip(a, b), 0.0);
}

TEST(ImageFlip, SeesLessFromFurtherAway)
{
  // 0.51241 of a display is as much light as 0.4 and 0.6 in turn.
  const inr::Image grey =
      Drawn(40, 40, [](int, int) { return std::vector<double>(3, 0.5124095776840442); });
  const inr::Image board = Drawn(
      40, 40, [](int x, int y) { return std::vector<double>(3, (x + y) % 2 == 0 ? 0.4 : 0.6); });
  double nearer = 1;
  for (const double pixelsPerDegree : {10, 40, 160}) {
    const double error = inr::ImageFlip(grey, board, pixelsPerDegree);
    EXPECT_LT(error, nearer) << pixelsPerDegree;
    nearer = error;
  }
  EXPECT_LT(nearer, 0.1);
}

TEST(ImageFlip, FiltersAsIfThePictureWentOn)
{
  // Far from the difference there is no error, at the border neither.
  const inr::Image a = Waves(0);
  inr::Image b = a;
  b.pixel(24, 20)[1] = 1 - b.pixel(24, 20)[1];
  inr::Image map;
  inr::ImageFlip(a, b, inr::UsualPixelsPerDegree, &map);
  EXPECT_GT(*map.pixel(24, 20), 0.1f);
  EXPECT_EQ(*map.pixel(0, 0), 0.0f);
  EXPECT_EQ(*map.pixel(47, 39), 0.0f);
}

TEST(ImageFlip, IsNotANumberWhereAPictureHoldsNone)
{
  const inr::Image a = Noise(1);
  inr::Image b = a;
  b.pixel(5, 5)[2] = std::nanf("");
  inr::Image map;
  EXPECT_TRUE(std::isnan(inr::ImageFlip(a, b, inr::UsualPixelsPerDegree, &map)));
  EXPECT_TRUE(std::isnan(*map.pixel(5, 5)));
  EXPECT_EQ(*map.pixel(36, 28), 0.0f);
  EXPECT_TRUE(std::isnan(inr::ImageFlip(b, b)));
}

TEST(ImageFlip, RefusesWhatItIsNotDefinedFor)
{
  const inr::Image a = Noise(1);
  EXPECT_THROW(inr::ImageFlip(a, RandomImage(37, 28, 3, 1)), inr::Error);
  EXPECT_THROW(inr::ImageFlip(a, RandomImage(37, 29, 4, 1)), inr::Error);
  EXPECT_THROW(inr::ImageFlip({}, {}), inr::Error);
  EXPECT_THROW(inr::ImageFlip(RandomImage(8, 8, 1, 1), RandomImage(8, 8, 1, 2)), inr::Error);
  for (const double pixelsPerDegree : {0.0, 0.5, 1e5, -67.0, std::nan("")}) {
    EXPECT_THROW(inr::ImageFlip(a, a, pixelsPerDegree), inr::Error) << pixelsPerDegree;
  }
  EXPECT_NO_THROW(inr::ImageFlip(a, a, 1));
}

} // namespace test::flip

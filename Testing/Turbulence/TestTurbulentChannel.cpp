// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Turbulence/ChannelKernel.h"
#include "Testing/Turbulence/TurbulentChannel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::turbulent_channel {

using Field = inr::TurbulentChannel;

Field::Parameters With(std::uint64_t seed, int octaves = 6, double time = 0)
{
  Field::Parameters parameters;
  parameters.seed = seed;
  parameters.octaves = octaves;
  parameters.time = time;
  return parameters;
}

double Fluctuation(const Field& field, const glm::dvec3& u)
{
  return field.at(u) - Field::mean(u.z);
}

// Mean square of what `difference` gives at random points.
template <class Function> double MeanSquare(Function&& difference, int points = 4000)
{
  double sum = 0;
  for (const glm::vec3& u : RandomPositions(points)) {
    const double value = difference(glm::dvec3(u));
    sum += value * value;
  }
  return sum / points;
}

// Committed results name fields by their parameters: these must never mean another field.
TEST(TurbulentChannel, StaysTheSame)
{
  const Field field(With(1));
  EXPECT_NEAR(field.at({0.1, 0.2, 0.3}), 0.988597006873227, 1e-12);
  EXPECT_NEAR(field.at({0.75, 0.5, 0.97}), 0.694055276735074, 1e-12);
  EXPECT_NEAR(Field(With(2, 4, 1.5)).at({0.1, 0.2, 0.3}), 1.05535674866614, 1e-12);
}

TEST(TurbulentChannel, IsStillAtTheWallsAndFastestInTheMiddle)
{
  const Field field(With(3));
  for (const double z : {0.0, 1.0}) {
    EXPECT_NEAR(field.at({0.3, 0.8, z}), 0, 1e-12);
  }
  EXPECT_EQ(Field::mean(0.5), 1);
  double before = 0;
  for (double z = 0.01; z < 0.5; z += 0.01) {
    EXPECT_GT(Field::mean(z), before);
    EXPECT_NEAR(Field::mean(z), Field::mean(1 - z), 1e-12);
    before = Field::mean(z);
  }
}

TEST(TurbulentChannel, IsPeriodicAlongTheWalls)
{
  const Field field(With(4));
  for (const glm::vec3& u : RandomPositions(20)) {
    const glm::dvec3 point(u);
    EXPECT_NEAR(field.at(point), field.at(point + glm::dvec3(1, 0, 0)), 1e-11);
    EXPECT_NEAR(field.at(point), field.at(point - glm::dvec3(0, 1, 0)), 1e-11);
  }
}

TEST(TurbulentChannel, HasTheIntensityAskedFor)
{
  Field::Parameters parameters = With(5);
  parameters.intensity = 0.1;
  const Field field(parameters);
  const double square = MeanSquare([&](glm::dvec3 u) {
    u.z = 0.45 + 0.1 * u.z; // nothing is damped here but the largest structures
    return Fluctuation(field, u);
  });
  EXPECT_NEAR(std::sqrt(square), 0.1, 0.015);
  parameters.intensity = 0;
  EXPECT_EQ(Field(parameters).at({0.1, 0.2, 0.3}), Field::mean(0.3));
}

// The energy of an octave is that of its modes: halving the size takes 2^(2/3) of it.
TEST(TurbulentChannel, EnergyFallsByOctaves)
{
  double energy[6] = {};
  const Field field(With(6));
  for (const Field::Mode& mode : field.modes()) {
    const double octave = std::log2(mode.across / 2);
    ASSERT_GE(octave, 0);
    ASSERT_LT(octave, 6);
    energy[static_cast<int>(octave)] += 0.5 * mode.amplitude * mode.amplitude;
  }
  for (int octave = 1; octave < 6; ++octave) {
    EXPECT_NEAR(energy[octave] / energy[octave - 1], std::exp2(-2.0 / 3.0), 1e-12);
  }
}

// Structure functions: over the same distance in half-heights a field changes least along x.
TEST(TurbulentChannel, IsElongatedDownstream)
{
  const Field field(With(7));
  const auto change = [&](int axis, double distance) {
    glm::dvec3 step(0);
    step[axis] = distance / Field::Size[axis];
    return MeanSquare([&](const glm::dvec3& u) {
      const glm::dvec3 point(u.x, u.y, 0.4 + 0.2 * u.z);
      return Fluctuation(field, point + step) - Fluctuation(field, point);
    });
  };
  for (const double distance : {0.02, 0.1}) {
    EXPECT_LT(2 * change(0, distance), change(1, distance));
    EXPECT_LT(1.5 * change(0, distance), change(2, distance));
  }
}

// The finest structures are nearer to the walls than the large ones.
TEST(TurbulentChannel, OnlySmallStructuresComeNearTheWalls)
{
  double small = 0;
  double large = 0;
  const Field field(With(8));
  const Field::Height height(0.01);
  for (const Field::Mode& mode : field.modes()) {
    const double kept = height.of(mode).x / mode.amplitude;
    small = mode.across > 64 ? std::fmax(small, kept) : small;
    large = mode.across < 4 ? std::fmax(large, kept) : large;
  }
  EXPECT_GT(small, 20 * large);
}

TEST(TurbulentChannel, SeedsAndTimesDiffer)
{
  const Field field(With(1));
  const double square = MeanSquare([&](const glm::dvec3& u) { return Fluctuation(field, u); });
  const auto far = [&](const Field& other) {
    return MeanSquare([&](const glm::dvec3& u) { return other.at(u) - field.at(u); });
  };
  EXPECT_GT(far(Field(With(2))), 1.5 * square); // 2 for independent fields
  const double soon = far(Field(With(1, 6, 0.01)));
  EXPECT_GT(soon, 0);
  EXPECT_LT(soon, 0.2 * square);
  EXPECT_GT(far(Field(With(1, 6, 50))), square);
}

TEST(TurbulentChannel, RefusesWhatIsOutOfRange)
{
  for (const int octaves : {0, 9, -1}) {
    EXPECT_THROW(Field(With(1, octaves)), inr::Error);
  }
  EXPECT_THROW(Field(With(1, 6, NAN)), inr::Error);
  Field::Parameters parameters;
  parameters.intensity = NAN;
  EXPECT_THROW(Field{parameters}, inr::Error);
}

} // namespace test::turbulent_channel

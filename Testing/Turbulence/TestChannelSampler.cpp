// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Turbulence/ChannelSampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace test::channel_sampler {

inr::TurbulentChannel Field(int octaves, double time)
{
  inr::TurbulentChannel::Parameters parameters;
  parameters.seed = 5;
  parameters.octaves = octaves;
  parameters.time = time;
  return inr::TurbulentChannel(parameters);
}

/// Random ones, some of them at the walls and next to them, where modes fade.
std::vector<glm::dvec3> Points(int count)
{
  std::vector<glm::dvec3> points;
  for (const glm::vec3& u : RandomPositions(count)) {
    points.emplace_back(u);
    const glm::dvec3 nearWall(u.x, u.y, 0.02 * static_cast<double>(u.z * u.z));
    points.push_back(nearWall);
    points.emplace_back(u.x, u.y, 1 - nearWall.z);
  }
  points.emplace_back(0, 0, 0);
  points.emplace_back(1, 1, 1);
  return points;
}

std::vector<double> Values(const inr::ChannelSampler& sampler,
                           const std::vector<glm::dvec3>& points)
{
  std::vector<double> values(points.size());
  sampler.at(points.data(), static_cast<std::int64_t>(points.size()), values.data());
  return values;
}

TEST(ChannelSampler, IsTheFieldAtEveryPoint)
{
  for (const int octaves : {1, 6, 8}) {
    for (const double time : {0.0, -7.5}) {
      const inr::TurbulentChannel field = Field(octaves, time);
      const std::vector<glm::dvec3> points = Points(300);
      const std::vector<double> values = Values(inr::ChannelSampler(field), points);
      for (std::size_t k = 0; k < points.size(); ++k) {
        ASSERT_NEAR(values[k], field.at(points[k]), 1e-12) << octaves << " octaves, point " << k;
      }
    }
  }
}

TEST(ChannelSampler, APointDependsOnNoOtherAndOnNoProcessor)
{
  const inr::TurbulentChannel field = Field(6, 0);
  const std::vector<glm::dvec3> points = Points(33);
  const std::vector<double> values = Values(inr::ChannelSampler(field), points);
  for (const std::string& kernel : UsableKernels()) {
    const inr::ChannelSampler sampler(field, kernel);
    ASSERT_EQ(Values(sampler, points), values) << kernel;
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_EQ(Values(sampler, {points[k]}).front(), values[k]) << kernel;
    }
  }
}

} // namespace test::channel_sampler

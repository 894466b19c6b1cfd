// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Turbulence/ChannelGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace test::channel_grid {

inr::TurbulentChannel Field(double time = 0)
{
  inr::TurbulentChannel::Parameters parameters;
  parameters.seed = 11;
  parameters.time = time;
  return inr::TurbulentChannel(parameters);
}

template <class T = double>
std::vector<T> Box(const inr::ChannelGrid& grid, const glm::i64vec3& begin,
                   const glm::i64vec3& size, int threads = 2)
{
  std::vector<T> values(static_cast<std::size_t>(size.x * size.y * size.z));
  grid.box(inr::Arena(threads), begin, size, values.data());
  return values;
}

std::size_t Index(const glm::i64vec3& voxel, const glm::i64vec3& size)
{
  return static_cast<std::size_t>(voxel.x + size.x * (voxel.y + size.y * voxel.z));
}

// In units of the last place of 1, the field's own scale.
TEST(ChannelGrid, RowsAreTheFieldToAFewUlps)
{
  const inr::TurbulentChannel field = Field(3.25);
  for (const glm::i64vec3& dims : {glm::i64vec3(10240, 7680, 1536), glm::i64vec3(77, 3, 1),
                                   glm::i64vec3(1 << 20, 1 << 20, 1 << 20)}) {
    const inr::ChannelGrid grid(field, dims);
    const glm::i64vec3 begin = dims / std::int64_t{3};
    const glm::i64vec3 size = glm::min(dims - begin, glm::i64vec3(150, 2, 2));
    const std::vector<double> values = Box(grid, begin, size);
    double worst = 0;
    for (std::int64_t z = 0; z < size.z; ++z) {
      for (std::int64_t y = 0; y < size.y; ++y) {
        for (std::int64_t x = 0; x < size.x; ++x) {
          const glm::i64vec3 voxel(x, y, z);
          const glm::dvec3 u = (glm::dvec3(begin + voxel) + 0.5) / glm::dvec3(dims);
          worst = std::fmax(worst, std::abs(values[Index(voxel, size)] - field.at(u)));
        }
      }
    }
    EXPECT_LE(worst, 32 * 0x1p-52) << dims.x;
  }
}

TEST(ChannelGrid, EveryPartHasTheBitsOfTheWhole)
{
  const glm::i64vec3 dims(200, 9, 5);
  const inr::ChannelGrid grid(Field(), dims);
  const std::vector<double> whole = Box(grid, glm::i64vec3(0), dims, 1);
  for (const glm::i64vec3& begin :
       {glm::i64vec3(0), glm::i64vec3(63, 1, 0), glm::i64vec3(65, 8, 4), glm::i64vec3(199, 0, 2)}) {
    for (const glm::i64vec3& wanted :
         {glm::i64vec3(1), glm::i64vec3(64, 3, 2), glm::i64vec3(131, 9, 5)}) {
      const glm::i64vec3 size = glm::min(wanted, dims - begin);
      const std::vector<double> part = Box(grid, begin, size);
      for (std::int64_t z = 0; z < size.z; ++z) {
        for (std::int64_t y = 0; y < size.y; ++y) {
          for (std::int64_t x = 0; x < size.x; ++x) {
            const glm::i64vec3 voxel(x, y, z);
            ASSERT_EQ(part[Index(voxel, size)], whole[Index(begin + voxel, dims)]);
          }
        }
      }
    }
  }
}

TEST(ChannelGrid, EveryInstructionSetGivesTheSameBits)
{
  const glm::i64vec3 dims(300, 20, 3);
  const std::vector<double> plain =
      Box(inr::ChannelGrid(Field(), dims, "baseline"), glm::i64vec3(0), dims);
  for (const std::string& kernel : UsableKernels()) {
    EXPECT_EQ(Box(inr::ChannelGrid(Field(), dims, kernel), glm::i64vec3(0), dims), plain) << kernel;
  }
}

TEST(ChannelGrid, FloatsAreTheDoublesRounded)
{
  const glm::i64vec3 dims(70, 4, 3);
  const inr::ChannelGrid grid(Field(), dims);
  const std::vector<double> doubles = Box(grid, glm::i64vec3(0), dims);
  const std::vector<float> floats = Box<float>(grid, glm::i64vec3(0), dims);
  for (std::size_t k = 0; k < doubles.size(); ++k) {
    ASSERT_EQ(floats[k], static_cast<float>(doubles[k]));
  }
}

TEST(ChannelGrid, RefusesImpossibleSizes)
{
  for (const glm::i64vec3& dims :
       {glm::i64vec3(0, 1, 1), glm::i64vec3(1, -1, 1), glm::i64vec3(1, 1, (1 << 20) + 1)}) {
    EXPECT_THROW(inr::ChannelGrid(Field(), dims), inr::Error);
  }
}

} // namespace test::channel_grid

// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Turbulence/ChannelGrid.h"
#include "Testing/Turbulence/RawOutput.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace test::raw_output {

TEST(RawOutput, IsTheGridInBlocksOfAnySize)
{
  const TemporaryFolder folder;
  const inr::TurbulentChannel field({});
  inr::RawVolumeFile file;
  file.dims = {37, 11, 7};
  std::vector<float> values(37 * 11 * 7);
  inr::ChannelGrid(field, file.dims).box(inr::Arena(1), glm::i64vec3(0), file.dims, values.data());
  const std::string expected(reinterpret_cast<const char*>(values.data()), 4 * values.size());
  const std::int64_t rowBytes = 4 * 37;
  for (const std::int64_t block :
       {std::int64_t{1}, 4 * rowBytes, 11 * rowBytes, 30 * rowBytes, 1000 * rowBytes}) {
    file.blockBytes = block;
    inr::WriteRawVolume(field, file, folder.file("blocks"));
    EXPECT_TRUE(ReadBytes(folder.file("blocks.raw")) == expected) << block;
  }
}

} // namespace test::raw_output

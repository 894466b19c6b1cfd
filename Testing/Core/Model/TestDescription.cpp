// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/Description.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

using inr::Description;
using inr::Layout;

namespace test::description {

// The example configuration that upstream ships.
Description Example()
{
  Description description;
  description.grid.levels = 8;
  description.grid.features = 8;
  return description;
}

std::vector<std::uint32_t> Resolutions(const Layout& layout)
{
  std::vector<std::uint32_t> result;
  for (const inr::GridLevel& level : layout.levels) {
    result.push_back(level.resolution);
  }
  return result;
}

TEST(Layout, MatchesTheWorkedExample)
{
  const Layout layout(Example());
  EXPECT_EQ(layout.parameterCount, 23380992u);
  EXPECT_EQ(layout.gridOffset, 17408u);
  EXPECT_EQ(layout.inputWidth, 64);
  EXPECT_EQ(layout.outputWidth, 16);
  const std::uint32_t entries[] = {4096, 32768, 262144, 524288, 524288, 524288, 524288, 524288};
  const std::uint64_t offsets[] = {0, 4096, 36864, 299008, 823296, 1347584, 1871872, 2396160};
  ASSERT_EQ(layout.levels.size(), 8u);
  for (std::size_t l = 0; l < 8; ++l) {
    EXPECT_EQ(layout.levels[l].resolution, 16u << l);
    EXPECT_EQ(layout.levels[l].entries, entries[l]);
    EXPECT_EQ(layout.levels[l].offset, offsets[l]);
    EXPECT_EQ(layout.levels[l].hashed, l >= 3);
    EXPECT_EQ(layout.levels[l].scale, static_cast<float>((16 << l) - 1));
  }
}

TEST(Layout, MatricesLieBackToBack)
{
  const Layout layout(Example());
  ASSERT_EQ(layout.layers.size(), 5u);
  std::uint64_t offset = 0;
  for (const inr::LayerShape& layer : layout.layers) {
    EXPECT_EQ(layer.offset, offset);
    EXPECT_EQ(layer.columns, 64);
    offset += static_cast<std::uint64_t>(layer.rows * layer.columns);
  }
  EXPECT_EQ(layout.layers.back().rows, 16);
  EXPECT_EQ(offset, layout.gridOffset);
}

// Truth: the formula in Python, every operation rounded to float32.
TEST(Layout, FractionalScalesFollowFloat32)
{
  Description description;
  description.grid.perLevelScale = 1.5f;
  description.grid.levels = 12;
  EXPECT_EQ(Resolutions(Layout(description)),
            (std::vector<std::uint32_t>{16, 24, 36, 54, 81, 122, 183, 274, 411, 616, 923, 1384}));
  description.grid.perLevelScale = 1.3819129f;
  description.grid.levels = 16;
  EXPECT_EQ(Resolutions(Layout(description)),
            (std::vector<std::uint32_t>{16, 23, 31, 43, 59, 81, 112, 154, 213, 295, 407, 562, 777,
                                        1073, 1483, 2049}));
}

TEST(Layout, PadsToTheAlignment)
{
  Description description;
  description.grid.levels = 5;
  description.grid.features = 2;
  for (const auto& [alignment, input] : {std::pair{8, 16}, std::pair{16, 16}}) {
    description.network.alignment = alignment;
    const Layout layout(description);
    EXPECT_EQ(layout.encodedWidth, 10);
    EXPECT_EQ(layout.inputWidth, input);
    EXPECT_EQ(layout.outputWidth, alignment);
  }
  description.grid.levels = 12;
  EXPECT_EQ(Layout(description).inputWidth, 32);
  description.network.alignment = 8;
  EXPECT_EQ(Layout(description).inputWidth, 24);
}

TEST(Layout, NoHiddenLayerIsOneMatrix)
{
  Description description = Example();
  description.network.hiddenLayers = 0;
  const Layout layout(description);
  ASSERT_EQ(layout.layers.size(), 1u);
  EXPECT_EQ(layout.layers[0].rows, 16);
  EXPECT_EQ(layout.layers[0].columns, 64);
}

TEST(Layout, TypesLimitTheirTables)
{
  Description description;
  description.grid.levels = 3;
  description.grid.baseResolution = 5;
  description.grid.type = inr::GridType::Dense;
  // Resolutions 5, 10 and 20; cubes rounded up to a multiple of 8.
  EXPECT_EQ(Layout(description).levels[0].entries, 128u);
  EXPECT_EQ(Layout(description).levels[1].entries, 1000u);
  EXPECT_EQ(Layout(description).levels[2].entries, 8000u);
  description.grid.type = inr::GridType::Tiled;
  EXPECT_EQ(Layout(description).levels[0].entries, 125u);
  EXPECT_EQ(Layout(description).levels[2].entries, 125u);
  description.grid.type = inr::GridType::Hash;
  description.grid.log2HashmapSize = 10;
  EXPECT_EQ(Layout(description).levels[1].entries, 1000u);
  EXPECT_EQ(Layout(description).levels[2].entries, 1024u);
}

TEST(Layout, RefusesWhatIsOutOfRange)
{
  const auto broken = [](auto change) {
    Description description = Example();
    change(description);
    try {
      Layout layout(description);
      return false;
    } catch (const inr::Error& error) {
      return error.code() == inr::ErrorCode::InvalidModel;
    }
  };
  EXPECT_FALSE(broken([](Description&) {}));
  EXPECT_TRUE(broken([](Description& d) { d.grid.levels = 0; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.levels = 129; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.features = 3; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.features = -8; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.log2HashmapSize = 31; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.baseResolution = 0; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.perLevelScale = 0.5f; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.perLevelScale = std::nanf(""); }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.perLevelScale = 1e30f; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.levels = 40; })); // 16 * 2^39 points per axis
  EXPECT_TRUE(broken([](Description& d) { d.network.neurons = 0; }));
  EXPECT_TRUE(broken([](Description& d) { d.network.neurons = 1 << 30; }));
  EXPECT_TRUE(broken([](Description& d) { d.network.hiddenLayers = -1; }));
  EXPECT_TRUE(broken([](Description& d) { d.network.alignment = 12; }));
  EXPECT_TRUE(broken([](Description& d) { d.grid.type = inr::GridType::Dense; })); // 8 * 2048^3
}

} // namespace test::description

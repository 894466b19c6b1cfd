// SPDX-License-Identifier: BSD-3-Clause
//
// Files as instantvnr and cINR write them, and compact ones as FORMAT.md describes them, made by
// make_upstream_files.py.
#include "Core/Error.h"
#include "Core/Model/ModelBytes.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <nlohmann/json.hpp>

namespace test::upstream_files {

std::vector<std::string> CaseNames()
{
  std::ifstream file(INR_UPSTREAM_DIR "/cases.txt");
  return {std::istream_iterator<std::string>(file), {}};
}

struct UpstreamFiles : testing::TestWithParam<std::string>
{
  std::string path() const { return INR_UPSTREAM_DIR "/" + this->GetParam() + ".upstream"; }
  nlohmann::json expected() const
  {
    return nlohmann::json::parse(ReadBytes(INR_UPSTREAM_DIR "/" + this->GetParam() + ".expected"));
  }
};

TEST_P(UpstreamFiles, Open)
{
  const inr::ModelPointer model = inr::ReadModel(this->path());
  const nlohmann::json expected = this->expected();
  EXPECT_TRUE(inr::IsModelFile(this->path()));
  EXPECT_EQ(model->parameters, expected["parameters"].get<inr::AlignedVector<float>>());
  EXPECT_EQ(model->storedAs == inr::ParameterType::Half, expected["half"].get<bool>());
  EXPECT_EQ(model->description.network.alignment, expected["alignment"].get<int>());
  EXPECT_EQ(model->description.grid.levels, 3);
  EXPECT_EQ(model->description.grid.rule, inr::HashRule::Wrapping);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(model->volume.dims[axis], expected["dims"][static_cast<std::size_t>(axis)]);
  }
  EXPECT_FALSE(model->quality.has_value());
}

/// As editors of some systems save texts.
TEST(UpstreamTexts, OpenBehindAByteOrderMark)
{
  const std::string text = INR_UPSTREAM_DIR "/compact_text.upstream";
  const TemporaryFolder folder;
  WriteBytes(folder.file("marked.json"), "\xef\xbb\xbf" + ReadBytes(text));
  EXPECT_TRUE(inr::IsModelFile(folder.file("marked.json")));
  EXPECT_EQ(inr::ReadModel(folder.file("marked.json"))->parameters,
            inr::ReadModel(text)->parameters);
}

TEST_P(UpstreamFiles, TellTheirRanges)
{
  const inr::ModelPointer model = inr::ReadModel(this->path());
  const nlohmann::json expected = this->expected()["ranges"];
  ASSERT_EQ(model->macroCells.ranges.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const inr::ValueRange& range = model->macroCells.ranges[k];
    if (expected[k][0] > expected[k][1]) {
      EXPECT_TRUE(range.empty()) << k;
    } else {
      EXPECT_NEAR(range.low, expected[k][0].get<float>(), 1e-6) << k;
      EXPECT_NEAR(range.high, expected[k][1].get<float>(), 1e-6) << k;
    }
  }
  EXPECT_EQ(model->macroCells.provenance, inr::MacroCellProvenance::File);
}

// Text, too, which once was looked for in a file of the bytes' name.
TEST_P(UpstreamFiles, OpenWhenTheyAreSent)
{
  const inr::ModelPointer sent = inr::ModelFromBytes(ReadBytes(this->path()));
  EXPECT_EQ(sent->parameters, inr::ReadModel(this->path())->parameters);
}

INSTANTIATE_TEST_SUITE_P(Variants, UpstreamFiles, testing::ValuesIn(CaseNames()),
                         [](const auto& info) { return info.param; });
// The list is read when the program starts: an empty one must not pass silently.
TEST(UpstreamFileList, IsThere) { EXPECT_GE(CaseNames().size(), 19u); }

TEST(UpstreamFile, WithoutDimensionsAsksForThem)
{
  const std::string path = INR_UPSTREAM_DIR "/no_volume.broken";
  try {
    inr::ReadModel(path);
    FAIL();
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find("Dimensions"), std::string::npos) << error.what();
  }
  inr::ModelOverrides overrides;
  overrides.dims = glm::i64vec3(40, 30, 20);
  EXPECT_EQ(inr::ReadModel(path, overrides)->volume.dims.x, 40);
  EXPECT_FALSE(inr::ReadModel(path, overrides)->nativeDims); // these are the true ones
}

// What the user says goes before what the file does; the cells stay where they are in the volume.
TEST(UpstreamFile, TakesDimensionsBeyondWhatTrainingOutOfCoreStores)
{
  const std::string path = INR_UPSTREAM_DIR "/clamped.upstream";
  inr::ModelOverrides overrides;
  overrides.dims = glm::i64vec3(10240, 7680, 1536);
  const inr::ModelPointer model = inr::ReadModel(path, overrides);
  EXPECT_TRUE(model->volume.dims == *overrides.dims);
  EXPECT_TRUE(model->macroCells.dims == glm::i64vec3(64, 2, 2));
  EXPECT_EQ(model->macroCells.spacing.x, 1.0 / 64);
  EXPECT_EQ(model->macroCells.ranges.size(), 256u);
}

} // namespace test::upstream_files

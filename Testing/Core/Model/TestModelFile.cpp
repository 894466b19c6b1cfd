// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Model/ScaledModel.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace test::model_file {

struct ModelFile : testing::Test
{
  inr::ModelPointer roundTrip(const inr::Model& model)
  {
    inr::WriteModel(model, Folder.file("model.inr"));
    return inr::ReadModel(Folder.file("model.inr"));
  }
  TemporaryFolder Folder;
};

TEST_F(ModelFile, KeepsEveryField)
{
  const auto written = FullModel();
  const inr::ModelPointer read = this->roundTrip(*written);
  EXPECT_EQ(read->parameters, written->parameters);
  EXPECT_EQ(read->storedAs, written->storedAs);
  EXPECT_EQ(read->volume.dims, written->volume.dims);
  EXPECT_EQ(read->volume.spacing, written->volume.spacing);
  EXPECT_EQ(read->volume.time, written->volume.time);
  EXPECT_EQ(read->volume.origin, written->volume.origin);
  EXPECT_EQ(read->volume.direction, written->volume.direction);
  EXPECT_EQ(read->volume.arrayName, written->volume.arrayName);
  EXPECT_EQ(read->volume.type, written->volume.type);
  EXPECT_EQ(read->volume.low, written->volume.low);
  EXPECT_EQ(read->volume.high, written->volume.high);
  EXPECT_EQ(read->quality->psnr, written->quality->psnr);
  EXPECT_EQ(read->quality->maxError, written->quality->maxError);
  EXPECT_EQ(read->quality->sampledVoxels, written->quality->sampledVoxels);
  EXPECT_EQ(read->training->steps, written->training->steps);
  EXPECT_EQ(read->training->plannedSteps, written->training->plannedSteps);
  EXPECT_EQ(read->training->seed, written->training->seed);
  EXPECT_EQ(read->training->kernel, written->training->kernel);
  EXPECT_EQ(read->training->nonFinite, written->training->nonFinite);
  EXPECT_EQ(read->training->earlierSteps, written->training->earlierSteps);
  EXPECT_EQ(read->macroCells.dims, written->macroCells.dims);
  EXPECT_EQ(read->macroCells.provenance, written->macroCells.provenance);
  EXPECT_EQ(read->macroCells.apron, written->macroCells.apron);
}

// For upstream they differ from ranges of samples that training happened to draw.
TEST_F(ModelFile, MarksRangesOfAllVoxels)
{
  inr::Model model = *FullModel();
  for (const auto& [provenance, marked] : {std::pair(inr::MacroCellProvenance::Decoded, true),
                                           std::pair(inr::MacroCellProvenance::Training, true),
                                           std::pair(inr::MacroCellProvenance::File, false)}) {
    model.macroCells.provenance = provenance;
    const auto document = nlohmann::json::from_bson(inr::ModelToBytes(model));
    EXPECT_EQ(document["macrocell"]["groundtruth"], marked);
  }
}

TEST_F(ModelFile, IsWrittenAsUpstreamsLibraryWouldWriteIt)
{
  for (const auto& model : {FullModel(), CompactModel(), RandomModel(SmallDescription())}) {
    const std::string bytes = inr::ModelToBytes(*model);
    const std::vector<std::uint8_t> again =
        nlohmann::json::to_bson(nlohmann::json::from_bson(bytes));
    EXPECT_EQ(std::string(again.begin(), again.end()), bytes);
  }
}

TEST_F(ModelFile, TellsNoTimeAndNoEarlierStepsUnlessThereAreSome)
{
  auto model = FullModel();
  model->volume.time.reset();
  model->training->earlierSteps.reset();
  const inr::ModelPointer read = this->roundTrip(*model);
  EXPECT_FALSE(read->volume.time.has_value());
  EXPECT_FALSE(read->training->earlierSteps.has_value());
  const std::string bytes = ReadBytes(Folder.file("model.inr"));
  EXPECT_EQ(bytes.find("earlier_steps"), std::string::npos);
  model->volume.time = HUGE_VAL;
  EXPECT_THROW(inr::WriteModel(*model, Folder.file("model.inr")), inr::Error);
}

TEST_F(ModelFile, TellsOfWhichVolumeAScaledOneIs)
{
  inr::Description description = SmallDescription();
  description.grid.baseResolution = 128;
  auto model = RandomModel(description);
  model->volume.dims = {40, 30, 20};
  const glm::i64vec3 native = model->volume.dims;
  const inr::ModelPointer scaled = inr::ScaledModel(model, 4);
  const inr::ModelPointer read = inr::ModelFromBytes(inr::ModelToBytes(*scaled));
  EXPECT_EQ(read->volume.dims, scaled->volume.dims);
  EXPECT_EQ(inr::ResolutionOf(*read), native);
  EXPECT_EQ(inr::ResolutionOf(*inr::ScaledModel(read, 0.5)), native);
  this->roundTrip(*scaled);
  inr::ModelOverrides others;
  others.dims = glm::i64vec3(50);
  EXPECT_EQ(inr::ResolutionOf(*inr::ReadModel(Folder.file("model.inr"), others)), native);
  const std::string unscaled = inr::ModelToBytes(*inr::ScaledModel(scaled, 0.25));
  EXPECT_EQ(unscaled.find("native_dims"), std::string::npos);
}

TEST_F(ModelFile, IsTheSameInMemory)
{
  const auto written = FullModel();
  inr::WriteModel(*written, Folder.file("model.inr"));
  const std::string bytes = inr::ModelToBytes(*written);
  EXPECT_EQ(bytes, ReadBytes(Folder.file("model.inr")));
  const inr::ModelPointer read = inr::ModelFromBytes(bytes);
  EXPECT_EQ(read->parameters, written->parameters);
  EXPECT_EQ(read->volume.dims, written->volume.dims);
  EXPECT_EQ(read->macroCells.dims, written->macroCells.dims);
}

TEST_F(ModelFile, IsRefusedInMemoryWhenItEndsEarly)
{
  const std::string bytes = inr::ModelToBytes(*FullModel());
  for (const double part : {0.0, 0.001, 0.1, 0.5, 0.999}) {
    const auto length = static_cast<std::size_t>(part * static_cast<double>(bytes.size()));
    EXPECT_THROW(inr::ModelFromBytes(bytes.substr(0, length)), inr::Error) << length;
  }
}

TEST_F(ModelFile, AnApronThatIsNotSaidIsAVoxel)
{
  const auto written = FullModel();
  inr::WriteModel(*written, Folder.file("model.inr"));
  std::string bytes = ReadBytes(Folder.file("model.inr"));
  bytes.replace(bytes.find("macrocell_apron"), 15, "another_key_now");
  WriteBytes(Folder.file("model.inr"), bytes);
  EXPECT_EQ(inr::ReadModel(Folder.file("model.inr"))->macroCells.apron,
            1.0 / glm::dvec3(written->volume.dims));
}

/// The file has one number, of voxels of the grid that the volume is said to be.
TEST_F(ModelFile, AnApronNeverBecomesWider)
{
  const inr::ModelPointer model = FullModel();
  auto ofCells = std::make_shared<inr::Model>(*model);
  ofCells->volume.dims = {40, 30, 20};
  ofCells->macroCells.apron = 3.0 / glm::dvec3(ofCells->volume.dims);
  const inr::ModelPointer trained = ofCells;
  auto wide = std::make_shared<inr::Model>(*trained);
  wide->volume.dims.x = 80; // as with an override
  auto flat = std::make_shared<inr::Model>(*trained);
  flat->volume.dims.x = 1;
  flat->macroCells = inr::MakeMacroCells(flat->volume.dims, 16);
  flat->macroCells.apron = 3.0 / glm::dvec3(flat->volume.dims);
  for (const auto& [written, voxels] : {std::pair(trained, 3),
                                        {inr::ScaledModel(trained, 1.5), 4},
                                        {inr::ScaledModel(trained, 0.5), 1},
                                        {inr::ScaledModel(flat, 0.5), 1},
                                        {inr::ScaledModel(flat, 1.5), 4},
                                        {inr::ModelPointer(wide), 3}}) {
    const inr::ModelPointer read = inr::ModelFromBytes(inr::ModelToBytes(*written));
    const glm::dvec3 dims(read->volume.dims);
    EXPECT_EQ(glm::round(read->macroCells.apron * dims), glm::dvec3(voxels));
    for (int axis = 0; axis < 3; ++axis) {
      if (read->macroCells.dims[axis] > 1) {
        EXPECT_LE(read->macroCells.apron[axis], written->macroCells.apron[axis] + 1e-9) << axis;
      }
    }
  }
}

TEST_F(ModelFile, IsNotWrittenWhereItCouldNotBeRead)
{
  const auto refusal = [](const auto& change) -> std::string {
    const auto model = FullModel();
    change(*model);
    try {
      inr::ModelToBytes(*model);
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::InvalidModel);
      return error.what();
    }
    return "written";
  };
  const auto withCells = [&](const auto& change) {
    return refusal([&](inr::Model& model) { change(model.macroCells); });
  };
  EXPECT_NE(withCells([](auto& cells) { cells.spacing.x = 2e9; }).find("at most 1e9"),
            std::string::npos);
  EXPECT_NE(withCells([](auto& cells) { cells.spacing.y = 0.01; }).find("cover"),
            std::string::npos);
  EXPECT_NE(withCells([](auto& cells) { cells.apron.z = NAN; }).find("apron"), std::string::npos);
  EXPECT_NE(withCells([](auto& cells) { cells.apron.z = -1; }).find("apron"), std::string::npos);
  EXPECT_NE(refusal([](auto& model) { model.training->seconds = NAN; }).find("seconds"),
            std::string::npos);
}

TEST_F(ModelFile, RangesNeverBecomeNarrower)
{
  const auto written = FullModel();
  const inr::ModelPointer read = this->roundTrip(*written);
  ASSERT_TRUE(read->macroCells.ranges[0].empty());
  for (std::size_t k = 1; k < written->macroCells.ranges.size(); ++k) {
    EXPECT_LE(read->macroCells.ranges[k].low, written->macroCells.ranges[k].low);
    EXPECT_GE(read->macroCells.ranges[k].high, written->macroCells.ranges[k].high);
    EXPECT_NEAR(read->macroCells.ranges[k].low, written->macroCells.ranges[k].low, 1e-6);
  }
}

TEST_F(ModelFile, HalfIsTheNearestHalf)
{
  auto model = FullModel();
  model->storedAs = inr::ParameterType::Half;
  model->parameters[0] = 1.0f + 0.75f / 1024; // between 1 + 0/1024 and 1 + 1/1024
  EXPECT_EQ(this->roundTrip(*model)->parameters[0], 1.0f + 1.0f / 1024);
}

TEST_F(ModelFile, KeepsInfiniteAndUndefinedQuality)
{
  auto model = FullModel();
  model->quality = inr::Quality{HUGE_VAL, NAN, 0.0};
  const inr::ModelPointer read = this->roundTrip(*model);
  EXPECT_EQ(read->quality->psnr, HUGE_VAL);
  EXPECT_TRUE(std::isnan(read->quality->ssim));
}

TEST_F(ModelFile, SizeIsKnownBeforehand)
{
  const auto model = FullModel();
  this->roundTrip(*model);
  EXPECT_EQ(static_cast<std::uintmax_t>(inr::ModelFileSize(*model)),
            std::filesystem::file_size(Folder.file("model.inr")));
}

TEST_F(ModelFile, HeaderLeavesOutTheBulk)
{
  const auto model = FullModel();
  this->roundTrip(*model);
  const inr::Model header = inr::ReadModelHeader(Folder.file("model.inr"));
  EXPECT_TRUE(header.parameters.empty());
  EXPECT_EQ(header.volume.dims, model->volume.dims);
  EXPECT_EQ(header.quality->psnr, model->quality->psnr);
}

TEST_F(ModelFile, OverridesWin)
{
  this->roundTrip(*FullModel());
  inr::ModelOverrides overrides;
  overrides.dims = glm::i64vec3(8, 9, 10);
  overrides.dataRange = glm::dvec2(-2, 3);
  const inr::ModelPointer read = inr::ReadModel(Folder.file("model.inr"), overrides);
  EXPECT_EQ(read->volume.dims, glm::i64vec3(8, 9, 10));
  EXPECT_EQ(read->volume.low, -2.0);
  EXPECT_EQ(read->nativeDims, FullModel()->volume.dims); // which are true
  EXPECT_EQ(FullModel()->macroCells.provenance, inr::MacroCellProvenance::Decoded);
  EXPECT_EQ(read->macroCells.provenance, inr::MacroCellProvenance::File); // of other voxels
  overrides.dims = FullModel()->volume.dims;
  EXPECT_EQ(inr::ReadModel(Folder.file("model.inr"), overrides)->macroCells.provenance,
            inr::MacroCellProvenance::Decoded);
  EXPECT_FALSE(inr::ReadModel(Folder.file("model.inr"))->nativeDims);
}

TEST_F(ModelFile, QualityIsOfWhatWasMeasured)
{
  const auto model = FullModel();
  this->roundTrip(*model);
  inr::ModelOverrides overrides;
  const double width = model->volume.high - model->volume.low;
  overrides.dataRange = glm::dvec2(-3 * width, width);
  const inr::Model wider = inr::ReadModelHeader(Folder.file("model.inr"), overrides);
  ASSERT_GT(model->quality->maxError, 0);
  EXPECT_DOUBLE_EQ(wider.quality->maxError, 4 * model->quality->maxError); // in data units
  EXPECT_EQ(wider.quality->psnr, model->quality->psnr);
  overrides.dims = model->volume.dims;
  EXPECT_TRUE(inr::ReadModelHeader(Folder.file("model.inr"), overrides).quality);
  overrides.dims = glm::i64vec3(8, 9, 10);
  EXPECT_FALSE(inr::ReadModelHeader(Folder.file("model.inr"), overrides).quality);
}

TEST_F(ModelFile, IsRecognisedByContent)
{
  this->roundTrip(*FullModel());
  EXPECT_TRUE(inr::IsModelFile(Folder.file("model.inr")));
  nlohmann::json document = nlohmann::json::from_bson(ReadBytes(Folder.file("model.inr")));
  document["a comment"] = "keys may come in any order, and others be among them";
  const std::vector<std::uint8_t> commented = nlohmann::json::to_bson(document);
  WriteBytes(Folder.file("commented.inr"), {commented.begin(), commented.end()});
  EXPECT_TRUE(inr::IsModelFile(Folder.file("commented.inr")));
  EXPECT_NO_THROW(inr::ReadModel(Folder.file("commented.inr")));
  WriteBytes(Folder.file("inria.inr"), "#INRIMAGE-4#{\nXDIM=3\n");
  EXPECT_FALSE(inr::IsModelFile(Folder.file("inria.inr")));
  EXPECT_FALSE(inr::IsModelFile(Folder.file("missing.inr")));
  EXPECT_FALSE(inr::IsModelFile(Folder.Path.string()));
}

TEST_F(ModelFile, FailedWritesLeaveWhatWasThere)
{
  this->roundTrip(*FullModel());
  const std::string before = ReadBytes(Folder.file("model.inr"));
  auto broken = FullModel();
  broken->storedAs = inr::ParameterType::Half;
  broken->parameters[5] = 1e6f; // half precision ends at 65504
  EXPECT_THROW(inr::WriteModel(*broken, Folder.file("model.inr")), inr::Error);
  broken->parameters[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(inr::WriteModel(*broken, Folder.file("model.inr")), inr::Error);
  EXPECT_EQ(ReadBytes(Folder.file("model.inr")), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(Folder.Path), {}), 1);
}

TEST_F(ModelFile, UnwritableTargetsAreNamed)
{
  try {
    inr::WriteModel(*FullModel(), Folder.file("none/model.inr"));
    FAIL();
  } catch (const inr::Error& error) {
    EXPECT_EQ(error.code(), inr::ErrorCode::CannotWrite);
    EXPECT_NE(std::string(error.what()).find("none/model.inr"), std::string::npos);
  }
}

TEST_F(ModelFile, UpstreamsPartHasItsKnownSize)
{
  // The default model of a 1024^3 volume: 526 bytes of framing, 64^3 cells, 23,380,992 halves.
  inr::Model model;
  model.description.grid.levels = 8;
  model.description.grid.features = 8;
  model.volume.dims = {1024, 1024, 1024};
  model.macroCells = inr::MakeMacroCells(model.volume.dims, 16);
  EXPECT_EQ(model.macroCells.ranges.size() * 8, 2'097'152u);
  EXPECT_EQ(inr::Layout(model.description).parameterCount * 2, 46'761'984u);
  const std::int64_t own = inr::ModelFileSize(model) - 48'859'662;
  EXPECT_GT(own, 0);
  EXPECT_LT(own, 2000); // our section, and settings that upstream leaves at their defaults
}

} // namespace test::model_file

// SPDX-License-Identifier: BSD-3-Clause
// What is saved of which data, and what is refused.
#include "WriterFixture.h"

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkCharArray.h>
#include <vtkFloatArray.h>
#include <vtkMatrix3x3.h>
#include <vtkPolyData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>

namespace {

struct TypeCase
{
  int type;
  double low, high;
};
class WriterOfType : public Writer, public testing::WithParamInterface<TypeCase>
{};

} // namespace

TEST_P(WriterOfType, KeepsTypeAndValues)
{
  const TypeCase& given = this->GetParam();
  const auto image = MakeImage({17, 14, 11}, given.type, given.low, given.high);
  const MessageCapture messages;
  this->Algorithm->SetMaximumSteps(240);
  this->write(image);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();

  const auto decoded = this->decode();
  EXPECT_EQ(decoded->GetPointData()->GetScalars()->GetDataTypeSize(),
            image->GetPointData()->GetScalars()->GetDataTypeSize());
  EXPECT_EQ(decoded->GetPointData()->GetScalars()->GetDataTypeMin(),
            image->GetPointData()->GetScalars()->GetDataTypeMin());
  EXPECT_EQ(this->Algorithm->GetSteps(), 240);
  EXPECT_GT(this->Algorithm->GetPSNR(), 35.0);
  // Besides what the training leaves, integers are rounded.
  const double error = LargestError(image, decoded);
  EXPECT_LE(error, this->Algorithm->GetMaximumError() * 1.001 + 0.5);
  EXPECT_LT(error, 0.3 * (given.high - given.low));
}

INSTANTIATE_TEST_SUITE_P(
    AllTypes, WriterOfType,
    testing::Values(TypeCase{VTK_CHAR, -100, 100}, TypeCase{VTK_SIGNED_CHAR, -128, 127},
                    TypeCase{VTK_UNSIGNED_CHAR, 0, 255}, TypeCase{VTK_SHORT, -3e4, 3e4},
                    TypeCase{VTK_UNSIGNED_SHORT, 5, 65535}, TypeCase{VTK_INT, -2e9, 2e9},
                    TypeCase{VTK_UNSIGNED_INT, 1e9, 4e9}, TypeCase{VTK_LONG, -9e18, 9e18},
                    TypeCase{VTK_UNSIGNED_LONG, 0, 1.8e19}, TypeCase{VTK_LONG_LONG, -1e15, 1e15},
                    TypeCase{VTK_UNSIGNED_LONG_LONG, 0, 1e15}, TypeCase{VTK_ID_TYPE, 0, 1e12},
                    TypeCase{VTK_FLOAT, -1e-6, 1e-6}, TypeCase{VTK_DOUBLE, 1e9, 1e9 + 1}),
    [](const auto& info) {
      std::string name = vtkImageScalarTypeNameMacro(info.param.type);
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST_F(Writer, KeepsTheGeometry)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  const double direction[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  image->SetDirectionMatrix(direction);
  this->write(image);
  const auto decoded = this->decode();
  for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
    double a[3], b[3];
    image->GetPoint(index, a);
    decoded->GetPoint(index, b);
    ASSERT_EQ(glm::dvec3(a[0], a[1], a[2]), glm::dvec3(b[0], b[1], b[2]));
  }
  EXPECT_STREQ(decoded->GetPointData()->GetScalars()->GetName(), "field");
}

TEST_F(Writer, TakesAnExtentThatStartsElsewhere)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  image->SetExtent(10, 18, -3, 4, 0, 6);
  this->write(image);
  const auto decoded = this->decode();
  EXPECT_EQ(decoded->GetNumberOfPoints(), 9 * 8 * 7);
  for (int side = 0; side < 6; ++side) {
    EXPECT_DOUBLE_EQ(decoded->GetBounds()[side], image->GetBounds()[side]);
  }
}

TEST_F(Writer, TakesSlabsSticksAndPoints)
{
  for (const glm::ivec3 dims : {glm::ivec3(20, 1, 15), {1, 1, 12}, {1, 1, 1}}) {
    SCOPED_TRACE(dims.x);
    const MessageCapture messages;
    const auto image = MakeImage(dims, VTK_FLOAT, 0, 1);
    this->write(image);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    const auto decoded = this->decode();
    ASSERT_EQ(decoded->GetNumberOfPoints(), image->GetNumberOfPoints());
    EXPECT_LT(LargestError(image, decoded), 0.5);
    EXPECT_EQ(decoded->GetSpacing()[1], 1.5);
  }
}

TEST_F(Writer, TakesOtherMemoryLayouts)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  this->write(image);
  const auto expected = this->decode();

  vtkNew<vtkSOADataArrayTemplate<float>> apart;
  apart->DeepCopy(image->GetPointData()->GetScalars());
  image->GetPointData()->SetScalars(apart);
  this->write(image);
  EXPECT_EQ(LargestError(expected, this->decode()), 0.0);
}

TEST_F(Writer, CompressesWhatAReaderOpened)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  this->write(image);
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  this->Algorithm->SetInputConnection(reader->GetOutputPort());
  this->Algorithm->SetFileName((this->Folder / "again.inr").c_str());
  this->Algorithm->Write();
  EXPECT_GT(this->Algorithm->GetPSNR(), 12.0);
  EXPECT_EQ(this->Folder.entries(), 2);
}

TEST_F(Writer, SavesTheChosenArray)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  vtkNew<vtkFloatArray> other;
  other->SetName("other");
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  other->FillValue(42.0f);
  image->GetPointData()->AddArray(other);
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                          "other");
  this->write(image);
  const auto decoded = this->decode();
  EXPECT_STREQ(decoded->GetPointData()->GetScalars()->GetName(), "other");
  EXPECT_EQ(decoded->GetPointData()->GetScalars()->GetTuple1(100), 42.0); // constants are exact
}

TEST_F(Writer, SavesNoMaskThatNobodyChose)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(4, 4, 4);
  const auto add = [&](const char* name, auto&& array) {
    array->SetName(name);
    array->SetNumberOfTuples(64);
    array->Fill(0);
    image->GetPointData()->AddArray(array);
  };
  add("vtkValidPointMask", vtkNew<vtkCharArray>());
  add("vtkGhostType", vtkNew<vtkUnsignedCharArray>());
  this->expectRefusal(image, "the image has none but vtkGhostType or vtkValidPointMask");
  image->GetPointData()->SetActiveScalars("vtkValidPointMask");
  add("zeta", vtkNew<vtkFloatArray>());
  const auto saved = [&] { return std::string(this->decode()->GetPointData()->GetArrayName(0)); };
  this->write(image);
  EXPECT_EQ(saved(), "zeta");
  image->GetPointData()->SetActiveScalars(nullptr);
  this->write(image);
  EXPECT_EQ(saved(), "zeta");
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                          "vtkGhostType");
  this->write(image);
  EXPECT_EQ(saved(), "vtkGhostType");

  std::remove(this->path().c_str());
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
  add("eta", vtkNew<vtkFloatArray>());
  this->expectRefusal(image, "no point array is chosen; Scalars takes one of 'zeta', 'eta'");
}

TEST_F(Writer, StoresTheQualityThatItReports)
{
  this->write(MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1));
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  reader->UpdateInformation();
  EXPECT_EQ(reader->GetPSNR(), this->Algorithm->GetPSNR());
  EXPECT_EQ(reader->GetSSIM(), this->Algorithm->GetSSIM());
  EXPECT_EQ(reader->GetMaximumError(), this->Algorithm->GetMaximumError());
  EXPECT_EQ(reader->GetRatio(), this->Algorithm->GetRatio());
  EXPECT_GT(this->Algorithm->GetTrainingSeconds(), 0.0);
}

TEST_F(Writer, RemovesWhatAKilledOneHasLeft)
{
  const std::string abandoned = this->path() + ".4194305.0.tmp"; // above the largest process number
  const std::string checkpoint = this->path() + ".checkpoint.1.0.tmp";
  for (const std::string& name : {abandoned, checkpoint}) {
    std::ofstream(name) << "half of a model";
  }
  this->write(MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1));
  EXPECT_FALSE(std::ifstream(abandoned).good());
  EXPECT_TRUE(std::ifstream(checkpoint).good()) << "whose writer is alive";
}

TEST_F(Writer, WritesCompactFilesUnlessToldOtherwise)
{
  const auto image = MakeImage({40, 30, 20}, VTK_FLOAT, 0, 1);
  const auto bytes = [&] {
    std::ifstream file(this->path(), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  this->write(image);
  const std::string compact = bytes();
  const double ratio = this->Algorithm->GetRatio();
  EXPECT_DOUBLE_EQ(ratio, 40 * 30 * 20 * 4.0 / static_cast<double>(compact.size()));
  EXPECT_NE(compact.find("quantised"), std::string::npos);
  const double error = this->Algorithm->GetMaximumError();
  EXPECT_NEAR(LargestError(image, this->decode()), error, 1e-6);

  this->Algorithm->ReadableByInstantVNROn();
  this->write(image);
  const std::string plain = bytes();
  EXPECT_EQ(plain.find("quantised"), std::string::npos);
  EXPECT_NE(plain.find("__half"), std::string::npos);
  EXPECT_GT(plain.size(), compact.size() * 3 / 2);
  EXPECT_LT(this->Algorithm->GetRatio(), ratio);
  EXPECT_NEAR(LargestError(image, this->decode()), this->Algorithm->GetMaximumError(), 1e-6);
}

TEST_F(Writer, WarnsOfAFileThatIsLargerThanAskedFor)
{
  const auto image = MakeImage({32, 32, 32}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetModelConfig(nullptr);
  this->Algorithm->SetMaximumSteps(2);
  const auto warning = [&](double ratio, int macroCellSize) {
    this->Algorithm->SetTargetRatio(ratio);
    this->Algorithm->SetMacroCellSize(macroCellSize);
    const MessageCapture messages;
    this->write(image);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    return messages.warnings().empty() ? "" : messages.warnings()[0];
  };
  EXPECT_EQ(warning(5, 0), "");
  EXPECT_NE(warning(1e4, 0).find("not 10000 times (TargetRatio)"), std::string::npos);
  EXPECT_NE(warning(40, 1).find("32768 macro-cells"), std::string::npos);
  EXPECT_NE(warning(40, 1).find("a larger MacroCellSize"), std::string::npos);
  this->Algorithm->SetModelConfig(SmallModel);
  EXPECT_EQ(warning(1e4, 0), "");
}

TEST_F(Writer, WarnsOfAFileThatIsLargerThanTheData)
{
  const auto image = MakeImage({6, 5, 4}, VTK_UNSIGNED_CHAR, 0, 255);
  const auto warning = [&](const char* config) {
    this->Algorithm->SetModelConfig(config);
    const MessageCapture messages;
    this->write(image);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    return messages.warnings().size() == 1 ? messages.warnings()[0] : "";
  };
  EXPECT_NE(warning(nullptr).find("times as large as the data"), std::string::npos);
  EXPECT_NE(warning(nullptr).find("with a TargetRatio"), std::string::npos);
  EXPECT_NE(warning(SmallModel).find("a smaller ModelConfig"), std::string::npos);
  this->Algorithm->SetTargetRatio(1e-3); // as asked for
  EXPECT_EQ(warning(nullptr), "");
}

TEST_F(Writer, WarnsOfValuesThatAreNoNumbers)
{
  const auto image = MakeImage({16, 15, 14}, VTK_FLOAT, 0, 1);
  vtkDataArray* array = image->GetPointData()->GetScalars();
  array->SetTuple1(10, std::numeric_limits<double>::quiet_NaN());
  array->SetTuple1(400, std::numeric_limits<double>::infinity());
  const MessageCapture messages;
  this->write(image);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u);
  EXPECT_NE(messages.warnings()[0].find("2 NaN or infinite values"), std::string::npos);
  EXPECT_LE(this->decode()->GetScalarRange()[1], 1.0);
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  reader->Update();
  auto* summary = vtkStringArray::SafeDownCast(
      reader->GetOutput()->GetFieldData()->GetAbstractArray("INRSummary"));
  ASSERT_TRUE(summary);
  const std::string text = summary->GetValue(0);
  EXPECT_NE(text.find("at 2 voxels that had no value is made up"), std::string::npos) << text;
}

namespace {

/// As ResampleToImage does with points outside of a mesh; their values are 0 there.
void HidePoint(vtkImageData* image, vtkIdType point)
{
  image->AllocatePointGhostArray();
  image->GetPointGhostArray()->SetValue(point, vtkDataSetAttributes::HIDDENPOINT);
}

} // namespace

TEST_F(Writer, LeavesOutWhatIsHidden)
{
  const auto image = MakeImage({16, 15, 14}, VTK_FLOAT, 1, 2);
  vtkDataArray* array = image->GetPointData()->GetScalars();
  array->SetTuple1(10, -500);
  HidePoint(image, 10);
  const MessageCapture messages;
  this->write(image);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u);
  EXPECT_NE(messages.warnings()[0].find("has 1 NaN or infinite values, or hidden points"),
            std::string::npos)
      << messages.text();
  EXPECT_GE(this->decode()->GetScalarRange()[0], 1.0);
  EXPECT_EQ(array->GetTuple1(10), -500); // the source's own
}

TEST_F(Writer, WarnsOfHiddenIntegers)
{
  const auto image = MakeImage({25, 24, 23}, VTK_UNSIGNED_CHAR, 1, 200);
  HidePoint(image, 10);
  const MessageCapture messages;
  this->write(image);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u);
  EXPECT_NE(messages.warnings()[0].find("are hidden, but a model has no mask"), std::string::npos);
}

TEST_F(Writer, RefusesDataThatItCannotSave)
{
  this->expectRefusal(vtkNew<vtkPolyData>(), "vtkPolyData, not image data");
  this->expectRefusal(vtkNew<vtkImageData>(), "no");

  const auto image = MakeImage({4, 4, 4}, VTK_FLOAT, 0, 1);
  vtkPointData* points = image->GetPointData();
  const auto choose = [&](vtkAbstractArray* array) {
    array->SetName("bad");
    points->AddArray(array);
    this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                            "bad");
  };
  vtkNew<vtkFloatArray> vectors;
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(64);
  choose(vectors);
  this->expectRefusal(image, "3 components");
  vtkNew<vtkStringArray> strings;
  strings->SetNumberOfValues(64);
  choose(strings);
  this->expectRefusal(image, "does not hold numbers");
  vtkNew<vtkBitArray> bits;
  bits->SetNumberOfTuples(64);
  choose(bits);
  this->expectRefusal(image, "not numbers");
  vtkNew<vtkFloatArray> empty;
  choose(empty);
  this->expectRefusal(image, "0 values for 64 points");
  points->RemoveArray("bad");
  this->expectRefusal(image, "no point array 'bad'");

  vtkNew<vtkFloatArray> cells;
  cells->SetName("cells");
  cells->SetNumberOfTuples(27);
  image->GetCellData()->AddArray(cells);
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "cells");
  this->expectRefusal(image, "CellDataToPointData");
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
  points->Initialize();
  this->expectRefusal(image, "the image has none; of its cell data CellDataToPointData");
}

TEST_F(Writer, RefusesSettingsThatMakeNoSense)
{
  const auto image = MakeImage({4, 4, 4}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetModelConfig("{ not JSON");
  this->expectRefusal(image, "JSON");
  this->Algorithm->SetModelConfig(R"({"encoding": {"otype": "Frequency"}, "network": {}})");
  this->expectRefusal(image, "Frequency");
  this->Algorithm->SetModelConfig(R"({"encodng": {"n_levels": 4}, "netwok": {}})");
  this->expectRefusal(image, "'encodng' is not known");
  this->Algorithm->SetModelConfig(nullptr);
  this->Algorithm->SetTimeLimit(0);
  this->Algorithm->SetMaximumSteps(0);
  this->expectRefusal(image, "never end");
  this->Algorithm->SetMaximumSteps(5);
  this->Algorithm->SetTargetPSNR(std::numeric_limits<double>::infinity());
  this->expectRefusal(image, "TargetPSNR is inf; set a finite positive number");
  this->Algorithm->SetTargetPSNR(0);
  this->Algorithm->SetTargetRatio(std::nan(""));
  this->expectRefusal(image, "TargetRatio is nan; set a finite positive number");
  this->Algorithm->SetTargetRatio(0);
  const auto vast = MakeImage({4, 4, 4}, VTK_DOUBLE, 0, 1);
  vast->GetPointData()->GetArray("field")->SetTuple1(0, -1.7e308);
  vast->GetPointData()->GetArray("field")->SetTuple1(1, 1.7e308);
  this->expectRefusal(vast, "more than a double can tell");
  this->Algorithm->SetFileName(nullptr);
  this->expectRefusal(image, "no FileName");
}

// With five minutes of training ahead, the test's own limit of seconds would be missed.
TEST_F(Writer, LearnsBeforeTheTrainingThatItCannotWrite)
{
  const auto image = MakeImage({40, 40, 40}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetMaximumSteps(0);
  this->Algorithm->SetFileName((this->Folder / "no/such/folder.inr").c_str());
  this->expectRefusal(image, "no/such/folder.inr");
  this->Algorithm->SetFileName("/dev/null");
  this->expectRefusal(image, "/dev/null");
}

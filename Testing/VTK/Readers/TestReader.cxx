// SPDX-License-Identifier: BSD-3-Clause
// The grid that is presented: where its points are, how many, and what they have for values.
#include "Core/Model/ScaledModel.h"
#include "MessageCapture.h"
#include "ReaderFixture.h"
#include "vtkINRDataArray.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkMatrix3x3.h>
#include <vtkUnsignedCharArray.h>

#include <filesystem>

TEST_F(Reader, GivesTheNativeGridWhereItIsSmallEnough)
{
  const auto model = MakeModel(Dims);
  vtkImageData* image = this->open(this->write(*model));
  EXPECT_EQ(
      glm::ivec3(image->GetDimensions()[0], image->GetDimensions()[1], image->GetDimensions()[2]),
      glm::ivec3(Dims));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(image->GetSpacing()[axis], model->volume.spacing[axis]);
    EXPECT_EQ(image->GetOrigin()[axis], model->volume.origin[axis]);
    for (int row = 0; row < 3; ++row) {
      EXPECT_EQ(image->GetDirectionMatrix()->GetElement(row, axis),
                model->volume.direction[axis][row]);
    }
  }
  EXPECT_STREQ(this->scalars()->GetName(), "density");
  EXPECT_EQ(this->scalars()->GetDataType(), VTK_FLOAT);
}

// Voxel i of N sits at u = (i + 0.5)/N and VTK's point i at origin + i * spacing.
TEST_F(Reader, PutsEveryValueAtItsPoint)
{
  const auto model = MakeModel(Dims);
  this->open(this->write(*model));
  const glm::dvec3 first = this->unitPosition(model->volume, 0, 0, 0);
  EXPECT_NEAR(first.x, 0.5 / 20, 1e-12);
  EXPECT_NEAR(first.z, 0.5 / 7, 1e-12);
  this->expectTruth(model);
}

TEST_F(Reader, PresentsACoarserGridWithExactlyTheNativeBounds)
{
  const auto model = MakeModel(Dims);
  const std::string path = this->write(*model);
  double native[6];
  this->open(path)->GetBounds(native);

  for (const vtkIdType limit : {8, 9, 100, 500, 1819}) {
    SCOPED_TRACE(limit);
    this->Algorithm->SetMaximumGridPoints(limit);
    vtkImageData* image = this->open(path);
    EXPECT_LE(image->GetNumberOfPoints(), limit);
    EXPECT_GE(image->GetNumberOfPoints(), 8);
    for (int side = 0; side < 6; ++side) {
      EXPECT_DOUBLE_EQ(image->GetBounds()[side], native[side]);
    }
    this->expectTruth(model);
  }
}

TEST_F(Reader, PresentsTheFinestGridThatFits)
{
  const auto model = MakeModel({4096, 4096, 4096});
  vtkImageData* image = this->open(this->write(*model));
  EXPECT_EQ(image->GetDimensions()[0], 256); // 2^24 points
  EXPECT_EQ(image->GetDimensions()[1], 256);
  EXPECT_EQ(image->GetDimensions()[2], 256);
  EXPECT_DOUBLE_EQ(image->GetSpacing()[0], 0.5 * 4095 / 255);
}

TEST_F(Reader, KeepsSlabsAndSticks)
{
  const auto model = MakeModel({30, 1, 4});
  const std::string path = this->write(*model);
  this->open(path);
  this->expectTruth(model);
  this->Algorithm->SetMaximumGridPoints(50);
  vtkImageData* image = this->open(path);
  EXPECT_EQ(image->GetDimensions()[1], 1);
  EXPECT_EQ(image->GetSpacing()[1], 1.25);
  this->expectTruth(model);
}

TEST_F(Reader, ScalesTheGridAndLeavesItsValuesWhereTheyAre)
{
  const auto model = MakeModel({20, 13, 1});
  const std::string path = this->write(*model);
  const Truth truth(model);
  for (const double factor : {0.25, 0.7, 4.0, 1.0}) {
    SCOPED_TRACE(factor);
    this->Algorithm->SetScaleFactor(factor);
    vtkImageData* image = this->open(path);
    const glm::ivec3 dims(std::lround(20 * factor), std::lround(13 * factor), 1);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(image->GetDimensions()[axis], dims[axis]);
      EXPECT_EQ(this->Algorithm->GetScaledDimensions()[axis], dims[axis]);
      EXPECT_EQ(this->Algorithm->GetScaledSpacing()[axis], image->GetSpacing()[axis]);
    }
    for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
      glm::dvec3 point;
      image->GetPoint(index, &point.x);
      const inr::VolumeInfo& native = model->volume;
      const glm::dvec3 voxel = glm::inverse(native.direction) * (point - native.origin);
      const double expected = truth((voxel / native.spacing + 0.5) / glm::dvec3(native.dims));
      ASSERT_NEAR(this->scalars()->GetTuple1(index), expected, 70 * PositionTolerance);
    }
    vtkFieldData* fields = image->GetFieldData();
    EXPECT_EQ(fields->GetArray("INRScaledDimensions")->GetComponent(0, 1), dims.y);
    EXPECT_EQ(fields->GetArray("INRNativeDimensions")->GetComponent(0, 1), 13);
    const double bytes = static_cast<double>(std::filesystem::file_size(path));
    EXPECT_DOUBLE_EQ(this->Algorithm->GetRatio(), 20 * 13 * 4 / bytes);
  }
}

TEST_F(Reader, PresentsTheBoundsOfAScaledGridToo)
{
  const auto model = MakeModel(Dims);
  const std::string path = this->write(*model);
  this->Algorithm->SetScaleFactor(3);
  this->Algorithm->SetMaximumGridPoints(0);
  double whole[6];
  this->open(path)->GetBounds(whole);
  this->Algorithm->SetMaximumGridPoints(500);
  vtkImageData* image = this->open(path);
  EXPECT_LE(image->GetNumberOfPoints(), 500);
  for (int side = 0; side < 6; ++side) {
    EXPECT_NEAR(image->GetBounds()[side], whole[side], 1e-12);
  }
  this->expectTruth(inr::ScaledModel(model, 3));
}

TEST_F(Reader, RefusesOtherScaleFactors)
{
  const std::string path = this->write(*MakeModel(Dims));
  for (const double factor : {0.0, 0.24, 4.1, -1.0, std::nan("")}) {
    this->Algorithm->SetScaleFactor(factor);
    const MessageCapture messages;
    EXPECT_EQ(this->open(path)->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("ScaleFactor")) << messages.text();
  }
  this->Algorithm->SetScaleFactor(1);
  EXPECT_GT(this->open(path)->GetNumberOfPoints(), 0);
}

TEST_F(Reader, OpensFarMoreThanMemoryHoldsWithoutEvaluating)
{
  const std::string path = this->write(*MakeModel({131072, 131072, 4096}));
  for (const vtkIdType limit : {vtkIdType{1} << 28, vtkIdType{1} << 24}) {
    this->Algorithm->SetMaximumGridPoints(limit);
    vtkImageData* image = this->open(path);
    vtkINRDataArray* array = vtkINRDataArray::SafeDownCast(this->scalars());
    EXPECT_EQ(this->scalars()->GetRange()[1], 90.0);
    EXPECT_LT(image->GetActualMemorySize(), 1024u); // KiB
    EXPECT_EQ(array->GetNumberOfEvaluations(), 0);
    EXPECT_EQ(array->GetModel()->volume.dims.x, 131072);
    EXPECT_GT(this->scalars()->GetTuple1(image->GetNumberOfPoints() - 1), 0.0);
    EXPECT_GT(array->GetNumberOfEvaluations(), 0);
    EXPECT_LE(array->GetNumberOfEvaluations(), 16 * 16 * 16); // the brick of that value
  }
}

// Stock filters take a pointer to all values and crash when the array refuses it.
TEST_F(Reader, NeverPresentsMoreThanFiltersCanTake)
{
  const std::string path = this->write(*MakeModel({700, 700, 700}));
  double native[6];
  this->open(path)->GetBounds(native);
  for (const vtkIdType limit : {vtkIdType{0}, vtkIdType{700} * 700 * 700, VTK_ID_MAX}) {
    SCOPED_TRACE(limit);
    const MessageCapture messages;
    this->Algorithm->SetMaximumGridPoints(limit);
    vtkImageData* image = this->open(path);
    EXPECT_EQ(image->GetDimensions()[0], 645); // 645^3 < 2^28 < 646^3
    EXPECT_EQ(image->GetBounds()[5], native[5]);
    ASSERT_EQ(messages.warnings().size(), 1u);
    EXPECT_NE(messages.warnings()[0].find("700 x 700 x 700"), std::string::npos);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
  }
}

TEST_F(Reader, RefusesANegativeNumberOfPoints)
{
  const std::string path = this->write(*MakeModel(Dims));
  const MessageCapture messages;
  this->Algorithm->SetMaximumGridPoints(-1);
  EXPECT_EQ(this->open(path)->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.onlyError("MaximumGridPoints is -1")) << messages.text();
}

TEST_F(Reader, ServesEachProcessItsPiece)
{
  const auto model = MakeModel({40, 30, 20});
  this->Algorithm->SetFileName(this->write(*model).c_str());
  vtkIdType cells = 0;
  for (int piece = 0; piece < 4; ++piece) {
    this->Algorithm->UpdatePiece(piece, 4, 0);
    cells += this->Algorithm->GetOutput()->GetNumberOfCells();
    this->expectTruth(model);
  }
  EXPECT_EQ(cells, 39 * 29 * 19);
}

TEST_F(Reader, MarksWhatOtherProcessesHaveToo)
{
  const auto model = MakeModel({40, 30, 20});
  this->Algorithm->SetFileName(this->write(*model).c_str());
  vtkImageData* image = this->Algorithm->GetOutput();
  vtkIdType cells = 0;
  vtkIdType own = 0;
  for (int piece = 0; piece < 4; ++piece) {
    this->Algorithm->UpdatePiece(piece, 4, 2);
    this->expectTruth(model);
    cells += image->GetNumberOfCells();
    ASSERT_NE(image->GetCellGhostArray(), nullptr);
    ASSERT_NE(image->GetPointGhostArray(), nullptr);
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell) {
      own += image->GetCellGhostArray()->GetValue(cell) == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(cells, own);
  EXPECT_EQ(own, 39 * 29 * 19);
}

TEST_F(Reader, HasNoGhostArrayWithoutGhostCells)
{
  this->Algorithm->SetFileName(this->write(*MakeModel(Dims)).c_str());
  for (const int ghosts : {1, 0}) { // of one process, and of several
    this->Algorithm->UpdatePiece(0, 2 - ghosts, ghosts);
    vtkImageData* image = this->Algorithm->GetOutput();
    EXPECT_EQ(image->GetPointData()->GetNumberOfArrays(), 1);
    EXPECT_EQ(image->GetCellData()->GetNumberOfArrays(), 0);
  }
}

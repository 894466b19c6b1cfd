// SPDX-License-Identifier: BSD-3-Clause
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDataArray.h"
#include "vtkINRReader.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace {

constexpr glm::i64vec3 Dims{20, 13, 7};

class Reader : public testing::Test
{
protected:
  std::string write(const inr::Model& model)
  {
    const std::string path = this->Folder / "model.inr";
    inr::WriteModel(model, path);
    return path;
  }

  vtkImageData* open(const std::string& path)
  {
    this->Algorithm->SetFileName(path.c_str());
    this->Algorithm->Update();
    return this->Algorithm->GetOutput();
  }

  vtkDataArray* scalars() { return this->Algorithm->GetOutput()->GetPointData()->GetScalars(); }

  /// Where VTK says that point (i, j, k) of the output is, in the unit cube of `volume`.
  glm::dvec3 unitPosition(const inr::VolumeInfo& volume, int i, int j, int k)
  {
    double world[3];
    this->Algorithm->GetOutput()->TransformIndexToPhysicalPoint(i, j, k, world);
    const glm::dvec3 local =
        glm::inverse(volume.direction) * (glm::dvec3(world[0], world[1], world[2]) - volume.origin);
    return (local / volume.spacing + 0.5) / glm::dvec3(volume.dims);
  }

  /// Every value is the network's at the place of its point.
  void expectTruth(const inr::ModelPointer& model)
  {
    const Truth truth(model);
    const double tolerance = PositionTolerance * (model->volume.high - model->volume.low);
    int extent[6];
    this->Algorithm->GetOutput()->GetExtent(extent);
    vtkIdType index = 0;
    for (int k = extent[4]; k <= extent[5]; ++k) {
      for (int j = extent[2]; j <= extent[3]; ++j) {
        for (int i = extent[0]; i <= extent[1]; ++i) {
          const double expected = truth(this->unitPosition(model->volume, i, j, k));
          ASSERT_NEAR(this->scalars()->GetTuple1(index++), expected, tolerance)
              << i << " " << j << " " << k;
        }
      }
    }
    EXPECT_EQ(index, this->scalars()->GetNumberOfTuples());
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRReader> Algorithm;
};

std::string Summary(vtkImageData* image)
{
  return vtkStringArray::SafeDownCast(image->GetFieldData()->GetAbstractArray("INRSummary"))
      ->GetValue(0);
}

} // namespace

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

TEST_F(Reader, ScalesTheGridBetweenTheSameBounds)
{
  const auto model = MakeModel({20, 13, 1});
  const std::string path = this->write(*model);
  const Truth truth(model);
  double native[6];
  this->open(path)->GetBounds(native);
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
    for (int side = 0; side < 6; ++side) {
      EXPECT_NEAR(image->GetBounds()[side], native[side], 1e-12);
    }
    for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
      const glm::dvec3 voxel(index % dims.x, index / dims.x, 0);
      const double expected = truth((voxel + 0.5) / glm::dvec3(dims));
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
  double native[6];
  this->open(path)->GetBounds(native);
  this->Algorithm->SetScaleFactor(3);
  this->Algorithm->SetMaximumGridPoints(500);
  vtkImageData* image = this->open(path);
  EXPECT_LE(image->GetNumberOfPoints(), 500);
  for (int side = 0; side < 6; ++side) {
    EXPECT_NEAR(image->GetBounds()[side], native[side], 1e-12);
  }
  inr::VolumeInfo scaled = model->volume;
  scaled.dims *= 3;
  scaled.spacing *= glm::dvec3(Dims - std::int64_t{1}) / glm::dvec3(scaled.dims - std::int64_t{1});
  const auto finer = std::make_shared<inr::Model>(*model);
  finer->volume = scaled;
  this->expectTruth(finer);
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

TEST_F(Reader, TellsAboutTheVolumeBehindTheGrid)
{
  const auto model = MakeModel(Dims);
  model->quality = inr::Quality{41.5, 0.96, 7.25};
  const std::string path = this->write(*model);
  this->Algorithm->SetMaximumGridPoints(50);
  vtkFieldData* fields = this->open(path)->GetFieldData();

  EXPECT_EQ(fields->GetArray("INRNativeDimensions")->GetComponent(0, 1), 13);
  EXPECT_EQ(fields->GetArray("INRNativeSpacing")->GetComponent(0, 2), 3.0);
  EXPECT_EQ(fields->GetArray("INRPSNR")->GetTuple1(0), 41.5);
  EXPECT_EQ(fields->GetArray("INRSSIM")->GetTuple1(0), 0.96);
  EXPECT_EQ(fields->GetArray("INRMaximumError")->GetTuple1(0), 7.25);
  const double ratio = 20.0 * 13 * 7 * 4 / static_cast<double>(std::filesystem::file_size(path));
  EXPECT_DOUBLE_EQ(fields->GetArray("INRRatio")->GetTuple1(0), ratio);

  EXPECT_EQ(this->Algorithm->GetNativeDimensions()[0], 20);
  EXPECT_EQ(this->Algorithm->GetNativeSpacing()[1], 1.25);
  EXPECT_EQ(this->Algorithm->GetPSNR(), 41.5);
  EXPECT_EQ(this->Algorithm->GetSSIM(), 0.96);
  EXPECT_EQ(this->Algorithm->GetMaximumError(), 7.25);
  EXPECT_DOUBLE_EQ(this->Algorithm->GetRatio(), ratio);
}

TEST_F(Reader, SaysNothingAboutAQualityThatNobodyMeasured)
{
  vtkFieldData* fields = this->open(this->write(*MakeModel(Dims)))->GetFieldData();
  EXPECT_EQ(fields->GetArray("INRPSNR"), nullptr);
  EXPECT_TRUE(std::isnan(this->Algorithm->GetPSNR()));
}

TEST_F(Reader, TakesNameRangeAndDimensionsFromTheUser)
{
  const std::string path = this->write(*MakeModel(Dims));
  this->Algorithm->SetArrayName("other");
  this->Algorithm->SetDataRange(-1.0, 3.0);
  this->Algorithm->SetDimensions(10, 11, 12);
  vtkImageData* image = this->open(path);
  EXPECT_STREQ(this->scalars()->GetName(), "other");
  EXPECT_EQ(this->scalars()->GetRange()[0], -1.0);
  EXPECT_EQ(this->scalars()->GetRange()[1], 3.0);
  EXPECT_EQ(image->GetNumberOfPoints(), 10 * 11 * 12);
}

TEST_F(Reader, SaysWhenTheQualityIsThatOfSomeVoxels)
{
  const auto model = MakeModel(Dims);
  model->quality = inr::Quality{41.5, 0.96, 7.25, 1000};
  const std::string text = Summary(this->open(this->write(*model)));
  EXPECT_NE(text.find("largest error 7.25, measured on 1000 voxels"), std::string::npos) << text;
}

// A file of upstream, trained out of core, stores no more than 1,024 voxels along an axis.
TEST_F(Reader, SaysWhereTheFileMayHideVoxelsAndTakesTheirNumber)
{
  auto model = MakeModel({1024, 9, 8});
  model->volume.direction = glm::dmat3(1.0);
  const std::string path = this->write(*model);
  EXPECT_NE(Summary(this->open(path)).find("Dimensions"), std::string::npos);

  this->Algorithm->SetDimensions(3001, 17, 8);
  vtkImageData* const image = this->open(path);
  EXPECT_EQ(Summary(image).find("Dimensions"), std::string::npos) << Summary(image);
  EXPECT_EQ(Summary(image).find("3001 x 17 x 8 voxels"), 0u) << Summary(image);
  const glm::dvec3 first = model->volume.origin;
  const glm::dvec3 last = first + model->volume.spacing * glm::dvec3(3000, 16, 7);
  const double* bounds = image->GetBounds();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_DOUBLE_EQ(bounds[2 * axis], first[axis]);
    EXPECT_DOUBLE_EQ(bounds[2 * axis + 1], last[axis]);
  }
  const glm::dvec3 u = (glm::dvec3(2000, 4, 5) + 0.5) / glm::dvec3(3001, 17, 8);
  EXPECT_NEAR(this->scalars()->GetTuple1(2000 + 3001 * (4 + 17 * 5)), Truth(model)(u),
              70 * PositionTolerance);

  model->quality = inr::Quality{40, 0.9, 1}; // one of ours
  this->Algorithm->SetDimensions(0, 0, 0);
  EXPECT_EQ(Summary(this->open(this->write(*model))).find("Dimensions"), std::string::npos);
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

  const auto points = [&](int ghosts) {
    this->Algorithm->UpdatePiece(0, 4, ghosts);
    return this->Algorithm->GetOutput()->GetNumberOfPoints();
  };
  const vtkIdType alone = points(0);
  EXPECT_LT(alone, points(1));
  EXPECT_EQ(this->Algorithm->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
}

TEST_F(Reader, SeesThatTheFileHasChanged)
{
  const std::string path = this->write(*MakeModel(Dims));
  EXPECT_EQ(this->open(path)->GetDimensions()[0], 20);
  this->write(*MakeModel({5, 6, 7}));
  this->Algorithm->Modified();
  EXPECT_EQ(this->open(path)->GetDimensions()[0], 5);
}

// What the pipeline was told of a file is no longer so when the data are asked for.
TEST_F(Reader, SaysWhenTheFileChangesWhileItIsBeingOpened)
{
  const auto model = MakeModel(Dims);
  const auto refuses = [&](const char* words) {
    const MessageCapture messages;
    this->Algorithm->Update();
    EXPECT_TRUE(messages.onlyError(words)) << messages.text();
    EXPECT_EQ(this->Algorithm->GetOutput()->GetNumberOfPoints(), 0);
  };
  const std::string path = this->write(*model);
  const auto changed = [&](const std::function<void()>& change, const char* words) {
    this->write(*model);
    this->Algorithm->SetFileName(path.c_str());
    this->Algorithm->Modified();
    this->Algorithm->UpdateInformation();
    change();
    refuses(words);
  };
  changed([&] { this->write(*MakeModel({25, 6, 7})); }, "another file");
  changed([&] { std::filesystem::resize_file(path, 3000); }, "truncated");
  changed([&] { std::filesystem::remove(path); }, "No such file");

  this->write(*model);
  const MessageCapture messages;
  this->Algorithm->Modified();
  this->open(path);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  this->expectTruth(model);
}

TEST_F(Reader, KeepsWhatItHasOpenedWhateverBecomesOfTheFile)
{
  const auto model = MakeModel(Dims);
  const std::string path = this->write(*model);
  const MessageCapture messages;
  this->open(path);
  std::filesystem::resize_file(path, 100);
  this->expectTruth(model);
  std::filesystem::remove(path);
  this->Algorithm->Update();
  this->expectTruth(model);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
}

namespace {

std::string Bytes(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TEST_F(Reader, SaysOnceWhatIsWrongWithAFileAndGoesOn)
{
  const auto model = MakeModel(Dims);
  const std::string whole = Bytes(this->write(*model));
  std::string notANumber = whole;
  const std::size_t middle = whole.find("params_binary");
  ASSERT_NE(middle, std::string::npos);
  notANumber.replace(middle + 4000, 8, 8, '\xff');
  const std::string path = this->Folder / "bad file.inr";

  for (const std::string& content :
       {std::string(), std::string("#INRIMAGE-4#{\nXDIM=4\n"), std::string(5000, 'x'),
        std::string(5000, '\0'), whole.substr(0, whole.size() / 2), whole.substr(0, 100),
        whole.substr(0, whole.size() - 1), whole + "more", "\xff\xff\xff\x7f" + whole.substr(4),
        notANumber}) {
    SCOPED_TRACE(content.size());
    std::ofstream(path, std::ios::binary) << content;
    const MessageCapture messages;
    this->Algorithm->Modified();
    vtkImageData* image = this->open(path);
    EXPECT_TRUE(messages.onlyError("bad file.inr")) << messages.text();
    EXPECT_EQ(image->GetNumberOfPoints(), 0);
    EXPECT_EQ(image->GetPointData()->GetNumberOfArrays(), 0);
  }

  std::ofstream(path, std::ios::binary) << whole;
  const MessageCapture messages;
  this->Algorithm->Modified();
  this->open(path);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  this->expectTruth(model);
}

TEST_F(Reader, NamesWhatIsNotAFile)
{
  for (const std::string& path : {this->Folder / "missing.inr", this->Folder / ""}) {
    const MessageCapture messages;
    EXPECT_EQ(this->open(path)->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError(path)) << messages.text();
  }
  const MessageCapture messages;
  this->Algorithm->SetFileName(nullptr);
  this->Algorithm->Update();
  EXPECT_TRUE(messages.onlyError("FileName")) << messages.text();
}

TEST_F(Reader, RefusesOverridesThatMakeNoSense)
{
  const std::string path = this->write(*MakeModel(Dims));
  const auto refuses = [&] {
    const MessageCapture messages;
    const bool empty = this->open(path)->GetNumberOfPoints() == 0;
    EXPECT_TRUE(empty && messages.onlyError("model.inr")) << messages.text();
  };
  this->Algorithm->SetDataRange(2.0, 1.0);
  refuses();
  this->Algorithm->SetDataRange(0.0, 0.0);
  this->Algorithm->SetDimensions(-4, 5, 6);
  refuses();
  this->Algorithm->SetDimensions(4, 0, 6);
  refuses();
  this->Algorithm->SetDimensions(VTK_INT_MAX, VTK_INT_MAX, VTK_INT_MAX);
  refuses();
}

TEST_F(Reader, KnowsItsFilesByTheirContent)
{
  const std::string ours = this->write(*MakeModel(Dims));
  const std::string inria = this->Folder / "image.inr";
  std::ofstream(inria) << "#INRIMAGE-4#{\nXDIM=4\nYDIM=4\n";
  EXPECT_EQ(this->Algorithm->CanReadFile(ours.c_str()), 1);
  EXPECT_EQ(this->Algorithm->CanReadFile(inria.c_str()), 0);
  EXPECT_EQ(this->Algorithm->CanReadFile((this->Folder / "missing").c_str()), 0);
  EXPECT_EQ(this->Algorithm->CanReadFile(nullptr), 0);
}

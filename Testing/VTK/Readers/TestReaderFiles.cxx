// SPDX-License-Identifier: BSD-3-Clause
// What is told of a file, and what is made of those that are bad or change.
#include "MessageCapture.h"
#include "ReaderFixture.h"

#include <vtkExtractVOI.h>
#include <vtkFieldData.h>
#include <vtkStringArray.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

namespace {

std::string Summary(vtkImageData* image)
{
  return vtkStringArray::SafeDownCast(image->GetFieldData()->GetAbstractArray("INRSummary"))
      ->GetValue(0);
}

std::string Bytes(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

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

TEST_F(Reader, ComparesTheFileWithWhatWasCompressed)
{
  const std::string path = this->write(*MakeModel(Dims));
  this->open(path);
  const double ratio = this->Algorithm->GetRatio();
  this->Algorithm->SetDimensions(200, 130, 70);
  this->open(path);
  EXPECT_EQ(this->Algorithm->GetRatio(), ratio);
}

/// Somebody else may ask for what there is.
TEST_F(Reader, GoesOnAfterARequestForPointsThatDoNotExist)
{
  this->open(this->write(*MakeModel(Dims)));
  vtkNew<vtkExtractVOI> beyond;
  beyond->SetInputConnection(this->Algorithm->GetOutputPort());
  beyond->SetVOI(0, 100, 0, 5, 0, 5);
  {
    const MessageCapture messages;
    beyond->Update();
    EXPECT_NE(messages.text().find("not within the grid"), std::string::npos) << messages.text();
    EXPECT_EQ(this->Algorithm->GetOutput()->GetNumberOfPoints(), 0);
  }
  this->Algorithm->UpdateWholeExtent();
  EXPECT_EQ(this->Algorithm->GetOutput()->GetNumberOfPoints(), Dims.x * Dims.y * Dims.z);
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

TEST_F(Reader, SaysNothingOfAFileThatItCannotRead)
{
  this->open(this->write(*MakeModel(Dims)));
  EXPECT_EQ(this->Algorithm->GetNativeDimensions()[0], Dims.x);
  EXPECT_GT(this->Algorithm->GetRatio(), 0);
  const MessageCapture messages;
  std::string damaged = Bytes(this->Folder / "model.inr");
  damaged[damaged.size() / 2] = static_cast<char>(~damaged[damaged.size() / 2]);
  std::ofstream(this->Folder / "damaged.inr", std::ios::binary) << damaged;
  this->open(this->Folder / "damaged.inr"); // whose beginning can be read
  EXPECT_EQ(this->Algorithm->GetNativeDimensions()[0], 0);
  this->open(this->Folder / "missing.inr");
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(this->Algorithm->GetNativeDimensions()[axis], 0);
    EXPECT_EQ(this->Algorithm->GetScaledDimensions()[axis], 0);
    EXPECT_EQ(this->Algorithm->GetNativeSpacing()[axis], 0);
    EXPECT_EQ(this->Algorithm->GetScaledSpacing()[axis], 0);
  }
  EXPECT_EQ(this->Algorithm->GetRatio(), 0);
  EXPECT_TRUE(std::isnan(this->Algorithm->GetPSNR()));
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
  this->Algorithm->SetDataRange(5.0, 5.0);
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

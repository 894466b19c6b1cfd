// SPDX-License-Identifier: BSD-3-Clause
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDecode.h"
#include "vtkINRReader.h"

#include <vtkCallbackCommand.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

namespace {

class Decode : public testing::Test
{
protected:
  void connect(const inr::Model& model, vtkIdType maximumGridPoints = vtkIdType{1} << 24)
  {
    const std::string path = this->Folder / "model.inr";
    inr::WriteModel(model, path);
    this->Reader->SetFileName(path.c_str());
    this->Reader->SetMaximumGridPoints(maximumGridPoints);
    this->Filter->SetInputConnection(this->Reader->GetOutputPort());
  }

  vtkImageData* update()
  {
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  /// Calls `check` with the voxel, where VTK puts its point in the unit cube of the volume, and its
  /// value.
  template <class Check> void forEachVoxel(const inr::VolumeInfo& volume, Check&& check)
  {
    vtkImageData* image = this->update();
    ASSERT_NE(image->GetPointData()->GetScalars(), nullptr);
    for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
      double world[3];
      image->GetPoint(index, world);
      const glm::dvec3 local = glm::inverse(volume.direction) *
                               (glm::dvec3(world[0], world[1], world[2]) - volume.origin);
      const glm::dvec3 u = (local / volume.spacing + 0.5) / glm::dvec3(volume.dims);
      check(index, u, image->GetPointData()->GetScalars()->GetTuple1(index));
    }
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRReader> Reader;
  vtkNew<vtkINRDecode> Filter;
};

constexpr double Tolerance = 70 * PositionTolerance;

} // namespace

TEST_F(Decode, GivesTheNativeVoxelsWhateverGridIsPresented)
{
  const auto model = MakeModel({15, 11, 8});
  const Truth truth(model);
  for (const vtkIdType presented : {vtkIdType{1} << 24, vtkIdType{60}}) {
    this->connect(*model, presented);
    this->forEachVoxel(model->volume, [&](vtkIdType index, const glm::dvec3& u, double value) {
      const glm::dvec3 voxel(index % 15, index / 15 % 11, index / (15 * 11));
      const glm::dvec3 expected = (voxel + 0.5) / glm::dvec3(15, 11, 8);
      ASSERT_LT(glm::length(u - expected), 1e-12);
      ASSERT_NEAR(value, truth(u), Tolerance);
    });
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 15 * 11 * 8);
    EXPECT_STREQ(this->Filter->GetOutput()->GetPointData()->GetScalars()->GetName(), "density");
    EXPECT_NE(vtkFloatArray::SafeDownCast(this->Filter->GetOutput()->GetPointData()->GetScalars()),
              nullptr);
  }
}

TEST_F(Decode, GivesTheVoxelsOfAScaledVolume)
{
  const auto model = MakeModel({15, 11, 8});
  const Truth truth(model);
  this->connect(*model, 60);
  this->Reader->SetScaleFactor(2);
  // By the native volume's u: values stay at their places.
  this->forEachVoxel(model->volume, [&](vtkIdType index, const glm::dvec3& u, double value) {
    const glm::dvec3 voxel(index % 30, index / 30 % 22, index / (30 * 22));
    ASSERT_LT(glm::length(u - (voxel + 0.5) / glm::dvec3(30, 22, 16)), 1e-12);
    ASSERT_NEAR(value, truth(u), Tolerance);
  });
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 30 * 22 * 16);
}

// Level 1 has the model's value at each voxel, coarser ones the mean of eight across it.
TEST_F(Decode, HalvesTheGridPerLevelAndAveragesWithinAVoxel)
{
  const auto model = MakeModel({15, 11, 8});
  const Truth truth(model);
  this->connect(*model);
  const glm::i64vec3 sizes[] = {{15, 11, 8}, {8, 6, 4}, {4, 3, 2}, {2, 2, 1}, {1, 1, 1}};
  for (int level = 1; level < 5; ++level) {
    SCOPED_TRACE(level);
    this->Filter->SetLevel(level);
    const glm::dvec3 size(sizes[level]);
    this->forEachVoxel(model->volume, [&](vtkIdType index, const glm::dvec3& u, double value) {
      const glm::i64vec3 n = sizes[level];
      const glm::dvec3 voxel(index % n.x, index / n.x % n.y, index / (n.x * n.y));
      ASSERT_LT(glm::length(u - (voxel + 0.5) / size), 1e-12);
      double sum = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        sum += truth(level == 1 ? u : u + (side - 0.5) * 0.5 / size);
      }
      ASSERT_NEAR(value, sum / 8, Tolerance);
    });
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(),
              sizes[level].x * sizes[level].y * sizes[level].z);
  }
}

TEST_F(Decode, CutsOutAVolumeOfInterest)
{
  const auto model = MakeModel({15, 11, 8});
  const Truth truth(model);
  this->connect(*model);
  this->Filter->SetVolumeOfInterest(3, 7, 0, -1, 6, 100);
  this->forEachVoxel(model->volume, [&](vtkIdType, const glm::dvec3& u, double value) {
    ASSERT_NEAR(value, truth(u), Tolerance);
  });
  int extent[6];
  this->Filter->GetOutput()->GetExtent(extent);
  EXPECT_EQ(std::vector<int>(extent, extent + 6), (std::vector<int>{3, 7, 0, 10, 6, 7}));
}

TEST_F(Decode, FollowsAnExtentThatAFilterHasMoved)
{
  const auto model = MakeModel({15, 11, 8});
  const Truth truth(model);
  this->connect(*model, 200);
  this->Reader->Update();
  vtkNew<vtkImageData> moved;
  moved->ShallowCopy(this->Reader->GetOutput());
  int extent[6];
  moved->GetExtent(extent);
  moved->SetExtent(extent[0] + 20, extent[1] + 20, extent[2] - 3, extent[3] - 3, extent[4],
                   extent[5]);
  inr::VolumeInfo volume = model->volume;
  this->Reader->GetOutput()->TransformIndexToPhysicalPoint(20, -3, 0, &volume.origin.x);
  this->Filter->SetInputData(moved);
  this->forEachVoxel(volume, [&](vtkIdType index, const glm::dvec3& u, double value) {
    const glm::dvec3 voxel(index % 15, index / 15 % 11, index / (15 * 11));
    ASSERT_LT(glm::length(u - (voxel + 0.5) / glm::dvec3(15, 11, 8)), 1e-12);
    ASSERT_NEAR(value, truth(u), Tolerance);
  });
}

TEST_F(Decode, ServesEachProcessItsPiece)
{
  const auto model = MakeModel({15, 11, 8});
  this->connect(*model);
  vtkIdType cells = 0;
  for (int piece = 0; piece < 4; ++piece) {
    this->Filter->UpdatePiece(piece, 4, 1);
    vtkImageData* image = this->Filter->GetOutput();
    for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell) {
      const bool ghost = image->GetCellGhostArray() && image->GetCellGhostArray()->GetValue(cell);
      cells += ghost ? 0 : 1;
    }
    EXPECT_LT(image->GetNumberOfPoints(), 15 * 11 * 8);
  }
  EXPECT_EQ(cells, 14 * 10 * 7);
}

TEST_F(Decode, KeepsTheThicknessOfASlab)
{
  const auto model = MakeModel({12, 1, 9});
  const Truth truth(model);
  this->connect(*model);
  for (const int level : {0, 1, 2}) {
    this->Filter->SetLevel(level);
    vtkImageData* image = this->update();
    EXPECT_EQ(image->GetDimensions()[1], 1);
    EXPECT_EQ(image->GetSpacing()[1], 1.25);
  }
  this->Filter->SetLevel(0);
  this->forEachVoxel(model->volume, [&](vtkIdType, const glm::dvec3& u, double value) {
    ASSERT_NEAR(value, truth(u), Tolerance);
  });
}

TEST_F(Decode, GivesTheTypeThatIsAskedFor)
{
  this->connect(*MakeModel({6, 5, 4}, inr::ScalarType::UInt8));
  EXPECT_EQ(this->update()->GetScalarType(), VTK_UNSIGNED_CHAR);
  this->Filter->SetScalarType(VTK_DOUBLE);
  vtkImageData* image = this->update();
  EXPECT_EQ(image->GetScalarType(), VTK_DOUBLE);
  const double value = image->GetPointData()->GetScalars()->GetTuple1(7);
  EXPECT_NE(value, std::floor(value));

  this->Filter->SetScalarType(VTK_STRING);
  const MessageCapture messages;
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.onlyError("ScalarType")) << messages.text();
}

TEST_F(Decode, GivesEveryTypeOfNumbers)
{
  this->connect(*MakeModel({6, 5, 4}, inr::ScalarType::UInt8));
  for (const int type :
       {VTK_TYPE_INT8, VTK_TYPE_UINT8, VTK_TYPE_INT16, VTK_TYPE_UINT16, VTK_TYPE_INT32,
        VTK_TYPE_UINT32, VTK_TYPE_INT64, VTK_TYPE_UINT64, VTK_FLOAT, VTK_DOUBLE}) {
    this->Filter->SetScalarType(type);
    EXPECT_EQ(this->update()->GetScalarType(), type);
    EXPECT_GE(this->Filter->GetOutput()->GetScalarRange()[0], 19.0); // the model has 20 to 90
  }
}

TEST_F(Decode, RefusesAVolumeOfInterestOutsideTheGrid)
{
  this->connect(*MakeModel({20, 14, 9}));
  this->Filter->SetVolumeOfInterest(20, 30, 0, -1, 0, -1);
  {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("20 to 30 of an axis that has 0 to 19")) << messages.text();
  }
  this->Filter->SetVolumeOfInterest(-5, -1, 0, -1, 0, -1);
  const MessageCapture messages;
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.onlyError("-5 to -1")) << messages.text();
}

TEST_F(Decode, RefusesWhatMemoryCannotHold)
{
  this->connect(*MakeModel({65536, 65536, 4096}));
  {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("higher Level or a smaller VolumeOfInterest"))
        << messages.text();
  }
  this->Filter->SetVolumeOfInterest(65000, 65003, 40000, 40003, 1, 4);
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 64);
}

TEST_F(Decode, RefusesOrdinaryData)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(4, 4, 4);
  image->AllocateScalars(VTK_FLOAT, 1);
  this->Filter->SetInputData(image);
  {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("not an implicit neural representation")) << messages.text();
  }
  this->connect(*MakeModel({6, 5, 4}));
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 120);
}

TEST_F(Decode, LeavesItToTheReaderToSayWhatIsWrongWithAFile)
{
  this->Reader->SetFileName((this->Folder / "missing.inr").c_str());
  this->Filter->SetInputConnection(this->Reader->GetOutputPort());
  const MessageCapture messages;
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.onlyError("missing.inr")) << messages.text();
}

TEST_F(Decode, ReportsProgressAndStopsWhenAsked)
{
  this->connect(*MakeModel({16, 16, 100}));
  struct Watcher
  {
    int calls = 0;
    double last = 0;
    bool rising = true;
    int stopAfter = VTK_INT_MAX;
  } watcher;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&watcher);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* self = static_cast<Watcher*>(data);
    auto* filter = vtkAlgorithm::SafeDownCast(caller);
    self->rising = self->rising && filter->GetProgress() >= self->last;
    self->last = filter->GetProgress();
    if (++self->calls >= self->stopAfter) {
      filter->SetAbortExecute(1);
    }
  });
  this->Filter->AddObserver(vtkCommand::ProgressEvent, command);
  this->update();
  EXPECT_GE(watcher.calls, 50);
  EXPECT_TRUE(watcher.rising);

  watcher = Watcher();
  watcher.stopAfter = 5;
  this->Filter->Modified();
  const MessageCapture messages;
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_LT(watcher.calls, 10);
  EXPECT_TRUE(messages.errors().empty()) << messages.text(); // who stops it, knows
}

// SPDX-License-Identifier: BSD-3-Clause
#include "MessageCapture.h"
#include "TestModels.h"
#include "Testing/Core/Inference/LongDoubleTruth.h"
#include "vtkINRReader.h"
#include "vtkINRSlice.h"

#include <vtkCallbackCommand.h>
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>
#include <vtkTransform.h>

#include <cmath>
#include <vector>

namespace {

class Slice : public testing::Test
{
protected:
  void connect(const inr::Model& model)
  {
    const std::string path = this->Folder / "model.inr";
    inr::WriteModel(model, path);
    this->Reader->SetFileName(path.c_str());
    this->Reader->Modified(); // the file may have the name of the one before
    this->Filter->SetInputConnection(this->Reader->GetOutputPort());
    this->Filter->SetCutFunction(this->Plane);
  }

  vtkPolyData* update()
  {
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  /// The plane through `index` (in voxels) across the direction `way` (in voxels).
  void cut(const inr::VolumeInfo& volume, const glm::dvec3& index, const glm::dvec3& normal)
  {
    glm::dvec3 origin = volume.origin + volume.direction * (index * volume.spacing);
    glm::dvec3 direction = volume.direction * normal;
    this->Plane->SetOrigin(&origin.x);
    this->Plane->SetNormal(&direction.x);
  }

  static glm::dvec3 indexOf(const inr::VolumeInfo& volume, vtkPolyData* slice, vtkIdType point)
  {
    glm::dvec3 world;
    slice->GetPoint(point, &world.x);
    return glm::inverse(volume.direction) * (world - volume.origin) / volume.spacing;
  }

  /// Every point lies on the plane and within the bounds, and has the value that the network gives
  /// there when it is evaluated in extended precision.
  void expectTruth(const inr::Model& model, vtkPolyData* slice)
  {
    const LongDoubleTruth truth(model);
    vtkDataArray* values = slice->GetPointData()->GetScalars();
    ASSERT_EQ(values->GetNumberOfTuples(), slice->GetNumberOfPoints());
    const glm::dvec3 last = glm::dvec3(model.volume.dims) - 1.0;
    for (vtkIdType k = 0; k < slice->GetNumberOfPoints(); ++k) {
      double world[3];
      slice->GetPoint(k, world);
      ASSERT_NEAR(this->Plane->FunctionValue(world), 0.0, 1e-9);
      const glm::dvec3 index = indexOf(model.volume, slice, k);
      const glm::dvec3 inside = glm::clamp(index, glm::dvec3(0.0), last);
      ASSERT_LT(glm::length(index - inside), 1e-6);
      const glm::vec3 u((inside + 0.5) / glm::dvec3(model.volume.dims));
      const Bounded y = truth(u);
      const auto known = static_cast<double>(y.value);
      const double value = model.volume.low + (model.volume.high - model.volume.low) * known;
      // u may round to the other neighbouring float, as it comes from another product here.
      const double error = static_cast<double>(y.error) + PositionTolerance;
      ASSERT_NEAR(values->GetTuple1(k), value, 70 * error);
    }
  }

  static double area(vtkPolyData* slice)
  {
    double area = 0;
    for (vtkIdType k = 0; k < slice->GetNumberOfCells(); ++k) {
      vtkCell* cell = slice->GetCell(k);
      double normal[3];
      area +=
          vtkPolygon::ComputeArea(cell->GetPoints(), cell->GetNumberOfPoints(), nullptr, normal);
    }
    return area;
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRReader> Reader;
  vtkNew<vtkPlane> Plane;
  vtkNew<vtkINRSlice> Filter;
};

} // namespace

TEST_F(Slice, IsTheVoxelsOnAPlaneOfVoxels)
{
  const auto model = MakeModel({15, 11, 8});
  this->connect(*model);
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    glm::dvec3 normal(0.0);
    normal[axis] = -2.0;
    for (const std::int64_t layer :
         {std::int64_t{0}, std::int64_t{3}, model->volume.dims[axis] - 1}) {
      glm::dvec3 index(4.3, 5.1, 2.7);
      index[axis] = static_cast<double>(layer);
      this->cut(model->volume, index, normal);
      vtkPolyData* slice = this->update();
      const glm::i64vec3 dims = model->volume.dims;
      ASSERT_EQ(slice->GetNumberOfPoints(), dims.x * dims.y * dims.z / dims[axis]);
      ASSERT_EQ(slice->GetNumberOfCells(),
                (dims.x - 1) * (dims.y - 1) * (dims.z - 1) / (dims[axis] - 1));
      for (vtkIdType k = 0; k < slice->GetNumberOfPoints(); ++k) {
        const glm::dvec3 at = indexOf(model->volume, slice, k);
        ASSERT_LT(glm::length(at - glm::round(at)), 1e-9);
        ASSERT_EQ(std::llround(at[axis]), layer);
      }
      this->expectTruth(*model, slice);
    }
  }
}

TEST_F(Slice, TakesAnyPlane)
{
  const auto model = MakeModel({15, 11, 8});
  this->connect(*model);
  const glm::dvec3 middle = 0.5 * (glm::dvec3(model->volume.dims) - 1.0);
  const glm::dvec3 size = (glm::dvec3(model->volume.dims) - 1.0) * model->volume.spacing;
  for (const glm::dvec3 normal : {glm::dvec3(1, 1, 1),
                                  {0.3, -1, 0.2},
                                  {0, 1, 1},
                                  {1e-7, 1, 0},
                                  {1, 0, -3},
                                  {-5, 0.1, 0.1},
                                  {0.01, 0.02, 1}}) {
    for (const double shift : {0.0, 0.3, -0.4}) {
      SCOPED_TRACE(testing::Message()
                   << normal.x << " " << normal.y << " " << normal.z << " " << shift);
      const glm::dvec3 index = middle + shift * glm::sign(normal) * middle;
      this->cut(model->volume, index, normal);
      vtkPolyData* slice = this->update();
      ASSERT_GT(slice->GetNumberOfPoints(), 3);
      this->expectTruth(*model, slice);
      // The area of a plane's part in a box, by counting on the axis that it covers best.
      const glm::dvec3 unit = glm::normalize(normal);
      const int axis = std::fabs(unit.x) > 0.6 ? 0 : std::fabs(unit.y) > 0.6 ? 1 : 2;
      const int first = (axis + 1) % 3;
      const int second = (axis + 2) % 3;
      constexpr int steps = 400;
      int hits = 0;
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
          glm::dvec3 place(0.0);
          place[first] = (i + 0.5) / steps * size[first];
          place[second] = (j + 0.5) / steps * size[second];
          const glm::dvec3 from = index * model->volume.spacing;
          place[axis] = from[axis] - glm::dot(unit, place - glm::dvec3(axis == 0 ? 0 : from.x,
                                                                       axis == 1 ? 0 : from.y,
                                                                       axis == 2 ? 0 : from.z)) /
                                         unit[axis];
          hits += place[axis] >= 0 && place[axis] <= size[axis] ? 1 : 0;
        }
      }
      const double expected =
          hits / double(steps * steps) * size[first] * size[second] / std::fabs(unit[axis]);
      EXPECT_NEAR(this->area(slice), expected, 0.01 * expected);
    }
  }
}

TEST_F(Slice, HasAPointForEveryNativeVoxelUnlessThatIsTooMany)
{
  const auto model = MakeModel({4096, 4096, 4096});
  this->connect(*model);
  this->cut(model->volume, {2000.25, 1000, 77}, {1, 0, 0});
  this->Filter->SetMaximumPoints(10000);
  vtkPolyData* slice = this->update();
  EXPECT_LE(slice->GetNumberOfPoints(), 10000);
  EXPECT_GT(slice->GetNumberOfPoints(), 9500);
  this->expectTruth(*model, slice);

  const auto small = MakeModel({40, 30, 20});
  this->connect(*small);
  this->cut(small->volume, {20, 15, 10}, {1, 0.4, 0});
  this->Filter->SetMaximumPoints(0);
  slice = this->update();
  for (vtkIdType k = 0; k < slice->GetNumberOfCells(); ++k) {
    vtkCell* cell = slice->GetCell(k);
    for (int edge = 0; edge < 2; ++edge) {
      const glm::dvec3 way = indexOf(small->volume, slice, cell->GetPointId(edge)) -
                             indexOf(small->volume, slice, cell->GetPointId(edge + 1));
      ASSERT_LT(std::fmax(std::fabs(way.x), std::fmax(std::fabs(way.y), std::fabs(way.z))), 1.5);
    }
  }
  EXPECT_EQ(slice->GetNumberOfPoints(), 20 * 30);
}

TEST_F(Slice, IsEmptyBesideTheVolume)
{
  const auto model = MakeModel({15, 11, 8});
  this->connect(*model);
  const MessageCapture messages;
  for (const double x : {-0.01, 14.01, 1e6}) {
    this->cut(model->volume, {x, 0, 0}, {1, 0, 0});
    vtkPolyData* slice = this->update();
    EXPECT_EQ(slice->GetNumberOfPoints(), 0);
    EXPECT_STREQ(slice->GetPointData()->GetScalars()->GetName(), "density");
  }
  this->cut(model->volume, {0, 0, 0}, {1, 2, 1}); // touches a corner
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
}

TEST_F(Slice, FollowsThePlaneAndItsTransform)
{
  const auto model = MakeModel({15, 11, 8});
  this->connect(*model);
  this->cut(model->volume, {7, 5, 3}, {0, 0, 1});
  this->update();
  vtkNew<vtkTransform> shift;
  const glm::dvec3 way = model->volume.direction * glm::dvec3(0, 0, -3.0); // a voxel up
  shift->Translate(way.x, way.y, way.z);
  this->Plane->SetTransform(shift);
  vtkPolyData* slice = this->update();
  this->expectTruth(*model, slice);
  EXPECT_NEAR(indexOf(model->volume, slice, 5).z, 4.0, 1e-9);
}

TEST_F(Slice, TakesASlabAsOneSpacingThick)
{
  const auto model = MakeModel({12, 1, 9});
  this->connect(*model);
  this->cut(model->volume, {4, 0, 0}, {1, 0, 0});
  vtkPolyData* slice = this->update();
  EXPECT_NEAR(this->area(slice), 1.25 * 3.0 * 8, 1e-6);
  this->cut(model->volume, {0, 0, 0}, {0, 1, 0});
  slice = this->update();
  EXPECT_EQ(slice->GetNumberOfPoints(), 12 * 9);
  this->expectTruth(*model, slice);
}

TEST_F(Slice, SharesItselfOutAmongProcesses)
{
  const auto model = MakeModel({15, 11, 8});
  this->connect(*model);
  this->cut(model->volume, {7, 5, 3}, {1, 1, 1});
  const double whole = this->area(this->update());
  double sum = 0;
  for (int piece = 0; piece < 3; ++piece) {
    this->Filter->UpdatePiece(piece, 3, 1);
    sum += this->area(this->Filter->GetOutput());
  }
  EXPECT_NEAR(sum, whole, 1e-9 * whole);
}

TEST_F(Slice, KeepsPrecisionAndDoesNotRound)
{
  this->connect(*MakeModel({15, 11, 8}, inr::ScalarType::UInt8));
  this->Plane->SetOrigin(this->Reader->GetOutput()->GetCenter());
  this->Reader->Update();
  this->Plane->SetOrigin(this->Reader->GetOutput()->GetCenter());
  EXPECT_EQ(this->update()->GetPointData()->GetScalars()->GetDataType(), VTK_FLOAT);
  const double value = this->update()->GetPointData()->GetScalars()->GetTuple1(3);
  EXPECT_NE(value, std::round(value));
  this->connect(*MakeModel({15, 11, 8}, inr::ScalarType::Float64));
  EXPECT_EQ(this->update()->GetPointData()->GetScalars()->GetDataType(), VTK_DOUBLE);
}

TEST_F(Slice, RefusesWhatItCannotDo)
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
  this->connect(*MakeModel({131072, 131072, 131072}));
  this->Plane->SetNormal(0, 0, 0);
  {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("Normal other than 0 0 0")) << messages.text();
  }
  this->Plane->SetNormal(0, 0, 1);
  this->Plane->SetOrigin(0, 0, HUGE_VAL);
  {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("Origin and a Normal that are finite")) << messages.text();
  }
  this->Reader->Update();
  this->Plane->SetOrigin(this->Reader->GetOutput()->GetCenter());
  this->Filter->SetMaximumPoints(0);
  {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError("lower MaximumPoints")) << messages.text();
  }
  this->Reader->SetFileName((this->Folder / "missing.inr").c_str());
  const MessageCapture messages;
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.onlyError("missing.inr")) << messages.text();
}

TEST_F(Slice, ReportsProgressAndStopsWhenAsked)
{
  const auto model = MakeModel({4096, 4096, 4096});
  this->connect(*model);
  this->cut(model->volume, {2000, 1000, 77}, {1, 0, 0});
  int calls = 0;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&calls);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* filter = vtkAlgorithm::SafeDownCast(caller);
    ++*static_cast<int*>(data);
    filter->SetAbortExecute(filter->GetProgress() > 0.1);
  });
  this->Filter->AddObserver(vtkCommand::ProgressEvent, command);
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_GE(calls, 1);
  EXPECT_LE(calls, 3);
}

// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes of extreme shapes, far away, huge and tiny: the geometry is kept to the last bit, and
// every voxel looked at has the network's value at its own place.
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDecode.h"
#include "vtkINRReader.h"
#include "vtkINRWriter.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace {

struct Geometry
{
  const char* name;
  glm::i64vec3 dims;
  glm::dvec3 spacing;
  glm::dvec3 origin;
};

std::ostream& operator<<(std::ostream& out, const Geometry& geometry)
{
  return out << geometry.name;
}

const Geometry All[] = {
    {"one_voxel", {1, 1, 1}, glm::dvec3(1), glm::dvec3(0)},
    {"two_voxels_an_axis", {2, 2, 2}, glm::dvec3(1e-12), glm::dvec3(0)},
    {"primes", {101, 7, 13}, {1e12, 1e12, 1e12}, {-1e9, 1e9, 0}},
    {"a_line_of_131072", {131072, 1, 1}, glm::dvec3(1e-12), glm::dvec3(0)},
    {"a_bar_of_131072", {3, 131072, 2}, {1, 1e-5, 1e5}, {1e9, 1e9, 1e9}},
    {"a_sheet_of_a_prime", {2, 1, 104729}, {1e5, 1, 1}, {0, -1e9, 3}},
    {"vast", {131072, 131072, 131072}, glm::dvec3(0.001), glm::dvec3(1e9)},
};

class Geometries : public testing::TestWithParam<Geometry>
{
protected:
  inr::ModelPointer model() const
  {
    const Geometry& geometry = this->GetParam();
    auto model = MakeModel(geometry.dims, inr::ScalarType::Float64);
    model->volume.spacing = geometry.spacing;
    model->volume.origin = geometry.origin;
    model->volume.direction = glm::dmat3(1.0);
    return model;
  }

  void connect(const inr::ModelPointer& model)
  {
    const std::string path = this->Folder / "model.inr";
    inr::WriteModel(*model, path);
    this->Reader->SetFileName(path.c_str());
    this->Filter->SetInputConnection(this->Reader->GetOutputPort());
  }

  /// The 2 x 2 x 2 voxels from `first` on, or what there is of them.
  void expectVoxels(const inr::ModelPointer& model, const glm::i64vec3& first)
  {
    const glm::i64vec3 last =
        glm::min(first + std::int64_t{1}, model->volume.dims - std::int64_t{1});
    int extent[6];
    for (int axis = 0; axis < 3; ++axis) {
      extent[2 * axis] = static_cast<int>(first[axis]);
      extent[2 * axis + 1] = static_cast<int>(last[axis]);
    }
    this->Filter->SetVolumeOfInterest(extent);
    this->Filter->Update();
    vtkImageData* image = this->Filter->GetOutput();
    const Truth truth(model);
    vtkIdType index = 0;
    for (std::int64_t z = first.z; z <= last.z; ++z) {
      for (std::int64_t y = first.y; y <= last.y; ++y) {
        for (std::int64_t x = first.x; x <= last.x; ++x, ++index) {
          const glm::dvec3 voxel(x, y, z);
          double world[3];
          image->GetPoint(index, world);
          for (int axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(world[axis],
                      model->volume.origin[axis] + voxel[axis] * model->volume.spacing[axis]);
          }
          const double value = image->GetPointData()->GetScalars()->GetTuple1(index);
          ASSERT_NEAR(value, truth((voxel + 0.5) / glm::dvec3(model->volume.dims)),
                      70 * PositionTolerance);
        }
      }
    }
    EXPECT_EQ(index, image->GetNumberOfPoints());
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRReader> Reader;
  vtkNew<vtkINRDecode> Filter;
};

TEST_P(Geometries, AreKeptAndDecodedAtBothEndsAndInTheMiddle)
{
  const inr::ModelPointer model = this->model();
  const MessageCapture messages;
  this->connect(model);
  const glm::i64vec3 last = model->volume.dims - std::int64_t{1};
  for (const glm::i64vec3& first : {glm::i64vec3(0), last / std::int64_t{2}, last}) {
    this->expectVoxels(model, first);
  }
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
}

TEST_P(Geometries, HaveTheirBoundsWhateverGridIsPresented)
{
  const inr::ModelPointer model = this->model();
  this->connect(model);
  for (const vtkIdType points : {vtkIdType{1} << 20, vtkIdType{30}}) {
    this->Reader->SetMaximumGridPoints(points);
    this->Reader->Update();
    double bounds[6];
    this->Reader->GetOutput()->GetBounds(bounds);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = model->volume.origin[axis];
      const double length =
          static_cast<double>(model->volume.dims[axis] - 1) * model->volume.spacing[axis];
      const double rounding = 4e-16 * (std::abs(low) + length);
      EXPECT_EQ(bounds[2 * axis], low);
      EXPECT_NEAR(bounds[2 * axis + 1], low + length, rounding);
    }
    double value = this->Reader->GetOutput()->GetPointData()->GetScalars()->GetTuple1(0);
    EXPECT_NEAR(value, Truth(model)(0.5 / glm::dvec3(model->volume.dims)), 70 * PositionTolerance);
  }
}

TEST_P(Geometries, ComeBackFromTheWriter)
{
  const Geometry& geometry = this->GetParam();
  vtkNew<vtkImageData> image;
  const glm::ivec3 dims(glm::min(geometry.dims, glm::i64vec3(16))); // of the larger ones, a part
  image->SetDimensions(dims.x, dims.y, dims.z);
  image->SetSpacing(geometry.spacing.x, geometry.spacing.y, geometry.spacing.z);
  image->SetOrigin(geometry.origin.x, geometry.origin.y, geometry.origin.z);
  image->AllocateScalars(VTK_DOUBLE, 1);
  for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
    image->GetPointData()->GetScalars()->SetTuple1(index,
                                                   std::sin(0.1 * static_cast<double>(index)));
  }
  const MessageCapture messages;
  const std::string path = this->Folder / "written.inr";
  vtkNew<vtkINRWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  writer->SetMaximumSteps(3);
  writer->Write();
  this->Reader->SetFileName(path.c_str());
  this->Reader->Update();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  vtkImageData* read = this->Reader->GetOutput();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(read->GetDimensions()[axis], dims[axis]);
    EXPECT_EQ(read->GetSpacing()[axis], geometry.spacing[axis]);
    EXPECT_EQ(read->GetOrigin()[axis], geometry.origin[axis]);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Geometries, testing::ValuesIn(All),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestModels.h"
#include "vtkINRReader.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

inline constexpr glm::i64vec3 Dims{20, 13, 7};

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

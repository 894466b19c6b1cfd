// SPDX-License-Identifier: BSD-3-Clause
// What is drawn of a piece that a process has of a volume.
#include "Core/Image/Metrics.h"
#include "OneVolume.h"
#include "vtkINRReader.h"

#include <vtkImageData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace {

/// The first or second half of the volume, seen as all of it would be.
class Pieces : public testing::TestWithParam<int>
{
protected:
  void show(int ghostLevels)
  {
    vtkNew<vtkINRReader> reader;
    reader->SetFileName(test::ModelFile().c_str());
    reader->UpdatePiece(GetParam(), 2, ghostLevels);
    this->points = reader->GetOutput()->GetNumberOfPoints();
    this->one.mapper->SetInputData(reader->GetOutput());
  }

  std::array<double, 6> part()
  {
    std::array<double, 6> part{};
    this->one.mapper->GetPartOfWhole(part.data());
    return part;
  }

  std::array<double, 6> bounds()
  {
    std::array<double, 6> bounds{};
    this->one.mapper->GetPieceBounds(bounds.data());
    return bounds;
  }

  test::OneVolume one;
  vtkIdType points = 0;
};

TEST_P(Pieces, EndWhereTheirGhostCellsBegin)
{
  this->show(0);
  const vtkIdType own = this->points;
  const auto part = this->part();
  const auto bounds = this->bounds();
  const inr::Image picture = this->one.scene.capture();
  EXPECT_GT(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 0);
  this->show(3);
  ASSERT_GT(this->points, own);
  EXPECT_EQ(this->part(), part);
  EXPECT_EQ(this->bounds(), bounds);
  EXPECT_EQ(inr::ImageMaximumError(this->one.scene.capture(), picture), 0);
}

INSTANTIATE_TEST_SUITE_P(Both, Pieces, testing::Values(0, 1));

} // namespace

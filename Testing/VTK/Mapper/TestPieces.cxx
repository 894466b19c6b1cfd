// SPDX-License-Identifier: BSD-3-Clause
// What is drawn of a piece that a process has of a volume.
#include "Core/Image/Metrics.h"
#include "OneVolume.h"
#include "vtkINRReader.h"

#include <vtkDataArray.h>
#include <vtkHardwareSelector.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkSmartPointer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <vector>

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

  /// Numbers of the cells that the picture shows.
  std::set<double> cells()
  {
    vtkNew<vtkHardwareSelector> selector;
    selector->SetRenderer(this->one.renderer);
    selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
    selector->SetArea(0, 0, test::Scene::Width - 1, test::Scene::Height - 1);
    const auto selection = vtkSmartPointer<vtkSelection>::Take(selector->Select());
    std::set<double> cells;
    for (unsigned k = 0; k < selection->GetNumberOfNodes(); ++k) {
      auto* list = vtkDataArray::SafeDownCast(selection->GetNode(k)->GetSelectionList());
      for (vtkIdType cell = 0; cell < list->GetNumberOfTuples(); ++cell) {
        cells.insert(list->GetTuple1(cell));
      }
    }
    return cells;
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

/// The same image, its points counted from elsewhere.
vtkSmartPointer<vtkImageData> Recounted(vtkImageData* image)
{
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->ShallowCopy(image);
  const int shift[3] = {7, -40, 3};
  int extent[6];
  image->GetExtent(extent);
  for (int k = 0; k < 6; ++k) {
    extent[k] += shift[k / 2];
  }
  result->SetExtent(extent);
  double origin[3];
  image->TransformIndexToPhysicalPoint(-shift[0], -shift[1], -shift[2], origin);
  result->SetOrigin(origin);
  return result;
}

TEST_P(Pieces, LieWhereTheirPointsAreWhateverTheirNumbers)
{
  this->show(3);
  std::array<double, 6> planes{};
  this->one.mapper->GetWholeBounds(planes.data());
  for (int axis = 0; axis < 3; ++axis) {
    planes[2 * axis] += 0.1 * (planes[2 * axis + 1] - planes[2 * axis]);
  }
  this->one.mapper->SetCroppingRegionPlanes(planes.data());
  this->one.mapper->CroppingOn();
  const auto part = this->part();
  const auto bounds = this->bounds();
  const inr::Image picture = this->one.scene.capture();
  const std::set<double> cells = this->cells();
  EXPECT_GT(cells.size(), 100U);
  this->one.mapper->SetInputData(
      Recounted(vtkImageData::SafeDownCast(this->one.mapper->GetDataSetInput())));
  EXPECT_EQ(this->part(), part);
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(this->bounds()[k], bounds[k], 1e-9);
  }
  EXPECT_LE(inr::ImageMaximumError(this->one.scene.capture(), picture), 1.5F / 255);
  std::vector<double> others; // where a rounding decides which of two cells it is
  const std::set<double> again = this->cells();
  std::set_symmetric_difference(cells.begin(), cells.end(), again.begin(), again.end(),
                                std::back_inserter(others));
  EXPECT_LE(others.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Both, Pieces, testing::Values(0, 1));

} // namespace

// SPDX-License-Identifier: BSD-3-Clause
//
// Regions between planes of the physical space, whichever way the image's axes go through it.
#include "Core/Image/Metrics.h"
#include "OneVolume.h"

#include <vtkImageData.h>
#include <vtkPlane.h>

#include <gtest/gtest.h>

#include <array>

namespace {

inr::Image Empty(const inr::Image& like) { return {like.width, like.height, like.channels}; }

struct Placed
{
  const char* name;
  std::array<double, 9> direction; ///< rows
  std::array<double, 3> signs;     ///< of the spacing
};

class Cropping : public testing::TestWithParam<Placed>
{
protected:
  Cropping()
  {
    this->one.mapper->Update();
    vtkNew<vtkImageData> image;
    image->ShallowCopy(this->one.mapper->GetDataSetInput());
    image->SetDirectionMatrix(GetParam().direction.data());
    std::array<double, 3> spacing{};
    image->GetSpacing(spacing.data());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      spacing[axis] *= GetParam().signs[axis];
    }
    image->SetSpacing(spacing.data());
    this->one.mapper->SetInputData(image);
    test::Scene::look(this->one.renderer);
    const double* bounds = this->one.mapper->GetBounds();
    for (int axis = 0; axis < 3; ++axis) {
      const double size = bounds[2 * axis + 1] - bounds[2 * axis];
      this->planes[2 * axis] = bounds[2 * axis] + (0.3 + 0.02 * axis) * size;
      this->planes[2 * axis + 1] = bounds[2 * axis] + (0.55 + 0.03 * axis) * size;
    }
    this->one.mapper->SetCroppingRegionPlanes(this->planes.data());
  }

  /// What clipping planes, which know nothing of images, leave of a region.
  inr::Image clipped(const std::array<int, 3>& region)
  {
    for (int axis = 0; axis < 3; ++axis) {
      if (region[axis] > 0) {
        this->clip(axis, this->planes[2 * axis + region[axis] - 1], 1);
      }
      if (region[axis] < 2) {
        this->clip(axis, this->planes[2 * axis + region[axis]], -1);
      }
    }
    inr::Image image = this->one.scene.capture();
    this->one.mapper->RemoveAllClippingPlanes();
    return image;
  }

  /// Leaves what is on the side of `place` along an axis to which `direction` points.
  void clip(int axis, double place, double direction)
  {
    std::array<double, 3> origin{};
    std::array<double, 3> normal{};
    origin[axis] = place;
    normal[axis] = direction;
    vtkNew<vtkPlane> plane;
    plane->SetOrigin(origin.data());
    plane->SetNormal(normal.data());
    this->one.mapper->AddClippingPlane(plane);
  }

  inr::Image cropped(int flags)
  {
    this->one.mapper->CroppingOn();
    this->one.mapper->SetCroppingRegionFlags(flags);
    inr::Image image = this->one.scene.capture();
    this->one.mapper->CroppingOff();
    return image;
  }

  test::OneVolume one;
  std::array<double, 6> planes{};
};

INSTANTIATE_TEST_SUITE_P(
    Images, Cropping,
    testing::Values(Placed{"plain", {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 1, 1}},
                    Placed{"flipped", {-1, 0, 0, 0, -1, 0, 0, 0, 1}, {1, 1, 1}},
                    Placed{"exchanged", {0, -1, 0, 0, 0, 1, 1, 0, 0}, {1, 1, 1}},
                    Placed{"backwards", {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, -1, -1}},
                    Placed{"both", {0, 1, 0, -1, 0, 0, 0, 0, 1}, {-1, 1, -1}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(Cropping, LeavesTheRegionsThatClippingPlanesLeave)
{
  const inr::Image whole = this->one.scene.capture();
  int seen = 0;
  for (const std::array<int, 3>& region :
       {std::array<int, 3>{1, 1, 1}, {0, 1, 1}, {1, 2, 1}, {2, 1, 0}, {0, 0, 1}, {1, 1, 2}}) {
    const int bit = region[0] + 3 * region[1] + 9 * region[2];
    SCOPED_TRACE(bit);
    const inr::Image expected = this->clipped(region);
    EXPECT_LE(inr::ImageMaximumError(this->cropped(1 << bit), expected), 2.5F / 255);
    seen += inr::ImageMaximumError(expected, Empty(whole)) > 0.1 ? 1 : 0;
    EXPECT_GT(inr::ImageMaximumError(expected, whole), 0.1);
  }
  EXPECT_GE(seen, 3); // the others may be where nothing is
}

/// Along an axis of one point nothing is between the bounds of points, from which ParaView makes
/// its box.
TEST(CroppingOfSlabs, ShowsAllThatIsWithinTheBoundsOfPoints)
{
  inr::Model model = *test::MakeModel();
  model.volume.dims.z = 1;
  model.macroCells = inr::MakeMacroCells(model.volume.dims, 16);
  for (auto& range : model.macroCells.ranges) {
    range.extend(0);
    range.extend(1);
  }
  test::OneVolume one(test::InrMapper(test::Write(model, "Slab.inr")));
  const inr::Image whole = one.scene.capture();
  EXPECT_GT(inr::ImageMaximumError(whole, Empty(whole)), 0.1);
  std::array<double, 6> bounds{};
  one.mapper->GetWholeBounds(bounds.data());
  EXPECT_EQ(bounds[4], bounds[5]);
  one.mapper->SetCroppingRegionPlanes(bounds.data());
  one.mapper->CroppingOn();
  EXPECT_EQ(inr::ImageMaximumError(one.scene.capture(), whole), 0);
}

} // namespace

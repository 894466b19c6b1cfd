// SPDX-License-Identifier: BSD-3-Clause
// Several volumes in a renderer. Truth: each drawn alone, laid over each other by hand.
#include "Core/Image/Metrics.h"
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkCamera.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

namespace {

struct Order
{
  const char* name;
  bool nearFirst; ///< in the renderer
  bool peeled;
  double distance; ///< between the volumes, in world units towards the camera
};

/// A volume and its double, moved towards the camera and faded.
struct Two
{
  explicit Two(const Order& order)
  {
    const std::string file = test::Write(*test::MakeModel(), "Several.inr");
    this->renderer = this->scene.addRenderer();
    this->renderer->SetUseDepthPeeling(order.peeled);
    this->renderer->SetUseDepthPeelingForVolumes(order.peeled);
    this->far = this->scene.addVolume(this->renderer, test::InrMapper(file));
    test::Scene::look(this->renderer);
    const double* way = this->renderer->GetActiveCamera()->GetViewPlaneNormal();
    this->near = this->scene.addVolume(this->renderer, test::InrMapper(file));
    this->near->SetPosition(order.distance * way[0] + 4, order.distance * way[1],
                            order.distance * way[2]);
    this->near->GetProperty()->SetScalarOpacityUnitDistance(12);
    if (order.nearFirst) {
      this->renderer->RemoveVolume(this->far);
      this->renderer->AddVolume(this->far);
    }
  }

  inr::Image capture(bool showsNear, bool showsFar)
  {
    this->near->SetVisibility(showsNear);
    this->far->SetVisibility(showsFar);
    this->renderer->ResetCameraClippingRange(-300, 400, -300, 400, -300, 400);
    return this->scene.capture();
  }

  test::Scene scene;
  vtkRenderer* renderer;
  vtkSmartPointer<vtkVolume> near;
  vtkSmartPointer<vtkVolume> far;
};

inr::Image Over(const inr::Image& front, const inr::Image& back)
{
  inr::Image result = front;
  for (std::size_t k = 0; k < result.pixels.size(); ++k) {
    result.pixels[k] += (1.0f - front.pixels[k / 4 * 4 + 3]) * back.pixels[k];
  }
  return result;
}

class Several : public testing::TestWithParam<Order>
{};

TEST_P(Several, AreDrawnFromTheFurthestToTheNearest)
{
  Two two(this->GetParam());
  const inr::Image near = two.capture(true, false);
  const inr::Image far = two.capture(false, true);
  const inr::Image both = two.capture(true, true);
  test::WritePng(std::string(INR_TEST_OUTPUT) + "/Several" + this->GetParam().name + ".png", both);
  EXPECT_LT(inr::ImageMaximumError(both, Over(near, far)), 3.0f / 255);
  EXPECT_GT(inr::ImageMaximumError(both, Over(far, near)),
            20.0f / 255); // else there is nothing to see
  EXPECT_LT(inr::ImageMaximumError(two.capture(true, true), both), 1e-6f); // frame after frame
}

TEST_P(Several, StayWhenTheOtherIsHidden)
{
  Two two(this->GetParam());
  const inr::Image near = two.capture(true, false);
  const inr::Image far = two.capture(false, true);
  two.capture(true, true);
  EXPECT_LT(inr::ImageMaximumError(two.capture(true, false), near), 1e-6f);
  two.capture(true, true);
  EXPECT_LT(inr::ImageMaximumError(two.capture(false, true), far), 1e-6f);
}

INSTANTIATE_TEST_SUITE_P(Mapper, Several,
                         testing::Values(Order{"NearFirst", true, false, 90},
                                         Order{"FarFirst", false, false, 90},
                                         Order{"NearFirstPeeled", true, true, 90},
                                         Order{"FarFirstPeeled", false, true, 90},
                                         Order{"OverlappingNearFirst", true, false, 8},
                                         Order{"OverlappingFarFirst", false, false, 8}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace

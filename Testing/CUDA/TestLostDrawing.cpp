// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of pictures that a device draws when it is lost, lies, or is told to stop.
#include "Testing/CUDA/DrawingScene.h"
#include "Testing/CUDA/EmulatedRenderers.h"
#include "Testing/CUDA/FailingMachine.h"

#include <atomic>

namespace test::lost_drawing {

/// Infers as the emulated one does, and draws on a failing machine.
class FailingAccelerator : public EmulatedAccelerator
{
public:
  explicit FailingAccelerator(std::shared_ptr<FailingOrders> orders)
      : EmulatedAccelerator(inr::cuda::Precision::Float32, Duty::InfersAndDraws),
        Orders(std::move(orders))
  {}

  std::shared_ptr<inr::AcceleratedRenderer>
  makeRenderer(const inr::ModelPointer& model, const glm::i64vec3& dims,
               const inr::CacheOptions& options) const override
  {
    return MakeRendererOn<FailingMachine>(this->Orders, this->inferenceOf(model), dims, options);
  }

private:
  std::shared_ptr<FailingOrders> Orders;
};

TEST(LostDrawing, LeavesThePictureToTheCpu)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = SmallFrame(mode);
    const Drawn truth = Draw(frame, OptionsWith(nullptr));
    const auto counting = std::make_shared<FailingOrders>();
    inr::Renderer whole = RendererOf(OptionsWith(std::make_shared<FailingAccelerator>(counting)));
    inr::Image picture;
    ASSERT_TRUE(whole.render(frame, picture).accelerated);
    const int orders = counting->orders;
    ASSERT_GT(orders, 50);
    for (int fails = 0; fails < orders; fails += fails < 3 ? 1 : orders / 12) {
      SCOPED_TRACE(std::to_string(fails) + " of " + std::to_string(orders));
      const auto failing = std::make_shared<FailingOrders>();
      failing->failsAt = fails;
      inr::Renderer renderer =
          RendererOf(OptionsWith(std::make_shared<FailingAccelerator>(failing)));
      inr::Image image;
      EXPECT_TRUE(renderer.render(frame, image).complete);
      EXPECT_GE(inr::ImagePsnr(image, truth.rgba), 50);
      ASSERT_TRUE(renderer.acceleratorFailure());
      EXPECT_EQ(renderer.acceleratorFailure()->reason, "the machine is lost");
      EXPECT_EQ(renderer.accelerator(), "");
      const int asked = failing->orders; // and never again
      EXPECT_FALSE(renderer.render(frame, image).accelerated);
      EXPECT_EQ(failing->orders, asked);
    }
  }
}

/// Draws in a limited time until the picture is complete; false where that takes too long.
bool Completes(inr::Renderer& renderer, inr::Frame frame, inr::Image& image)
{
  frame.timeLimit = 1e-9;
  for (int calls = 0; calls < 2000; ++calls) {
    if (renderer.render(frame, image).complete) {
      return true;
    }
  }
  return false;
}

/// Whose bricks come in behind other frames.
TEST(LostDrawing, LeavesThePictureToTheCpuInAnyOfItsFrames)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = SmallFrame(mode);
    const Drawn truth = Draw(frame, OptionsWith(nullptr));
    const auto counting = std::make_shared<FailingOrders>();
    inr::Renderer whole = RendererOf(OptionsWith(std::make_shared<FailingAccelerator>(counting)));
    inr::Image image;
    ASSERT_TRUE(Completes(whole, frame, image));
    ASSERT_FALSE(whole.acceleratorFailure());
    const int orders = counting->orders;
    ASSERT_GT(orders, 80);
    for (int fails = orders / 29; fails < orders; fails += orders / 17) {
      SCOPED_TRACE(std::to_string(fails) + " of " + std::to_string(orders));
      const auto failing = std::make_shared<FailingOrders>();
      failing->failsAt = fails;
      inr::Renderer renderer =
          RendererOf(OptionsWith(std::make_shared<FailingAccelerator>(failing)));
      EXPECT_TRUE(Completes(renderer, frame, image));
      EXPECT_GE(inr::ImagePsnr(image, truth.rgba), 50);
      ASSERT_TRUE(renderer.acceleratorFailure());
      EXPECT_EQ(renderer.acceleratorFailure()->reason, "the machine is lost");
    }
  }
}

TEST(LostDrawing, IsNotTrustedWithOtherPictures)
{
  const inr::Frame frame = SmallFrame(inr::RenderMode::RayMarching);
  const Drawn truth = Draw(frame, OptionsWith(nullptr));
  const auto lying = std::make_shared<FailingOrders>();
  lying->lies = true;
  inr::Renderer renderer = RendererOf(OptionsWith(std::make_shared<FailingAccelerator>(lying)));
  inr::Image image;
  EXPECT_FALSE(renderer.render(frame, image).accelerated);
  EXPECT_GE(inr::ImagePsnr(image, truth.rgba), 80);
  ASSERT_TRUE(renderer.acceleratorFailure());
  EXPECT_NE(renderer.acceleratorFailure()->reason.find("dB from the CPU's"), std::string::npos);
}

/// And goes on as if nothing had been.
TEST(LostDrawing, StopsOnRequest)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = SmallFrame(mode);
    const Drawn truth = Draw(frame, OptionsWith(Device()));
    inr::Renderer renderer = RendererOf(OptionsWith(Device()));
    inr::Image image;
    for (int most = 0; most < 4; ++most) {
      std::atomic<int> asked{0};
      const auto stopAfterSome = [&] { return asked++ < most; };
      EXPECT_THROW(renderer.render(frame, image, nullptr, stopAfterSome), inr::Error) << most;
    }
    EXPECT_TRUE(renderer.render(frame, image).complete);
    EXPECT_FALSE(renderer.acceleratorFailure());
    EXPECT_EQ(image.pixels, truth.rgba.pixels);
  }
}

} // namespace test::lost_drawing

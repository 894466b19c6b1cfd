// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures from a network that computes with rounded numbers.
#include "Core/Inference/InstructionSet.h"
#include "Testing/Core/Render/AcceleratedScene.h"

namespace {

bool CanRound()
{
  const inr::InstructionSet best = inr::ChooseInstructionSet("");
  return inr::IsUsable(inr::InferencePrecision::BFloat16, best);
}

inr::Renderer Rounded(const inr::ModelPointer& model, Way way)
{
  inr::RendererOptions options = OptionsFor(way, nullptr);
  options.inference = inr::InferencePrecision::BFloat16;
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(Visible());
  return renderer;
}

TEST(InferencePrecision, ShowsInPicturesThatShareNoBricks)
{
  const inr::ModelPointer model = SomeModel();
  for (const Way way : {Way::Still, Way::Network, Way::Paths}) {
    const inr::Frame frame = FrameFor(way);
    inr::Renderer exact = RendererFor(model, way, nullptr);
    const inr::Image truth = Finish(exact, frame);
    const std::int64_t bytes = exact.cacheBytes();
    inr::Renderer rounded = Rounded(model, way);
    const inr::Image picture = Finish(rounded, frame);
    EXPECT_EQ(picture.pixels == truth.pixels, !CanRound());
    EXPECT_GT(inr::ImagePsnr(picture, truth), 35);
    EXPECT_EQ(exact.cacheBytes() > bytes, CanRound() && IsCached(way));
    EXPECT_EQ(Finish(exact, frame).pixels, truth.pixels);
    EXPECT_EQ(rounded.kernel().find("bfloat16") != std::string::npos, CanRound());
  }
}

TEST(InferencePrecision, IsFloatBesideAnAccelerator)
{
  const inr::ModelPointer model = SomeModel();
  inr::RendererOptions options =
      OptionsFor(Way::Still, std::make_shared<FakeAccelerator>(std::make_shared<FakeDevice>()));
  options.inference = inr::InferencePrecision::BFloat16;
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(Visible());
  EXPECT_EQ(renderer.kernel().find("bfloat16"), std::string::npos);
  EXPECT_EQ(Finish(renderer, FrameFor(Way::Still)).pixels, Truth(model, Way::Still).pixels);
}

} // namespace

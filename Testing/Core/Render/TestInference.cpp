// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures from a network that computes with rounded numbers.
#include "Core/Inference/InferenceKernels.h"
#include "Testing/Core/Render/AcceleratedScene.h"

namespace test::inference {

/// Numbers to compute with, whether that is to be had here, and by what pictures are the same.
struct Rounding
{
  inr::InferencePrecision precision;
  bool usable;
  double psnr;
};

std::vector<Rounding> Roundings()
{
  using inr::InferencePrecision;
  const inr::InstructionSet best = inr::ChooseInstructionSet("");
  return {{InferencePrecision::BFloat16, inr::IsUsable(InferencePrecision::BFloat16, best), 33},
          {InferencePrecision::SplitBFloat16, inr::IsTileKernelUsable(), 80}};
}

/// Small enough values that 16 bits are off by little.
inr::ModelPointer ModelOf(int neurons)
{
  inr::Description description = SmallDescription();
  description.network.neurons = neurons;
  auto model = CalmModel(description);
  model->volume = VolumeOf(AcceleratedDims);
  return model;
}

inr::Renderer Rounded(const inr::ModelPointer& model, Way way, inr::InferencePrecision precision)
{
  inr::RendererOptions options = OptionsFor(way, nullptr);
  options.inference = precision;
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(Visible());
  return renderer;
}

TEST(InferencePrecision, ShowsInPicturesThatShareNoBricks)
{
  const inr::ModelPointer model = ModelOf(16);
  for (const Rounding& rounding : Roundings()) {
    for (const Way way : {Way::Still, Way::Network, Way::Paths}) {
      const inr::Frame frame = FrameFor(way);
      inr::Renderer exact = RendererFor(model, way, nullptr);
      const inr::Image truth = Finish(exact, frame);
      const std::int64_t bytes = exact.cacheBytes();
      inr::Renderer rounded = Rounded(model, way, rounding.precision);
      const inr::Image picture = Finish(rounded, frame);
      EXPECT_EQ(picture.pixels == truth.pixels, !rounding.usable);
      EXPECT_GT(inr::ImagePsnr(picture, truth), rounding.psnr);
      EXPECT_EQ(exact.cacheBytes() > bytes, rounding.usable && IsCached(way));
      EXPECT_EQ(Finish(exact, frame).pixels, truth.pixels);
      EXPECT_EQ(rounded.kernel().find("bfloat16") != std::string::npos, rounding.usable);
    }
  }
}

TEST(InferencePrecision, IsThatOfTheCacheWhereItPays)
{
  const auto splits = [](int neurons, const std::function<void(inr::RendererOptions&)>& change) {
    inr::RendererOptions options = OptionsFor(Way::Still, nullptr);
    options.inference.reset();
    change(options);
    return inr::Renderer(ModelOf(neurons), options).kernel().find("split") != std::string::npos;
  };
  EXPECT_EQ(splits(64, [](auto&) {}), inr::IsTileKernelUsable());
  EXPECT_FALSE(splits(32, [](auto&) {}));
  EXPECT_FALSE(splits(64, [](auto& options) { options.cached = false; }));
  EXPECT_FALSE(
      splits(64, [](auto& options) { options.cache.precision = inr::CachePrecision::Float32; }));
  EXPECT_FALSE(
      splits(64, [](auto& options) { options.inference = inr::InferencePrecision::Float32; }));
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

} // namespace test::inference

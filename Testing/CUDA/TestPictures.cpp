// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures whose bricks or samples the kernels infer against those of the CPU alone, on the host
// and on the GPU, and what becomes of them when the device is lost.
#include "CUDA/CudaAccelerator.h"
#include "Core/Image/Metrics.h"
#include "Testing/CUDA/EmulatedAccelerator.h"
#include "Testing/CUDA/Places.h"
#include "Testing/CUDA/TrainedModel.h"
#include "Testing/Core/FakeAccelerator.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <algorithm>
#include <cmath>

namespace test::pictures {

enum class Way { Cached, Uncached, Paths, UncachedPaths };
constexpr Way Ways[] = {Way::Cached, Way::Uncached, Way::Paths, Way::UncachedPaths};

bool IsTraced(Way way) { return way == Way::Paths || way == Way::UncachedPaths; }

inr::RendererOptions OptionsFor(Way way, std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cached = way == Way::Cached || way == Way::Paths;
  options.cache = Options(inr::CachePrecision::Bits16, 12);
  options.accelerator = std::move(accelerator);
  return options;
}

inr::Image Picture(Way way, std::shared_ptr<const inr::Accelerator> accelerator)
{
  const inr::ModelPointer& model = TrainedModel();
  inr::Renderer renderer(model, OptionsFor(way, std::move(accelerator)));
  inr::TransferFunction colours = Colours();
  colours.low = model->volume.low;
  colours.high = model->volume.high;
  renderer.setTransferFunction(colours);
  inr::Frame frame = Oblique(glm::dvec3(model->volume.dims));
  frame.levelOfDetailScale = 1;
  frame.samplesPerPixel = 4;
  frame.paths.ambientLight = glm::vec3(1.0f);
  frame.mode = IsTraced(way) ? inr::RenderMode::PathTracing : inr::RenderMode::RayMarching;
  inr::Image image;
  EXPECT_TRUE(renderer.render(frame, image).complete);
  return image;
}

class Pictures : public InEveryPlace
{
protected:
  static std::shared_ptr<const inr::Accelerator> accelerator()
  {
    if (GetParam().place == Place::Gpu) {
      return inr::cuda::MakeAccelerator(inr::cuda::ChooseDevice(), GetParam().precision);
    }
    return std::make_shared<EmulatedAccelerator>(GetParam().precision);
  }
  /// What the issue asks for of half precision, too; float32 is far from it.
  static double least() { return GetParam().half() ? 40 : 50; }
};

TEST_P(Pictures, AreThoseOfTheCpu)
{
  for (const Way way : Ways) {
    const inr::Image truth = Picture(way, nullptr);
    ASSERT_GT(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 0.1f);
    const auto device = std::make_shared<FakeDevice>(); // that never fails, to count
    const inr::Image image =
        Picture(way, std::make_shared<FakeAccelerator>(device, this->accelerator()));
    EXPECT_GT(device->calls, 3) << static_cast<int>(way);
    EXPECT_GE(inr::ImagePsnr(image, truth), this->least()) << static_cast<int>(way);
  }
}

TEST_P(Pictures, AreTheSameWhenTheDeviceIsLost)
{
  for (const Way way : Ways) {
    const inr::Image truth = Picture(way, nullptr);
    for (const int call : {0, 2, 3, 5}) {
      const auto device = std::make_shared<FakeDevice>();
      device->failsAt = call;
      const inr::Image image =
          Picture(way, std::make_shared<FakeAccelerator>(device, this->accelerator()));
      EXPECT_GT(device->refused, 0) << static_cast<int>(way);
      EXPECT_GE(inr::ImagePsnr(image, truth), this->least()) << static_cast<int>(way);
    }
  }
}

/// In float32, what comes into the cache is off by less than it is rounded there: by half a quantum
/// of 16 bits, in the mean, of what a brick spans. Half precision is not.
TEST_P(Pictures, ComeFromBricksThatAreExactEnoughForTheCache)
{
  const inr::ModelPointer& model = TrainedModel();
  const inr::Hierarchy levels(model->volume.dims, 12);
  const auto device = this->accelerator()->makeBrickSource(model, levels);
  const auto cpu = inr::MakeBrickSource(inr::MakeEvaluator(model), levels);
  const inr::Arena arena(2);
  const auto voxels = static_cast<std::size_t>(levels.voxelsPerBrick());
  double squares = 0;
  double allowed = 0;
  for (const inr::BrickKey key :
       {inr::KeyOf({0, {0, 0, 0}}), inr::KeyOf({0, levels.bricks(0) / std::int64_t{2}}),
        levels.coarsest()}) {
    std::vector<float> values[2] = {std::vector<float>(voxels), std::vector<float>(voxels)};
    device->infer(&key, 1, values[0].data(), arena);
    cpu->infer(&key, 1, values[1].data(), arena);
    const auto [low, high] = std::minmax_element(values[1].begin(), values[1].end());
    const double half = (*high - *low) / 65535 / 2;
    for (std::size_t k = 0; k < voxels; ++k) {
      squares += std::pow(values[0][k] - values[1][k], 2);
      allowed += half * half / 3; // the variance of rounding
    }
  }
  std::cout << "off by " << std::sqrt(squares / allowed) << " of what 16 bits are\n";
  EXPECT_EQ(squares < allowed, !GetParam().half());
}

INSTANTIATE_TEST_SUITE_P(Kernels, Pictures, testing::ValuesIn(AllSettings()), NameOf);

TEST(Accelerators, AreSharedUntilTheyFail)
{
  const inr::cuda::FoundAccelerator found = inr::cuda::FindAccelerator(0);
  if (!found.accelerator) {
    EXPECT_EQ(found.reason, inr::cuda::FindDevices().reason);
    GTEST_SKIP() << found.reason;
  }
  EXPECT_NE(found.accelerator->name().find(inr::cuda::ChooseDevice().name), std::string::npos);
  EXPECT_NE(found.accelerator->name().find("float32"), std::string::npos);
  EXPECT_EQ(inr::cuda::FindAccelerator(0).accelerator, found.accelerator);
  const auto field = found.accelerator->open(TrainedModel());
  field->fail(inr::Error(inr::ErrorCode::Device, "lost"), true);
  EXPECT_NE(inr::cuda::FindAccelerator(0).accelerator, found.accelerator);
}

} // namespace test::pictures

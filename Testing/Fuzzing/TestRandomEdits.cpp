// SPDX-License-Identifier: BSD-3-Clause
//
// Two hosts that share a model's bricks, each on a thread of its own, change everything at random
// while bricks load: whatever came before, a picture is that of a fresh renderer, bit by bit.
//
// 40 changes each; INR_EDITS says how many. Built for preset tsan, too: run it there with 1000.
#include "Core/Error.h"
#include "Core/Random.h"
#include "Testing/Core/FakeAccelerator.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <atomic>
#include <cstdlib>
#include <optional>
#include <thread>

namespace test::random_edits {

constexpr glm::i64vec3 Dims(52, 61, 40);

/// What a host can turn.
struct Settings
{
  inr::RendererOptions options;
  inr::TransferFunction colours = Colours();
  inr::Frame frame = Oblique(glm::dvec3(Dims), 24);
};

class Dice
{
public:
  explicit Dice(std::uint64_t seed) : Seed(seed) {}
  int below(int end)
  {
    return static_cast<int>(inr::RandomBits(this->Seed, this->Count++) %
                            static_cast<unsigned>(end));
  }

private:
  std::uint64_t Seed;
  std::uint64_t Count = 0;
};

/// Computes what the CPU would, and half of them are lost some time.
std::shared_ptr<const inr::Accelerator> SomeAccelerator(Dice& dice)
{
  const auto device = std::make_shared<FakeDevice>();
  device->failsAt = dice.below(2) == 0 ? dice.below(200) : FakeDevice::Never;
  return std::make_shared<FakeAccelerator>(device);
}

void EditOptions(inr::RendererOptions& options, Dice& dice)
{
  inr::CacheOptions& cache = options.cache;
  switch (dice.below(9)) {
  case 0:
    cache.precision = static_cast<inr::CachePrecision>(dice.below(3));
    break;
  case 1:
    cache.brickSize = 6 + 5 * dice.below(3);
    break;
  case 2:
    cache.bytes = std::int64_t{1} << (18 + dice.below(6));
    break;
  case 3:
    options.threads = 1 + dice.below(3);
    break;
  case 4:
    cache.onlyWhatFits = !cache.onlyWhatFits;
    break;
  case 5:
    options.deterministic = !options.deterministic;
    break;
  case 6:
    cache.preloading = !cache.preloading;
    break;
  case 7: // the backend
    options.accelerator = options.accelerator ? nullptr : SomeAccelerator(dice);
    break;
  default:
    cache.ranking = !cache.ranking;
  }
}

void EditColours(inr::TransferFunction& colours, Dice& dice)
{
  for (glm::vec4& entry : colours.table) {
    entry.w = dice.below(3) == 0 ? 0.1f * static_cast<float>(dice.below(5)) : entry.w;
  }
}

void EditCamera(inr::Frame& frame, Dice& dice)
{
  const glm::dmat4 centre = glm::translate(glm::dmat4(1.0), 0.5 * glm::dvec3(Dims));
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1 + dice.below(9), 1 + dice.below(9), 1));
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.1 * (1 + dice.below(9)), axis);
  frame.clipToWorld = centre * turn * glm::inverse(centre) * frame.clipToWorld;
}

std::optional<double> ToleranceOf(int choice)
{
  constexpr double tolerances[] = {0, 0.1, 1, 8, 1e9};
  return choice < 5 ? std::optional<double>(tolerances[choice]) : std::nullopt;
}

void EditFrame(inr::Frame& frame, Dice& dice)
{
  switch (dice.below(8)) {
  case 0:
    frame.mode = static_cast<inr::RenderMode>(dice.below(2));
    frame.samplesPerPixel = 1 + dice.below(2);
    frame.blending = {};
    break;
  case 1:
    frame.mode = inr::RenderMode::RayMarching;
    frame.blending.mode = static_cast<inr::BlendMode>(dice.below(6));
    frame.blending.isosurfaces = {0.3, 0.6};
    break;
  case 2:
    frame.levelOfDetailScale = 0.5 * dice.below(6);
    break;
  case 3:
    frame.sampleDistance = 0.5 + 0.3 * dice.below(5);
    break;
  case 4:
    frame.shading = dice.below(2) == 0 ? std::optional<inr::Material>() : inr::Material();
    frame.lights.assign(1, {});
    break;
  case 5:
  case 6:
    frame.errorTolerance = ToleranceOf(dice.below(6));
    break;
  default:
    frame.unitDistance = 1 + dice.below(8);
    frame.adaptiveSampling = !frame.adaptiveSampling;
    frame.preIntegration = dice.below(2) == 0;
  }
}

class Host
{
public:
  Host(inr::ModelPointer model, std::uint64_t seed) : Model(std::move(model)), Chance(seed)
  {
    this->Now.options.cache.brickSize = 16; // of which every size holds enough
  }

  void edit()
  {
    const int kind = this->Chance.below(10);
    if (kind < 2 || !this->Made) {
      EditOptions(this->Now.options, this->Chance);
      this->make();
    } else if (kind < 4) {
      EditColours(this->Now.colours, this->Chance);
    } else if (kind < 8) {
      EditCamera(this->Now.frame, this->Chance);
    } else {
      EditFrame(this->Now.frame, this->Chance);
    }
  }

  /// As far as it comes in some time, or until it is stopped.
  void glance()
  {
    inr::Frame frame = this->Now.frame;
    frame.timeLimit = 1e-3 * (1 + this->Chance.below(5));
    std::atomic<int> left{this->Chance.below(4) == 0 ? this->Chance.below(20) : 1 << 20};
    inr::Image image;
    try {
      this->Made->setTransferFunction(this->Now.colours);
      this->Made->render(frame, image, nullptr, [&] { return --left > 0; });
    } catch (const inr::Error& error) {
      if (error.code() != inr::ErrorCode::Cancelled) {
        throw;
      }
    }
  }

  /// Pictures that make do with what fits depend on what does.
  bool canBeRepeated() const { return !this->Now.options.cache.onlyWhatFits; }

  /// Paths whose bricks a cache cannot hold are traced with the network instead.
  inr::Frame exact() const
  {
    inr::Frame frame = this->Now.frame;
    if (this->Now.options.cache.bytes < 4 << 20) {
      frame.mode = inr::RenderMode::RayMarching;
    }
    return frame;
  }

  /// As it is where a tolerance counts.
  inr::Frame tolerant() const
  {
    inr::Frame frame = this->Now.frame;
    frame.mode = inr::RenderMode::RayMarching;
    frame.blending = {};
    frame.shading.reset();
    frame.errorTolerance = std::max(0.1, frame.errorTolerance.value_or(4));
    return frame;
  }

  std::vector<float> picture(const inr::Frame& frame)
  {
    this->Made->setTransferFunction(this->Now.colours);
    inr::Image image;
    this->Made->render(frame, image);
    return image.pixels;
  }

  /// What another process would show.
  std::vector<float> freshPicture(const inr::Frame& frame) const
  {
    const auto other = std::make_shared<inr::Model>(*this->Model); // shares nothing
    inr::Renderer renderer(inr::ModelPointer(other), this->Now.options);
    renderer.setTransferFunction(this->Now.colours);
    inr::Image image;
    renderer.render(frame, image);
    return image.pixels;
  }

private:
  void make()
  {
    inr::Renderer next(this->Model, this->Now.options); // before the old one goes, as hosts do
    this->Made.emplace(std::move(next));
  }

  inr::ModelPointer Model;
  Dice Chance;
  Settings Now;
  std::optional<inr::Renderer> Made;
};

inr::ModelPointer SomeModel()
{
  auto model = RandomModel(SmallDescription());
  model->volume.dims = Dims;
  model->macroCells = inr::MakeMacroCells(Dims, 8);
  model->macroCells.provenance = inr::MacroCellProvenance::Decoded; // so that blocks are hidden
  for (std::size_t k = 0; k < model->macroCells.ranges.size(); ++k) {
    const float low = 0.1f * static_cast<float>(k % 7);
    model->macroCells.ranges[k] = {low, low + 0.4f};
  }
  return model;
}

void EditAtRandom(const inr::ModelPointer& model, std::uint64_t seed, int edits)
{
  constexpr int oftenEnough = 20;
  Host host(model, seed);
  for (int k = 1; k <= edits && !testing::Test::HasFailure(); ++k) {
    host.edit();
    host.glance();
    if ((k % oftenEnough == 0 || k == edits) && host.canBeRepeated()) {
      for (const inr::Frame& frame : {host.exact(), host.tolerant()}) {
        EXPECT_EQ(host.picture(frame), host.freshPicture(frame))
            << "host " << seed << " after " << k;
      }
    }
  }
}

TEST(RandomEdits, EndInThePictureOfAFreshRenderer)
{
  const char* const told = std::getenv("INR_EDITS");
  const int edits = told != nullptr ? std::atoi(told) : 40;
  const inr::ModelPointer model = SomeModel();
  std::thread other([&] { EditAtRandom(model, 2, edits); });
  EditAtRandom(model, 1, edits);
  other.join();
}

} // namespace test::random_edits

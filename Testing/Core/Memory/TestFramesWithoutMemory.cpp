// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation of making a renderer and a picture fails once, or that and all that follow: an
// error, and the next picture is right to the last bit. There are thousands; some are tried, and
// all of them with INR_ALL_ALLOCATIONS in the environment, or `ctest -L long` (25 minutes of two
// busy cores).
#include "Core/Error.h"
#include "Testing/Core/Memory/FailingMemory.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <chrono>
#include <cstdlib>
#include <exception>
#include <optional>

namespace test::frames_without_memory {

using For = FailingMemory::For;

/// A way to make pictures.
struct Way
{
  const char* name;
  inr::RendererOptions options;
  inr::Frame frame;
};

std::ostream& operator<<(std::ostream& out, const Way& way) { return out << way.name; }

constexpr glm::i64vec3 Dims(17, 21, 13);

inr::RendererOptions Through(int brickSize, std::int64_t bytes)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cache = Options(inr::CachePrecision::Bits16, brickSize);
  options.cache.bytes = bytes;
  options.cache.background = false;
  return options;
}

inr::Frame Small()
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 20);
  frame.sampleDistance = 1;
  frame.unitDistance = 3;
  return frame;
}

std::vector<Way> Ways()
{
  constexpr std::int64_t plenty = 8 << 20;
  constexpr std::int64_t little = 12 << 10; // many bricks go for others
  std::vector<Way> ways(9, {"", Through(6, plenty), Small()});
  ways[0].name = "ThroughACache";
  ways[1].name = "ThroughASmallCache";
  ways[1].options.cache.bytes = little;
  ways[2].name = "StraightFromTheNetwork";
  ways[2].options.cached = false;
  ways[3].name = "TracingPaths";
  ways[3].frame.mode = inr::RenderMode::PathTracing;
  ways[3].frame.samplesPerPixel = 2;
  ways[4].name = "InTurns";
  ways[4].options.deterministic = true;
  ways[4].frame.timeLimit = 0.05;
  ways[5].name = "InTurnsThroughASmallCache";
  ways[5].options.deterministic = true;
  ways[5].options.cache.bytes = little;
  ways[5].frame.timeLimit = 0.05;
  ways[6].name = "WithAThreadThatLoads";
  ways[6].options.cache.background = true;
  ways[6].frame.timeLimit = 0.002;
  ways[7].name = "Shaded";
  ways[7].frame.shading.emplace();
  ways[7].frame.lights.emplace_back();
  ways[8].name = "KeepingToATolerance";
  ways[8].frame.errorTolerance = 4;
  return ways;
}

inr::TransferFunction Others()
{
  inr::TransferFunction colours = Colours();
  for (glm::vec4& entry : colours.table) {
    entry = {entry.z, entry.x, entry.y, 0.5f * (1 - entry.x)};
  }
  return colours;
}

/// A renderer that a host would go on using, and what happens to it.
class Host
{
public:
  Host(inr::ModelPointer model, const Way& way) : Model(std::move(model)), How(way) {}

  /// What a host does for a picture, whatever came before.
  inr::Image picture(const inr::TransferFunction& colours, const inr::Frame& frame)
  {
    if (!this->Made) {
      this->Made.emplace(this->Model, this->How.options);
    }
    this->Made->setTransferFunction(colours);
    inr::Image image;
    while (!this->Made->render(frame, image).complete) { // where time is limited
    }
    return image;
  }

  /// The same for a picture that may be the first to hear of what failed on the thread that loads,
  /// which is told once.
  inr::Image laterPicture(const inr::TransferFunction& colours, const inr::Frame& frame)
  {
    try {
      return this->picture(colours, frame);
    } catch (const std::bad_alloc&) {
      if (!this->How.options.cache.background) {
        throw;
      }
      return this->picture(colours, frame);
    }
  }

  void set(const inr::TransferFunction& colours) { this->Made->setTransferFunction(colours); }

private:
  inr::ModelPointer Model;
  const Way& How;
  std::optional<inr::Renderer> Made;
};

class FramesWithoutMemory : public testing::TestWithParam<Way>
{
protected:
  FramesWithoutMemory()
  {
    auto model = RandomModel(SmallDescription());
    model->volume.dims = Dims;
    model->macroCells = inr::MakeMacroCells(Dims, 8);
    model->macroCells.provenance = inr::MacroCellProvenance::Decoded; // or no tolerance chooses
    for (std::size_t k = 0; k < model->macroCells.ranges.size(); ++k) {
      // Not what the network gives, which is moved into them: some show with each of the colours.
      const float low = 0.25f * static_cast<float>(k % 4);
      model->macroCells.ranges[k] = {low, low + 0.2f};
    }
    this->Model = model;
    this->First = Host(this->Model, this->GetParam()).picture(Colours(), this->GetParam().frame);
    this->Second = Host(this->Model, this->GetParam()).picture(Others(), this->projected());
  }

  inr::Frame projected() const
  {
    inr::Frame frame = this->GetParam().frame;
    frame.mode = inr::RenderMode::RayMarching;
    frame.blending.mode = inr::BlendMode::MaximumIntensity;
    return frame;
  }

  /// False when nothing was left to fail. The host shows one picture, fails at the other, and is
  /// asked for it again, and for the first.
  bool failsWell(std::int64_t nth, For how)
  {
    Host host(this->Model, this->GetParam());
    bool failed = false;
    try {
      const FailingMemory memory(nth, how);
      try {
        host.picture(Colours(), this->GetParam().frame);
        host.picture(Others(), this->projected());
      } catch (...) {
        failed = memory.hasFailed();
        throw;
      }
      failed = memory.hasFailed();
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::TooLarge) << nth << ": " << error.what();
    } catch (const std::bad_alloc&) {
    }
    EXPECT_EQ(host.laterPicture(Others(), this->projected()).pixels, this->Second.pixels) << nth;
    EXPECT_EQ(host.laterPicture(Colours(), this->GetParam().frame).pixels, this->First.pixels)
        << nth;
    return failed;
  }

  std::int64_t allocations()
  {
    const FailingMemory memory(std::int64_t{1} << 60, For::Once);
    Host host(this->Model, this->GetParam());
    host.picture(Colours(), this->GetParam().frame);
    host.picture(Others(), this->projected());
    return memory.asked();
  }

  inr::ModelPointer Model;
  inr::Image First;
  inr::Image Second;
};

TEST_P(FramesWithoutMemory, FailAndAreRightTheNextTime)
{
  const std::int64_t tries = std::getenv("INR_ALL_ALLOCATIONS") != nullptr ? 1 << 20 : 40;
  const std::int64_t count = this->allocations();
  ASSERT_GT(count, 50);
  const std::int64_t before = BlocksInUse();
  for (const For how : {For::Once, For::Good}) {
    // The first ones all, then every so many.
    const std::int64_t step = std::max<std::int64_t>(1, count / tries);
    for (std::int64_t nth = 1; nth <= count && !HasFailure(); nth += nth < tries / 2 ? 1 : step) {
      this->failsWell(nth, how);
    }
  }
  EXPECT_LE(BlocksInUse(), before + 20) << "memory is lost"; // what libraries make once
}

// What can be seen is found anew for other colours and other ways to blend, and not for the same.
TEST_P(FramesWithoutMemory, KnowWhetherTheyKnowWhatCanBeSeen)
{
  const inr::Frame& frame = this->GetParam().frame;
  inr::Frame surfaces = this->projected();
  surfaces.blending.mode = inr::BlendMode::Isosurface;
  surfaces.blending.isosurfaces = {0.1, 0.3, 0.6};
  const inr::Image right = Host(this->Model, this->GetParam()).picture(Others(), frame);
  const inr::Image rightSurfaces = Host(this->Model, this->GetParam()).picture(Others(), surfaces);
  bool failed = true;
  for (std::int64_t nth = 1; failed && !HasFailure(); ++nth) {
    Host host(this->Model, this->GetParam());
    host.picture(Colours(), frame);
    failed = false;
    try {
      const FailingMemory memory(nth, For::Once);
      host.set(Others());
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    EXPECT_EQ(host.laterPicture(Others(), frame).pixels, right.pixels) << nth;
    try {
      const FailingMemory memory(nth, For::Good);
      host.picture(Others(), surfaces);
    } catch (const std::exception&) {
    }
    EXPECT_EQ(host.laterPicture(Others(), surfaces).pixels, rightSurfaces.pixels) << nth;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, FramesWithoutMemory, testing::ValuesIn(Ways()),
                         [](const testing::TestParamInfo<Way>& info) { return info.param.name; });

} // namespace test::frames_without_memory

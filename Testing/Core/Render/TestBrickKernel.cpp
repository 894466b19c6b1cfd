// SPDX-License-Identifier: BSD-3-Clause
//
// Runs of samples, laid out and interpolated by every kernel, against double precision one sample
// at a time.
#include "Core/Random.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/PreIntegratedColors.h"
#include "Core/Render/Marching/StepTable.h"
#include "Core/Render/Scene/ColorTable.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/Render/KernelBricks.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

namespace test::brick_kernel {

using namespace kernel_bricks;

/// Of 64, so many that are set.
std::uint64_t RandomBits(int count)
{
  std::uint64_t bits = 0;
  while (count > 0) {
    const std::uint64_t bit = std::uint64_t{1} << RandomInt(0, 63);
    count -= (bits & bit) == 0 ? 1 : 0;
    bits |= bit;
  }
  return bits;
}

/// The place of the first, second ... that is set.
std::vector<int> PlacesOf(std::uint64_t bits)
{
  std::vector<int> places;
  for (int k = 0; k < 64; ++k) {
    if ((bits >> k & 1) != 0) {
      places.push_back(k);
    }
  }
  return places;
}

inr::SampleRun RandomRun(int count, int paths)
{
  inr::SampleRun run;
  run.start[0] = std::floor(Random(0, 20));
  run.start[1] = std::floor(Random(0, 20));
  run.stride = 1u << RandomInt(0, 3);
  run.spacing = static_cast<float>(run.stride);
  run.offset = Random(0, run.spacing);
  run.ways = RandomInt(1, 2);
  run.path[0] = RandomInt(0, paths - 1);
  run.path[1] = (run.path[0] + RandomInt(1, paths - 1)) % paths;
  run.fraction = Random(-0.2f, 1);
  run.growth = Random(0, 0.02f);
  run.seed = static_cast<std::uint32_t>(inr::RandomBits(3, static_cast<std::uint64_t>(count)));
  run.counter = static_cast<std::uint32_t>(RandomInt(0, 100000));
  run.count = count;
  run.shown = RandomInt(0, 1) == 0 ? inr::LowestBits(count) : RandomBits(count);
  run.length = RandomInt(0, 9);
  run.low = Random(-1, 0);
  run.high = Random(0, 1);
  return run;
}

/// Checks the samples of a run, which begin at `at` in the batch; how many were on the second path.
int Check(const Voxels& voxels, const inr::SampleBatch& batch, const inr::SampleRun& run, int at)
{
  int second = 0;
  const std::vector<int> numbers = PlacesOf(run.shown);
  EXPECT_EQ(static_cast<int>(numbers.size()), run.count);
  for (const int k : numbers) {
    const int sample = at++;
    const double fine = static_cast<double>(run.start[0]) + k * run.spacing + run.offset;
    const float random =
        inr::RandomUnit32(run.seed, run.counter + static_cast<std::uint32_t>(k) * run.stride);
    const double fraction = run.fraction + run.growth * fine;
    const int way = batch.path[sample] == run.path[0] ? 0 : 1;
    EXPECT_EQ(batch.path[sample], run.path[way]);
    if (std::abs(random - fraction) > 1e-6) {
      EXPECT_EQ(way, run.ways > 1 && random < fraction ? 1 : 0);
    }
    second += way;
    const double along = way == 0 ? fine : run.start[1] + k * run.spacing + run.offset;
    // Places are rounded to float: at a slope of 2 per voxel in the worst case.
    const inr::BrickPath& path = batch.paths[batch.path[sample]];
    const double steepest =
        path.quantum * (voxels.format.bytes == inr::VoxelBytes::Four ? 1.0 : 65536.0);
    EXPECT_NEAR(batch.value[sample], Trilinear(voxels, path, along),
                1e-5 * std::max(1.0, steepest));
    EXPECT_EQ(batch.low[sample], run.low);
    EXPECT_EQ(batch.high[sample], run.high);
    EXPECT_EQ(batch.length[sample], run.length);
  }
  return second;
}

class BrickKernels : public testing::TestWithParam<std::string>
{};

TEST_P(BrickKernels, LayOutRuns)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  int second = 0;
  for (const auto bytes : {inr::VoxelBytes::One, inr::VoxelBytes::Two, inr::VoxelBytes::Four}) {
    const Voxels voxels = MakeVoxels(bytes);
    for (int round = 0; round < 200; ++round) {
      const auto batch = std::make_unique<inr::SampleBatch>();
      constexpr int paths = 6;
      std::generate_n(batch->paths, paths, [&] { return RandomPath(voxels); });
      int count = 0;
      int runs = 0;
      const int most = RandomInt(1, inr::SampleBatch::Capacity);
      while (count < most) {
        const int longest = std::min(most - count, inr::SampleRow::Most);
        batch->runs[runs] = RandomRun(RandomInt(1, longest), paths);
        count += batch->runs[runs++].count;
      }
      kernel.sampleRuns(voxels.format, *batch, runs);
      int at = 0;
      for (int run = 0; run < runs; ++run) {
        second += Check(voxels, *batch, batch->runs[run], at);
        at += batch->runs[run].count;
      }
      // The same samples, one by one.
      std::vector<float> values(batch->value, batch->value + count);
      kernel.sample(voxels.format, *batch, count);
      EXPECT_EQ(values, std::vector<float>(batch->value, batch->value + count));
    }
  }
  EXPECT_GT(second, 1000);
}

// Of each sample on one of two paths, exactly where it then is.
TEST_P(BrickKernels, FindWhichSamplesOnTwoPathsMayShowSomething)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  const Voxels voxels = MakeVoxels(inr::VoxelBytes::Two);
  int seen[2] = {};
  int hidden[2] = {};
  for (int round = 0; round < 2000; ++round) {
    const auto batch = std::make_unique<inr::SampleBatch>();
    inr::ShownBlocks blocks[2];
    for (int way = 0; way < 2; ++way) {
      batch->paths[way] = RandomPath(voxels);
      blocks[way].kind = static_cast<inr::ShownBlocks::Kind>(RandomInt(0, 2));
      for (std::uint64_t& word : blocks[way].words) {
        word = RandomBits(RandomInt(0, 64));
      }
    }
    inr::SampleRun& run = batch->runs[0];
    run = RandomRun(RandomInt(1, 64), 2);
    run.ways = 2;
    run.path[0] = 0;
    run.path[1] = 1;
    run.shown = inr::LowestBits(run.count);
    const std::uint64_t shown =
        kernel.findShownOnTwo(voxels.format, {&blocks[0], &blocks[1]},
                              {&batch->paths[0], &batch->paths[1]}, run, run.count);
    EXPECT_EQ(shown & ~inr::LowestBits(run.count), 0u);
    kernel.sampleRuns(voxels.format, *batch, 1);
    for (int k = 0; k < run.count; ++k) {
      const int way = batch->path[k];
      const bool isShown = (shown >> k & 1) != 0;
      const inr::ShownBlocks& its = blocks[way];
      const inr::SampleRow row{batch->along[k], 0, 0};
      const bool truth = its.kind == inr::ShownBlocks::Kind::All ||
                         (its.kind == inr::ShownBlocks::Kind::Some &&
                          kernel.findShown(voxels.format, its, batch->paths[way], row, 1) != 0);
      EXPECT_EQ(isShown, truth) << k;
      ++(isShown ? seen : hidden)[way];
    }
  }
  for (const int way : {0, 1}) {
    EXPECT_GT(seen[way], 3000);
    EXPECT_GT(hidden[way], 3000);
  }
}

TEST_P(BrickKernels, FindWhichSamplesMayShowSomething)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  const Voxels voxels = MakeVoxels(inr::VoxelBytes::Two);
  int hidden = 0;
  int seen = 0;
  for (int round = 0; round < 2000; ++round) {
    const inr::BrickPath path = RandomPath(voxels);
    inr::ShownBlocks blocks;
    blocks.kind = inr::ShownBlocks::Kind::Some;
    for (std::uint64_t& word : blocks.words) {
      word = RandomBits(RandomInt(0, 64));
    }
    const inr::SampleRow row{std::floor(Random(0, 9)), static_cast<float>(RandomInt(1, 2)),
                             Random(0, 1)};
    const int count = RandomInt(1, 64);
    const std::uint64_t shown = kernel.findShown(voxels.format, blocks, path, row, count);
    for (int k = 0; k < 64; ++k) {
      const bool isShown = (shown >> k & 1) != 0;
      if (k >= count) {
        EXPECT_FALSE(isShown);
        continue;
      }
      const double along = static_cast<double>(row.start) + k * row.spacing + row.offset;
      int block[3];
      bool isBetween = false; // and may be taken for in either
      for (int axis = 0; axis < 3; ++axis) {
        const double place = std::clamp<double>(path.origin[axis] + along * path.direction[axis], 0,
                                                path.last[axis]) /
                             BlockEdge;
        block[axis] = std::min(static_cast<int>(place), voxels.format.lastBlock[axis]);
        const double face = std::round(place);
        isBetween = isBetween || (std::abs(place - face) < 1e-5 && face > 0 &&
                                  face <= voxels.format.lastBlock[axis]);
      }
      const bool truth = (blocks.words[block[2]] >> (block[0] + 8 * block[1]) & 1) != 0;
      if (!isBetween) {
        EXPECT_EQ(isShown, truth);
      }
      (isShown ? seen : hidden) += 1;
    }
  }
  EXPECT_GT(seen, 10000);
  EXPECT_GT(hidden, 10000);
}

// A million samples of an even medium, of several lengths: in float as good as is said, in double
// as good as the entries are.
TEST_P(BrickKernels, CompositeAnyNumberOfSamples)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  inr::TransferFunction medium;
  medium.table = {glm::vec4(0.25f, 0.5f, 1, 0.3f), glm::vec4(0.25f, 0.5f, 1, 0.3f)};
  const inr::ColorTable colors(medium, inr::VolumeInfo{});
  constexpr int lengths = 4;
  const inr::StepTable table(colors.lookup(), 5e-7, lengths);
  for (const bool ofMany : {false, true}) {
    inr::RayColor color{{0, 0, 0}, 1, ofMany};
    long double transmittance = 1;
    const auto batch = std::make_unique<inr::SampleBatch>();
    std::int64_t samples = 0;
    std::int64_t clamped = 0;
    for (int round = 0; round < 16384; ++round) {
      for (int k = 0; k < inr::SampleBatch::Capacity; ++k) {
        batch->value[k] = 0.5f;
        batch->low[k] = 0;
        batch->high[k] = 1;
        batch->length[k] = (k * round) % lengths;
        const auto row = std::int64_t{batch->length[k]} * table.lookup().rows + 3;
        transmittance *= 1 - static_cast<long double>(table.lookup().entries[4 * row + 3]);
      }
      samples += kernel.composite(table.lookup(), *batch, inr::SampleBatch::Capacity, 0.001f, color,
                                  clamped);
    }
    EXPECT_EQ(samples, std::int64_t{16384} * inr::SampleBatch::Capacity);
    const auto truth = static_cast<double>(transmittance);
    EXPECT_LT(truth, 0.9); // by as much as a picture shows
    const auto count = static_cast<double>(samples);
    const double bound = ofMany ? 1e-11 : count * 0x1p-25;
    EXPECT_NEAR(color.transmittance, truth, bound);
    EXPECT_NEAR(color.rgb[0], 0.25 * (1 - truth), bound);
    EXPECT_NEAR(color.rgb[2], 1 - truth, bound);
    EXPECT_EQ(clamped, 0);
  }
}

// Next to a peak of opacity 1, which is opaque however short a sample is, while short samples of
// values beside it let nearly everything through.
TEST_P(BrickKernels, CompositeWhatIsSteep)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  inr::TransferFunction peak;
  peak.table = {{1, 0, 0, 0}, {1, 0, 0, 1}, {1, 0, 0, 0}};
  const inr::ColorTable colors(peak, inr::VolumeInfo{});
  constexpr double step = 1e-4;
  const inr::StepTable table(colors.lookup(), step, 4);
  const auto batch = std::make_unique<inr::SampleBatch>();
  double transmittance = 1;
  for (int k = 0; k < inr::SampleBatch::Capacity; ++k) {
    batch->length[k] = k % 4;
    batch->value[k] = 0.5f + Random(-3, 3) / table.lookup().scale;
    batch->low[k] = 0;
    batch->high[k] = 1;
    const double through = 2 * std::abs(0.5 - static_cast<double>(batch->value[k]));
    transmittance *= std::pow(through, step * static_cast<double>(inr::StepsOf(k % 4)));
  }
  const auto used = [&](inr::RayColor& color) {
    std::int64_t clamped = 0;
    return kernel.composite(table.lookup(), *batch, inr::SampleBatch::Capacity, 0.001f, color,
                            clamped);
  };
  inr::RayColor color{{0, 0, 0}, 1, false};
  EXPECT_EQ(used(color), inr::SampleBatch::Capacity);
  EXPECT_LT(transmittance, 0.95);
  EXPECT_NEAR(color.transmittance, transmittance, 0.01 * (1 - transmittance));
  EXPECT_NEAR(color.rgb[0], 1 - color.transmittance, 1e-5);

  batch->value[5] = 0.5f;
  color = {{0, 0, 0}, 1, false};
  EXPECT_EQ(used(color), 6);
  EXPECT_EQ(color.transmittance, 0);
}

/// Peaks, steps at the ends, what is faint, and if wanted what is opaque.
inr::TransferFunction Rugged(bool opaque)
{
  inr::TransferFunction function;
  function.low = 0.1;
  function.high = 0.9;
  for (int k = 0; k < 40; ++k) {
    const bool isOpaque = opaque && k > 30 && k < 33;
    function.table.emplace_back(Random(0, 1), Random(0, 1), Random(0, 1),
                                isOpaque ? 1.0f : std::pow(10.0f, Random(-6, -0.2f)));
  }
  function.table[20].w = function.table[21].w = function.table[22].w = 0;
  function.below = {1, 0.5f, 0, 0.02f};
  function.above = {0, 1, 0.25f, 0};
  return function;
}

void FillRamps(inr::SampleBatch& batch, int lengths)
{
  for (int k = 0; k < inr::SampleBatch::Capacity; ++k) {
    batch.length[k] = RandomInt(0, lengths - 1);
    batch.value[k] = Random(0, 1);
    const int kind = RandomInt(0, 3);
    batch.begin[k] = kind == 0   ? Random(0, 1)
                     : kind == 1 ? batch.value[k]
                     : kind == 2 ? batch.value[k] + Random(-1e-5f, 1e-5f)
                     : k > 0     ? batch.value[k - 1]
                                 : 0.0f;
  }
}

// Below and above the transfer function's range, too, and next to what is opaque.
TEST_P(BrickKernels, FindColorsOfSamplesOfAnyLength)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  constexpr int lengths = 7;
  constexpr double step = 0.01;
  const auto batch = std::make_unique<inr::SampleBatch>();
  for (int round = 0; round < 300; ++round) {
    const inr::ColorTable colors(Rugged(round % 3 == 0), inr::VolumeInfo{});
    const inr::StepTable table(colors.lookup(), step, lengths);
    const int count = RandomInt(1, inr::SampleBatch::Capacity);
    for (int k = 0; k < count; ++k) {
      batch->value[k] = Random(-0.1f, 1.1f);
      batch->low[k] = -1;
      batch->high[k] = 2;
      batch->length[k] = RandomInt(0, lengths - 1);
    }
    glm::vec4 found[inr::SampleBatch::Capacity];
    kernel.findColors(table.lookup(), *batch, count, &found->x);
    for (int k = 0; k < count; ++k) {
      const glm::dvec4 truth(colors.lookup().at(batch->value[k]));
      const double length = step * static_cast<double>(inr::StepsOf(batch->length[k]));
      const double opacity = -std::expm1(length * std::log1p(-truth.w));
      EXPECT_NEAR(found[k].w, opacity, 1e-2) << batch->value[k];
      EXPECT_LT(glm::length(glm::dvec3(found[k]) - glm::dvec3(truth)), 2e-3) << batch->value[k];
    }
  }
}

// Samples between two values, against the same in double one by one.
TEST_P(BrickKernels, CompositeWhatIsIntegrated)
{
  const inr::BrickKernel& kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
  constexpr int lengths = 7;
  constexpr double step = 0.01;
  for (int round = 0; round < 300; ++round) {
    // Next to what is opaque, density rises so fast that the rounding of a position shows.
    const bool opaque = round % 3 == 0;
    const double tolerance = opaque ? 2e-3 : 5e-5;
    const inr::ColorTable colors(Rugged(opaque), inr::VolumeInfo{});
    const inr::PreIntegratedColors integrals(colors.lookup());
    const auto batch = std::make_unique<inr::SampleBatch>();
    FillRamps(*batch, lengths);
    const int first = RandomInt(0, 40);
    const int end = RandomInt(first, inr::SampleBatch::Capacity);
    inr::RayColor color{{0.1, 0.2, 0.3}, 0.75, round % 2 == 0};
    const int used = kernel.compositeIntegrated(integrals.lookup().kernelLookup(step), *batch,
                                                first, end, 0.001f, color);
    glm::dvec3 rgb(0.1, 0.2, 0.3);
    double transmittance = 0.75;
    int k = first;
    for (; k < end && transmittance > 0.001; ++k) {
      ASSERT_NEAR(batch->opacity[k], 1 - transmittance, tolerance) << k;
      const glm::vec4 mean = integrals.lookup().between(batch->begin[k], batch->value[k]);
      const double length = step * static_cast<double>(inr::StepsOf(batch->length[k]));
      const double opacity = -std::expm1(length * std::log1p(-static_cast<double>(mean.w)));
      rgb += glm::dvec3(mean) * (transmittance * opacity);
      transmittance -= transmittance * opacity;
    }
    EXPECT_NEAR(used, k - first, 1); // at 0.001, rounding decides
    EXPECT_NEAR(color.transmittance, transmittance, tolerance);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(color.rgb[channel], rgb[channel], tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, BrickKernels, testing::ValuesIn(UsableKernels()),
                         [](const auto& info) { return info.param; });

} // namespace test::brick_kernel

// SPDX-License-Identifier: BSD-3-Clause
//
// Who uses tile registers, and how. TestBFloat16.cpp tests what comes of it.
#include "Core/Error.h"
#include "Core/Inference/TileCheck.h"
#include "Core/Inference/TileRegisters.h"
#include "Testing/Core/Inference/EvaluatePoints.h"
#include "Testing/Core/Inference/TileImitation.h"
#include "Testing/Core/Inference/TileTraps.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <thread>

namespace test::tiles {

/// What a made-up processor and its operating system answer.
struct Answers
{
  inr::CpuidAnswer leaf0{0x20, 0, 0, 0};
  inr::CpuidAnswer leaf1{0, 0, 1u << 27, 0};
  inr::CpuidAnswer features{0, 0, 0, 1u << 22 | 1u << 24};
  inr::CpuidAnswer palettes{1, 0, 0, 0};
  inr::CpuidAnswer palette{8192 | 1024u << 16, 64 | 8u << 16, 16, 0}; // as Sapphire Rapids has it
  inr::CpuidAnswer multiplier{0, 16 | 64u << 8, 0, 0};
  std::uint64_t saved = 0x600e7;
  bool permission = true;
  int asked = 0;
};
Answers Machine;

inr::CpuidAnswer Cpuid(std::uint32_t leaf, std::uint32_t subleaf)
{
  switch (leaf) {
  case 0:
    return Machine.leaf0;
  case 1:
    return Machine.leaf1;
  case 7:
    return Machine.features;
  case 0x1d:
    return subleaf == 1 ? Machine.palette : Machine.palettes;
  case 0x1e:
    return Machine.multiplier;
  default:
    return {~0u, ~0u, ~0u, ~0u};
  }
}

bool MayUseTiles(const std::function<void(Answers&)>& change = [](Answers&) {})
{
  Machine = {};
  change(Machine);
  return inr::MayUseTiles({Cpuid, [] { return Machine.saved; },
                           [] {
                             ++Machine.asked;
                             return Machine.permission;
                           }});
}

TEST(TileRegisters, AreUsedWhereProcessorAndSystemGrantThem)
{
  EXPECT_TRUE(MayUseTiles());
  EXPECT_EQ(Machine.asked, 1);
}

TEST(TileRegisters, AreNotUsedWhereTheSystemRefuses)
{
  EXPECT_FALSE(MayUseTiles([](Answers& answers) { answers.permission = false; }));
  EXPECT_EQ(Machine.asked, 1);
}

/// Permission costs memory, and asking for what is not there might do anything.
TEST(TileRegisters, AreNotAskedForWhereSomethingIsMissing)
{
  const std::function<void(Answers&)> changes[] = {
      [](Answers& answers) { answers.leaf0.eax = 0x1d; }, // knows no leaf of the multiplier
      [](Answers& answers) { answers.features.edx = 1u << 22; },
      [](Answers& answers) { answers.features.edx = 1u << 24; },
      [](Answers& answers) { answers.palettes.eax = 0; },
      [](Answers& answers) { answers.palette.ebx = 64 | 4u << 16; },
      [](Answers& answers) { answers.palette.ebx = 32 | 8u << 16; },
      [](Answers& answers) { answers.palette.ecx = 8; },
      [](Answers& answers) { answers.multiplier.ebx = 8 | 64u << 8; },
      [](Answers& answers) { answers.multiplier.ebx = 16 | 32u << 8; },
      [](Answers& answers) { answers.leaf1.ecx = 0; },
      [](Answers& answers) { answers.saved = 0x200e7; },
      [](Answers& answers) { answers.saved = 0x400e7; },
      [](Answers& answers) { answers.saved = 0xe7; }, // a system before Linux 5.16
  };
  for (const auto& change : changes) {
    EXPECT_FALSE(MayUseTiles(change));
    EXPECT_EQ(Machine.asked, 0);
  }
}

TEST(TileRegisters, AnswerTheSameWhicheverThreadAsks)
{
  const bool usable = inr::IsTileKernelUsable();
  bool others[4] = {};
  std::vector<std::thread> threads;
  for (bool& other : others) {
    threads.emplace_back([&other] { other = inr::IsTileKernelUsable(); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const bool other : others) {
    EXPECT_EQ(other, usable);
  }
  EXPECT_TRUE(!usable || inr::MayUseTiles());
}

bool Yes() { return true; }
bool No() { return false; }

class Tiles : public testing::Test
{
protected:
  void SetUp() override
  {
    if (!inr::IsUsable(inr::InferencePrecision::BFloat16, inr::InstructionSet::Avx512)) {
      GTEST_SKIP() << "this processor multiplies no bfloat16 numbers";
    }
  }
  void TearDown() override { imitation::Have(imitation::Defect::None); }
};

TEST_F(Tiles, AreTheFastestForBFloat16)
{
  using inr::InferencePrecision;
  const auto nameOf = [](const char* kernel, InferencePrecision precision, bool (*tiles)()) {
    return inr::ChooseKernels(kernel, precision, tiles).name;
  };
  EXPECT_EQ(nameOf("", InferencePrecision::BFloat16, Yes), "amx bfloat16");
  EXPECT_EQ(nameOf("", InferencePrecision::BFloat16, No), "avx512 bfloat16");
  EXPECT_EQ(nameOf("avx512", InferencePrecision::BFloat16, Yes), "avx512 bfloat16");
  EXPECT_EQ(nameOf("amx", InferencePrecision::BFloat16, Yes), "amx bfloat16");
  EXPECT_EQ(nameOf("", InferencePrecision::Float32, Yes), "avx512");
  EXPECT_EQ(nameOf("amx", InferencePrecision::Float32, Yes), "avx512");
  EXPECT_EQ(nameOf("avx2", InferencePrecision::BFloat16, Yes), "avx2");
}

/// Three products for one pay there only.
TEST_F(Tiles, AreWhatSplitNumbersAreFor)
{
  const auto nameOf = [](const char* kernel, bool (*tiles)()) {
    return inr::ChooseKernels(kernel, inr::InferencePrecision::SplitBFloat16, tiles).name;
  };
  EXPECT_EQ(nameOf("", Yes), "amx split bfloat16");
  EXPECT_EQ(nameOf("amx", Yes), "amx split bfloat16");
  EXPECT_EQ(nameOf("", No), "avx512");
  EXPECT_EQ(nameOf("avx512", Yes), "avx512");
  EXPECT_EQ(nameOf("avx2", Yes), "avx2");
}

TEST(TileKernels, AreRefusedByNameWhereThereAreNone)
{
  for (const auto precision :
       {inr::InferencePrecision::BFloat16, inr::InferencePrecision::Float32}) {
    try {
      inr::ChooseKernels("amx", precision, No);
      FAIL() << "took it";
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::Unsupported);
      EXPECT_NE(std::string(error.what()).find("'amx'"), std::string::npos) << error.what();
    }
  }
}

TEST(TileKernels, AreAskedForBFloat16Only)
{
  EXPECT_NO_THROW(inr::ChooseKernels("", inr::InferencePrecision::Float32,
                                     []() -> bool { throw std::logic_error("asked for tiles"); }));
}

TEST_F(Tiles, AreTriedBeforeTheyAreUsed)
{
  using imitation::Defect;
  EXPECT_TRUE(inr::GiveTheSame(ImitatedKernels(), inr::PairKernels()));
  for (const Defect defect :
       {Defect::LosesUpperHalves, Defect::LosesLastPair, Defect::LosesLastRow,
        Defect::LosesSmallDigits, Defect::ForgetsSums, Defect::SwapsSamples}) {
    imitation::Have(defect);
    EXPECT_FALSE(inr::GiveTheSame(ImitatedKernels(), inr::PairKernels()))
        << static_cast<int>(defect);
  }
}

TEST_F(Tiles, AreUsedWhereTheyMayBeAndWork)
{
  EXPECT_TRUE(inr::IsTileKernelUsable(Yes, ImitatedKernels()));
  EXPECT_FALSE(inr::IsTileKernelUsable(No, ImitatedKernels()));
  imitation::Have(imitation::Defect::SwapsSamples);
  EXPECT_FALSE(inr::IsTileKernelUsable(Yes, ImitatedKernels()));
}

/// The kernels that users get: their instructions one by one, or on a processor that has them.
TEST_F(Tiles, GiveTheSameAsImitatedOnes)
{
  const bool own = imitation::HasTileInstructions();
  if (own && !inr::IsTileKernelUsable()) {
    GTEST_SKIP() << "this processor has tiles that may not be used";
  }
  const imitation::TileTraps traps;
  const long before = imitation::TileTraps::count();
  const std::vector<glm::vec3> positions = RandomPositions(333);
  const auto model = RandomModel(SmallDescription());
  EXPECT_EQ(Evaluate(*inr::MakeEvaluator(model, inr::TileKernels()), positions),
            Evaluate(*inr::MakeEvaluator(model, ImitatedKernels()), positions));
  EXPECT_EQ(Evaluate(*inr::MakeEvaluator(model, inr::SplitTileKernels()), positions),
            Evaluate(*inr::MakeEvaluator(model, ImitatedSplitKernels()), positions));
  EXPECT_TRUE(inr::GiveTheSame(inr::TileKernels(), inr::PairKernels()));
  EXPECT_EQ(imitation::TileTraps::count() > before + 1000, !own);
  EXPECT_FALSE(imitation::IsConfigured());
}

TEST_F(Tiles, ThatDoNotWorkAreNoticedInTheKernelsThatUsersGet)
{
  if (imitation::HasTileInstructions()) {
    GTEST_SKIP() << "this processor has tiles of its own";
  }
  const imitation::TileTraps traps;
  EXPECT_TRUE(inr::IsTileKernelUsable(Yes, inr::TileKernels()));
  imitation::Have(imitation::Defect::LosesUpperHalves);
  EXPECT_FALSE(inr::IsTileKernelUsable(Yes, inr::TileKernels()));
}

/// Points, then a lattice.
void EvaluateBoth(const inr::Description& description)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(description), ImitatedKernels());
  Evaluate(*evaluator, RandomPositions(100));
  EXPECT_FALSE(imitation::IsConfigured());
  const std::vector<float> axes[3] = {{0.1f, 0.2f}, {0.3f}, {0.4f, 0.5f}};
  float values[4];
  evaluator->evaluateGrid(axes, values);
  EXPECT_FALSE(imitation::IsConfigured());
}

TEST_F(Tiles, AreConfiguredForABatchOnly)
{
  const int before = imitation::Configurations();
  EvaluateBoth(SmallDescription());
  EXPECT_EQ(imitation::Configurations(), before + 2);
}

TEST_F(Tiles, AreNotConfiguredWhereTheLibraryIsCalled)
{
  inr::Description description = SmallDescription();
  description.network.activation = inr::Activation::Tanh; // 2 layers of a tile each
  const int before = imitation::Configurations();
  EvaluateBoth(description);
  const int strips = (100 + 63) / 64 + 1; // both layers of the lattice share one
  EXPECT_EQ(imitation::Configurations(), before + 2 + strips * 2);
}

constexpr int Rows = 19;
constexpr int Columns = 35;

float InMatrix(const std::vector<float>& weights, int row, int column)
{
  const bool inside = row < Rows && column < Columns;
  const std::int64_t place = std::int64_t{row} * Columns + column;
  return inside ? weights[static_cast<std::size_t>(place)] : 0.0f;
}

/// Of a layer of Rows by Columns, a part of the numbers in a tile of 16 rows and 32 columns; tiles
/// have that many parts.
float InTile(const inr::PackedNetwork& network, int row, int column, int part = 0, int parts = 1)
{
  const int tile = (row / 16 * 2 + column / 32) * parts + part;
  const std::uint32_t pair =
      network.view().layers[0].pairs[tile * 256 + row % 16 * 16 + column % 32 / 2];
  const std::uint32_t bits = column % 2 == 0 ? pair << 16 : pair & 0xffff0000u;
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

inr::PackedNetwork Packed(const std::vector<float>& weights, inr::WeightLayout layout)
{
  const inr::LayerView layer{weights.data(), Rows, Columns, nullptr, nullptr};
  inr::ModelView model{};
  model.layers = &layer;
  model.layerCount = 1;
  return inr::PackedNetwork(model, layout);
}

TEST(TileKernels, HaveWeightsInTiles)
{
  std::vector<float> weights(Rows * Columns);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = static_cast<float>(k % 251 + 1); // all are bfloat16 numbers
  }
  const inr::PackedNetwork network = Packed(weights, inr::WeightLayout::Tiles);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(network.view().layers[0].pairs) % 64, 0u);
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 64; ++column) {
      const float weight = InMatrix(weights, row, column);
      ASSERT_EQ(InTile(network, row, column), weight) << row << " " << column;
    }
  }
}

TEST(TileKernels, HaveWeightsInTilesOfTwoParts)
{
  std::vector<float> weights(Rows * Columns);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = (inr::RandomUnit(1, k) - 0.5f) * 8;
  }
  const inr::PackedNetwork network = Packed(weights, inr::WeightLayout::SplitTiles);
  int rests = 0;
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 64; ++column) {
      const float weight = InMatrix(weights, row, column);
      const float rounded = InTile(network, row, column, 0, 2);
      const float rest = InTile(network, row, column, 1, 2);
      ASSERT_LE(std::abs(rounded - weight), 0x1p-8f * std::abs(weight)) << row << " " << column;
      ASSERT_LE(std::abs(rounded + rest - weight), 0x1p-16f * std::abs(weight));
      rests += rest != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(rests, Rows * Columns * 9 / 10);
}

} // namespace test::tiles

// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels at bricks against Core's and against the kernels at points.
#include "Core/Cache/BrickStore.h"
#include "Testing/CUDA/Places.h"
#include "Testing/Core/Cache/WholeBricks.h"
#include "Testing/Core/RandomModel.h"

namespace test::bricks {

/// Normalised outputs of this one are spread over [0, 1], and some lie beyond.
std::shared_ptr<inr::Model> BrickModel(float perLevelScale = 2.0f, int features = 4)
{
  inr::Description description = SmallDescription();
  description.grid.perLevelScale = perLevelScale;
  description.grid.features = features;
  description.network.outputActivation = inr::Activation::Squareplus;
  auto model = RandomModel(description);
  for (float& parameter : model->parameters) {
    parameter = inr::cuda::ToFloat(inr::cuda::ToHalf(parameter * 0.5f));
  }
  return model;
}

constexpr float Unwritten = -7; ///< no normalised value

/// All bricks of a level, in any order.
std::vector<inr::BrickKey> BricksOf(const inr::Hierarchy& levels, int level)
{
  std::vector<inr::BrickKey> keys;
  const glm::i64vec3 count = levels.bricks(level);
  for (std::int64_t k = count.x * count.y * count.z - 1; k >= 0; --k) {
    keys.push_back(
        inr::KeyOf({level, {k % count.x, k / count.x % count.y, k / (count.x * count.y)}}));
  }
  return keys;
}

std::vector<float> Infer(const inr::BrickSource& source, const std::vector<inr::BrickKey>& keys)
{
  const auto voxels = static_cast<std::size_t>(source.hierarchy().voxelsPerBrick());
  std::vector<float> values(keys.size() * voxels, Unwritten);
  source.infer(keys.data(), static_cast<std::int64_t>(keys.size()), values.data(), inr::Arena(1));
  return values;
}

class Bricks : public InEveryPlace
{
protected:
  static double tolerance() { return GetParam().half() ? 1e-3 : 1e-5; }
};

/// All levels, with rims, axes that are thinner than a brick, and bricks of several levels at once.
TEST_P(Bricks, AreThoseOfCore)
{
  const glm::i64vec3 sizes[2] = {{37, 22, 9}, {50, 1, 21}};
  // Coarse voxels as means of 2 x 2 x 2 points, or as their centres.
  for (const auto& [dims, resolution] :
       {std::pair(sizes[0], 0), std::pair(sizes[1], 0), std::pair(sizes[0], 12)}) {
    const inr::Hierarchy levels(dims, 9, glm::i64vec3(resolution));
    const auto model = BrickModel();
    const auto core = inr::MakeBrickSource(inr::MakeEvaluator(model), levels);
    std::vector<inr::BrickKey> keys;
    for (int level = 0; level < levels.levels(); ++level) {
      const std::vector<inr::BrickKey> some = BricksOf(levels, level);
      keys.insert(keys.end(), some.begin(), some.end());
    }
    const std::vector<float> expected = Infer(*core, keys);
    const auto range = std::minmax_element(expected.begin(), expected.end());
    ASSERT_GT(*range.second - *range.first, 0.3f);
    EXPECT_LT(RelativeError(Infer(*bricks(model, levels), keys), expected), tolerance());
  }
}

/// Bricks where blocks work on several cubes of samples, whose grid is coarser, as fine, and much
/// finer than the voxels.
TEST_P(Bricks, OfAnyGridAreThoseOfCore)
{
  const inr::Hierarchy levels({60, 50, 30}, 20);
  for (const float scale : {1.2f, 2.0f, 6.0f}) {
    for (const int features : {1, 2, 4, 8}) {
      const auto model = BrickModel(scale, features);
      const auto core = inr::MakeBrickSource(inr::MakeEvaluator(model), levels);
      const std::vector<inr::BrickKey> keys = {inr::KeyOf({0, {1, 0, 0}})};
      EXPECT_LT(RelativeError(Infer(*bricks(model, levels), keys), Infer(*core, keys)), tolerance())
          << scale << " " << features;
    }
  }
}

/// Sharing the lattice saves loads and changes no bit, nor does what there is no room to share.
TEST_P(Bricks, AreThePointsToTheLastBit)
{
  const inr::Hierarchy levels({64, 64, 64}, 20);
  const auto model = BrickModel();
  const inr::BrickId id{0, {1, 2, 0}};
  std::vector<glm::vec3> positions;
  for (std::int64_t k = 0; k < levels.voxelsPerBrick(); ++k) {
    const glm::i64vec3 voxel =
        glm::min(levels.firstVoxel(id) + glm::i64vec3(k % 20, k / 20 % 20, k / 400),
                 levels.size(0) - std::int64_t{1});
    positions.emplace_back((glm::dvec3(voxel) + 0.5) / 64.0);
  }
  std::vector<float> expected(positions.size());
  evaluator(model)->evaluate(positions.data(), static_cast<std::int64_t>(expected.size()),
                             expected.data());
  for (float& value : expected) {
    value = inr::NormalisedOutput(value);
  }
  EXPECT_EQ(Infer(*bricks(model, levels), {inr::KeyOf(id)}), expected);
}

TEST_P(Bricks, LayersAreThoseOfTheWhole)
{
  const inr::Hierarchy levels({40, 30, 17}, 12);
  const auto source = bricks(BrickModel(), levels);
  for (int level = 0; level < 2; ++level) {
    const inr::BrickKey key = inr::KeyOf({level, levels.bricks(level) - std::int64_t{1}});
    const std::vector<float> whole = Infer(*source, {key});
    const std::size_t size = whole.size() / static_cast<std::size_t>(levels.brickDims().z);
    for (std::int64_t z = 0; z < levels.brickDims().z; ++z) {
      std::vector<float> layer(size, Unwritten);
      source->inferLayer(key, z, layer.data());
      EXPECT_TRUE(std::equal(layer.begin(), layer.end(),
                             whole.begin() + z * static_cast<std::ptrdiff_t>(size)))
          << level << " " << z;
    }
  }
}

TEST_P(Bricks, OrderAndRoomChangeNoBit)
{
  if (GetParam().place == Place::Gpu) {
    GTEST_SKIP() << "the order of threads is the GPU's own";
  }
  const inr::Hierarchy levels({40, 30, 17}, 12);
  const auto model = BrickModel();
  for (int level = 0; level < 2; ++level) {
    const std::vector<inr::BrickKey> keys = BricksOf(levels, level);
    const std::vector<float> expected = Infer(*bricks(model, levels), keys);
    for (const std::int64_t shared : {1 << 10, 20 << 10, 227 << 10}) {
      EXPECT_EQ(Infer(*bricks(model, levels, {2, true, shared}), keys), expected) << shared;
    }
  }
}

TEST_P(Bricks, CoreComputesWhatOverflows)
{
  const inr::Hierarchy levels({20, 20, 20}, 12);
  auto model = BrickModel();
  for (float& parameter : model->parameters) {
    parameter *= GetParam().half() ? 512.0f : 1e15f;
  }
  const auto core = inr::MakeBrickSource(inr::MakeEvaluator(model), levels);
  for (int level = 0; level < 2; ++level) {
    const std::vector<inr::BrickKey> keys = {inr::KeyOf({level, {0, 0, 0}})};
    EXPECT_LT(RelativeError(Infer(*bricks(model, levels, Overflowing()), keys), Infer(*core, keys)),
              tolerance());
  }
}

/// The cache that the renderer on the CPU draws from: by who waits, and by the loader.
TEST_P(Bricks, FillACache)
{
  const inr::Hierarchy levels({40, 30, 17}, 12);
  const auto source = bricks(BrickModel(), levels);
  const std::vector<inr::BrickKey> keys = BricksOf(levels, 0);
  const std::vector<float> expected = Infer(*source, keys);
  const inr::Arena arena(2);
  for (const bool background : {false, true}) {
    inr::BrickStore store(std::make_shared<inr::CacheBudget>(), source,
                          inr::CachePrecision::Float32, 8 << 20, background, 2);
    const inr::BrickStore::Call call(store, arena);
    store.beginFrame();
    for (int round = 0; round < 100 && store.mapped() <= static_cast<std::int64_t>(keys.size());
         ++round) {
      store.loadFor(10, Whole(keys), arena);
    }
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const std::int32_t slot = store.cache().find(keys[k]);
      ASSERT_NE(slot, inr::PageTable::Unmapped) << k;
      const auto* const voxels = static_cast<const float*>(store.cache().view(slot).voxels);
      const auto size = static_cast<std::size_t>(levels.voxelsPerBrick());
      EXPECT_TRUE(std::equal(voxels, voxels + size, &expected[k * size])) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, Bricks, testing::ValuesIn(AllSettings()), NameOf);

} // namespace test::bricks

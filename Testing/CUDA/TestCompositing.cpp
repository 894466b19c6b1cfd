// SPDX-License-Identifier: BSD-3-Clause
//
// Samples whose light is added up group by group, against one after another.
#include "CUDA/Render/Kernels/CompositeSamples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace test::compositing {

using inr::cuda::AlikeRow;
using inr::cuda::CompositedRow;
using inr::cuda::GatheredLight;
using inr::cuda::OneBrick;
using inr::cuda::SampledBrick;
using inr::cuda::TwoBricks;

constexpr int Edge = 6; ///< voxels
constexpr int Length = 1;
constexpr int Most = 32; ///< of two bricks

/// Two bricks of 16 bits in which values rise along x, faster in the second one, and a table of
/// steps for samples of two lengths.
class Compositing : public testing::Test
{
protected:
  Compositing()
  {
    for (std::vector<std::uint16_t>& brick : this->Voxels) {
      const int rise = &brick == this->Voxels ? 9000 : 11000;
      for (int k = 0; k < Edge * Edge * Edge; ++k) {
        brick.push_back(static_cast<std::uint16_t>(k % Edge * rise + k));
      }
    }
    for (int k = 0; k < 2 * Rows; ++k) {
      const float at = static_cast<float>(k % Rows) / Rows;
      this->Entries.push_back({at, 1 - at, 0.5f, 0.1f + 0.5f * at});
    }
    this->Cache.hierarchy = inr::HierarchyView(nullptr, 1, glm::ivec3(Edge));
    this->Cache.precision = inr::CachePrecision::Bits16;
    this->Cache.rowStride = Edge;
    this->Cache.layerStride = Edge * Edge;
    this->Scene.steps = {&this->Entries.data()->x, Rows, Rows - 4, 2, 0.01f};
  }

  SampledBrick brick(int number) const
  {
    SampledBrick brick{{}, 0.25f, {0.1f, 0.9f}};
    brick.path.voxels = this->Voxels[number].data();
    brick.path.quantum = 1.0f / 65535;
    for (int axis = 0; axis < 3; ++axis) {
      brick.path.origin[axis] = 0.5f;
      brick.path.direction[axis] = axis == 0 ? 0.07f : 0.03f;
      brick.path.last[axis] = Edge - 1;
    }
    return brick;
  }

  /// As if there were no groups.
  template <class Bricks>
  void addSingly(const AlikeRow& row, const Bricks& bricks, CompositedRow& sum) const
  {
    for (int k = 0; k < row.count && !sum.light.isOpaque(); ++k) {
      const SampledBrick& brick = bricks.brick(k);
      const float along = (brick.start + static_cast<float>(k) * row.spacing) + row.offset;
      const float found = inr::cuda::ValueOn(this->Cache, brick.path, along);
      float value = found;
      inr::ClampToRange(brick.range, value);
      const glm::vec4 color = inr::cuda::FindColor(this->Scene.steps, row.length, value)
                                  .color(inr::UnitsOf(this->Scene.steps, row.length));
      sum.light.add(color, color.w);
      if (!sum.halfOpaque && sum.light.isHalfOpaque()) {
        sum.halfOpaque = true;
        sum.halfOpaqueAt = k;
      }
      sum.clamped += std::abs(found - value) > inr::RoundingOfStorage ? 1 : 0;
      ++sum.taken[bricks.numberOf(k)];
      sum.seen[bricks.numberOf(k)] += sum.light.through();
    }
  }

  /// What a ray has before: so that it becomes opaque at one sample or another.
  static CompositedRow after(int samples)
  {
    GatheredLight light;
    for (int k = 0; k < samples; ++k) {
      light.add({0.5f, 0.5f, 0.5f, 0}, 0.31f);
    }
    return {light, light.isHalfOpaque()};
  }

  template <class Bricks> void compare(const Bricks& bricks) const
  {
    bool ended[4] = {}; // whether a ray ended at each place of a group
    for (int before = 0; before < 19; ++before) {
      for (int count = 0; count <= Most; ++count) {
        SCOPED_TRACE(std::to_string(before) + " " + std::to_string(count));
        const AlikeRow row{count, 2.0f, 0.6f, Length};
        CompositedRow singly = after(before);
        this->addSingly(row, bricks, singly);
        CompositedRow sum = after(before);
        inr::cuda::RowCompositor<Bricks>(this->Cache, this->Scene, row, bricks).add(sum);
        ASSERT_EQ(sum.light.sum(), singly.light.sum());
        ASSERT_EQ(sum.light.through(), singly.light.through());
        ASSERT_EQ(sum.halfOpaque, singly.halfOpaque);
        ASSERT_EQ(sum.halfOpaqueAt, singly.halfOpaqueAt);
        ASSERT_EQ(sum.clamped, singly.clamped);
        for (int k = 0; k < 2; ++k) {
          ASSERT_EQ(sum.taken[k], singly.taken[k]);
          ASSERT_EQ(sum.seen[k], singly.seen[k]);
        }
        ended[sum.count() % 4] = ended[sum.count() % 4] || sum.count() < count;
      }
    }
    for (const bool one : ended) {
      EXPECT_TRUE(one);
    }
  }

private:
  static constexpr int Rows = 32;

  std::vector<std::uint16_t> Voxels[2];
  std::vector<glm::vec4> Entries;
  inr::cuda::CacheView Cache{};
  inr::cuda::RenderScene Scene{};
};

TEST_F(Compositing, EndsAtTheSampleThatMakesARayOpaque) { this->compare(OneBrick{this->brick(0)}); }

TEST_F(Compositing, TakesEachSampleFromItsBrick)
{
  for (const std::uint32_t second : {0x0u, 0xf0f0c396u, ~0x0u}) {
    this->compare(TwoBricks{{this->brick(0), this->brick(1)}, second});
  }
}

/// However many there are, and however faint.
TEST(GatheredLight, LosesNothing)
{
  constexpr int samples = 1 << 18;
  constexpr float opacity = 0x1p-26f; // which 1 in float does not feel
  GatheredLight light;
  for (int k = 0; k < samples; ++k) {
    light.add(glm::vec4(1.0f), opacity);
  }
  const double through = std::pow(1.0 - opacity, samples);
  EXPECT_NEAR(light.sum().w, through, 1e-8);
  EXPECT_NEAR(light.sum().x, 1 - through, 1e-8);
}

} // namespace test::compositing

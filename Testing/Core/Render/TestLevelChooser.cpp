// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LevelChooser.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace test::level_chooser {

/// Waves in the first 48 slices, nothing in 16, and dark smoke in 48 that hides what it hides from
/// where its opacity jumps on; seen through the smoke.
class SmokeBeforeWaves
{
public:
  /// Whether there is any.
  explicit SmokeBeforeWaves(bool smoke)
      : Cells(CellsOf(field, Dims), Dims, inr::Arena(1)),
        Colors(colors(smoke ? Opacity : 0.0f), VolumeOf(Dims)),
        Chooser(std::make_shared<FieldEvaluator>(field), Dims, Cells, 4,
                inr::LineKernelFor(inr::ChooseInstructionSet({})))
  {
    this->Cells.update(this->Colors, inr::Arena(1));
  }

  /// Powers of the cells of the waves when so much of a channel is made use of, 1 = white.
  std::vector<int> powers(double tolerance)
  {
    inr::Frame frame;
    frame.width = frame.height = 32;
    frame.sampleDistance = 0.5;
    frame.clipToWorld =
        glm::inverse(glm::ortho(-0.5, 31.5, -0.5, 31.5, -200.0, 200.0) *
                     glm::lookAt(glm::dvec3(0, 0, 1), glm::dvec3(0), glm::dvec3(0, 1, 0)));
    const inr::RayGeometry geometry(frame, Dims);
    const double wished = 255 * tolerance / inr::LevelChooser::MadeUseOf;
    EXPECT_TRUE(this->Chooser.choose({wished, Step, Step}, {geometry, 32, 32}, this->Cells,
                                     this->Colors.lookup(), inr::Arena(1), inr::WorkLimit(0, false),
                                     {}));
    std::vector<int> powers;
    for (int cell = 0; cell < 2 * 2 * 3; ++cell) {
      powers.push_back(this->Chooser.sampling()[cell].power);
    }
    return powers;
  }

  /// Of the first cell, as last chosen.
  int level() const { return this->Chooser.sampling()[0].level; }

  /// Light that passes two cells of 16 slices of it: the third has no smoke on its one side.
  static double light() { return std::pow(1.0 - Opacity, 32); }

private:
  static constexpr glm::i64vec3 Dims{32, 32, 112};
  static constexpr double Step = 0.5;
  static constexpr float Opacity = 0.0214279f; ///< light() is a half, as limits are 2^(k/2) apart

  static float field(const glm::vec3& u)
  {
    const float z = 112 * u.z;
    return z < 48 ? 0.22f + 0.15f * std::sin(0.3f * z) * std::sin(9 * u.x + 4 * u.y)
                  : (z < 64 ? 0.0f : 0.9f);
  }

  static inr::TransferFunction colors(float smoke)
  {
    inr::TransferFunction function;
    for (int k = 0; k < 256; ++k) {
      const float x = static_cast<float>(k) / 255;
      function.table.push_back(x < 0.5f ? glm::vec4(1, x, 0.5f, 0.04f * x)
                                        : glm::vec4(0, 0, 0, x < 0.7f ? 0.0f : smoke));
    }
    return function;
  }

  inr::Majorants Cells;
  inr::ColorTable Colors;
  inr::LevelChooser Chooser;
};

/// What smoke leaves of the light counts, no more and no less.
TEST(LevelChooser, AllowsMoreBehindSmokeByWhatItHides)
{
  SmokeBeforeWaves clear(false);
  SmokeBeforeWaves hidden(true);
  int alike = 0;
  for (int k = 0; k < 24; ++k) {
    const double tolerance = 1e-4 * std::exp2(0.4 * k);
    const std::vector<int> chosen = clear.powers(tolerance);
    const std::vector<int> behind = hidden.powers(tolerance * SmokeBeforeWaves::light());
    // No step may add more than the tolerance to a pixel, as if nothing were in front of it.
    for (std::size_t cell = 0; cell < chosen.size(); ++cell) {
      EXPECT_LE(behind[cell], chosen[cell]) << tolerance << " " << cell;
    }
    alike += behind == chosen ? 1 : 0;
  }
  EXPECT_GE(alike, 22);
  EXPECT_EQ(clear.powers(1e-4), std::vector<int>(12, 0));
  EXPECT_EQ(clear.powers(0.1), std::vector<int>({3, 3, 3, 3, 3, 3, 3, 3, 2, 2, 2, 2}));
  clear.powers(0.6);
  EXPECT_EQ(clear.level(), 3); // rather than every eighth sample of level 0
}

} // namespace test::level_chooser

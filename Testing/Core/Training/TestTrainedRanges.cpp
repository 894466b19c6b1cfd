// SPDX-License-Identifier: BSD-3-Clause
//
// The ranges that training gives a model hold for what a renderer then samples, between the voxels,
// too.
#include "Core/Model/ScaledModel.h"
#include "Core/Random.h"
#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

namespace test::trained_ranges {

/// Waves with noise that no such network learns: it goes up and down between the voxels.
Field<float> NoisyWaves()
{
  Field<float> field = WaveField<float>({60, 52, 45}, inr::ScalarType::Float32, 0, 1);
  std::uint64_t k = 0;
  for (float& value : field.values) {
    value += 0.2f * inr::RandomUnit(1, k++);
  }
  return field;
}

inr::ModelPointer TrainedModel()
{
  inr::TrainingOptions options = Steps(300);
  options.description = SmallDescription();
  options.macroCellSize = 4;
  return inr::TrainModel(NoisyWaves().data(), {}, options);
}

/// Of a view of all of it, nearly transparent: the part of the samples that were moved into their
/// cells' ranges.
double ClampedPart(const inr::ModelPointer& model, bool cached, double levelOfDetailScale)
{
  const glm::dvec3 size(model->volume.dims);
  const double reach = glm::length(size);
  inr::Frame frame;
  frame.width = frame.height = 64;
  frame.clipToWorld = glm::inverse(
      glm::perspective(0.6, 1.0, 0.2 * reach, 5 * reach) *
      glm::lookAt(size * glm::dvec3(1.9, 1.4, 2.3), 0.5 * size, glm::dvec3(0.1, 1, 0)));
  frame.levelOfDetailScale = levelOfDetailScale;
  inr::RendererOptions options;
  options.threads = 2;
  options.cached = cached;
  inr::Renderer renderer(model, options);
  inr::TransferFunction function;
  function.table = {glm::vec4(1, 1, 1, 0.002f), glm::vec4(1, 1, 1, 0.004f)};
  renderer.setTransferFunction(function);
  inr::Image image;
  const inr::FrameStatistics statistics = renderer.render(frame, image);
  EXPECT_GT(statistics.samples, 20000);
  return static_cast<double>(statistics.clamped) / static_cast<double>(statistics.samples);
}

TEST(TrainedRanges, HoldForAllButOneInAThousandSamples)
{
  const inr::ModelPointer model = TrainedModel();
  for (const double factor : {0.5, 1.0, 4.0}) {
    const inr::ModelPointer scaled = inr::ScaledModel(model, factor);
    for (const bool cached : {true, false}) {
      for (const double scale : {0.0, 3.0}) {
        EXPECT_LT(ClampedPart(scaled, cached, scale), 1e-3)
            << "factor " << factor << ", cached " << cached << ", scale " << scale;
      }
    }
  }
}

TEST(TrainedRanges, WouldNotHoldIfTheyWereHalfAsWide)
{
  const auto model = std::make_shared<inr::Model>(*TrainedModel());
  for (inr::ValueRange& range : model->macroCells.ranges) {
    const float quarter = (range.high - range.low) / 4;
    range = {range.low + quarter, range.high - quarter};
  }
  EXPECT_GT(ClampedPart(model, true, 0), 0.05);
  EXPECT_GT(ClampedPart(model, false, 0), 0.05);
}

} // namespace test::trained_ranges

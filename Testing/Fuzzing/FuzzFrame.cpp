// SPDX-License-Identifier: BSD-3-Clause
//
// Bytes of a scene, then of a model -> decoded voxels and one small picture: finite numbers, or
// inr::Error and nothing else.
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Render/Renderer.h"
#include "Testing/Fuzzing/FuzzScene.h"
#include "Testing/Fuzzing/Target.h"

#include <chrono>
#include <cmath>

namespace {

constexpr std::uint64_t MostParameters = 1 << 17;
constexpr std::int64_t MostWeights = 1 << 15;

bool IsQuick(const inr::Model& model)
{
  const inr::Layout layout(model.description);
  std::int64_t weights = 0;
  for (const inr::LayerShape& layer : layout.layers) {
    weights += static_cast<std::int64_t>(layer.rows) * layer.columns;
  }
  return layout.parameterCount <= MostParameters && weights <= MostWeights;
}

/// A block of voxels somewhere in the volume.
void Decode(const inr::ModelPointer& model, SceneBytes& bytes)
{
  const glm::i64vec3& dims = model->volume.dims;
  const glm::i64vec3 size = glm::min(dims, glm::i64vec3(4));
  glm::i64vec3 begin;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] =
        static_cast<std::int64_t>(bytes.unit() * static_cast<double>(dims[axis] - size[axis]));
  }
  const auto evaluator = inr::MakeEvaluator(model);
  std::vector<float> values(static_cast<std::size_t>(size.x * size.y * size.z));
  const inr::Arena arena(1);
  inr::EvaluateLattice(*evaluator, arena, inr::VoxelLattice(dims, begin, size), values.data());
  for (const float value : values) {
    const float normalised = inr::NormalisedOutput(value);
    INR_REQUIRE(normalised >= 0.0f && normalised <= 1.0f);
    const double data = inr::ValueOf(model->volume, normalised);
    INR_REQUIRE(data >= model->volume.low && data <= model->volume.high);
  }
}

void RequireFinite(const inr::Image& image)
{
  for (const float value : image.pixels) {
    INR_REQUIRE(std::isfinite(value));
  }
}

void Draw(const inr::ModelPointer& model, SceneBytes& bytes)
{
  using Clock = std::chrono::steady_clock;
  const FuzzScene scene = MakeFuzzScene(model->volume, bytes);
  if (!scene.quick) {
    return;
  }
  inr::Renderer renderer(model, scene.options);
  renderer.setTransferFunction(scene.colors);
  const Clock::time_point begin = Clock::now();
  const auto keepGoing = [&] { return Clock::now() - begin < std::chrono::seconds(2); };
  inr::Image rgba;
  inr::Image depth;
  inr::Image samples;
  renderer.render(scene.frame, rgba, &depth, keepGoing, &samples);
  RequireFinite(rgba);
  RequireFinite(depth);
  RequireFinite(samples);
  for (std::size_t alpha = 3; alpha < rgba.pixels.size(); alpha += 4) {
    INR_REQUIRE(rgba.pixels[alpha] >= 0.0f && rgba.pixels[alpha] <= 1.0001f);
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  if (size < SceneSize) {
    return 0;
  }
  SceneBytes bytes(data);
  try {
    const inr::ModelPointer model = inr::ModelFromBytes(
        std::string(reinterpret_cast<const char*>(data) + SceneSize, size - SceneSize));
    if (!IsQuick(*model)) {
      return 0;
    }
    Decode(model, bytes);
    Draw(model, bytes);
  } catch (const inr::Error& error) {
    INR_REQUIRE(error.what()[0] != '\0');
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
//
// Models full of numbers that float32 arithmetic is bad at, in every kernel, at scattered points,
// on lattices and in bricks, against an evaluation in long double.
#include "Core/Cache/BrickSource.h"
#include "Testing/Core/Inference/LongDoubleTruth.h"
#include "Testing/Core/Inference/RoundingKernels.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <functional>

namespace test::bad_numbers {

constexpr float Infinity = std::numeric_limits<float>::infinity();

/// What a model's parameters are like.
struct Numbers
{
  const char* name;
  /// From a number in [-1, 1) and another in [0, 1).
  std::function<float(float, float)> weight;
  std::function<float(float, float)> feature;
  /// Share of the samples that must be known well, lest the comparison show little.
  double known;
};

std::ostream& operator<<(std::ostream& out, const Numbers& numbers) { return out << numbers.name; }

std::function<float(float, float)> Uniform(float scale)
{
  return [scale](float signedUnit, float) { return scale * signedUnit; };
}

std::function<float(float, float)> Either(float magnitude)
{
  return [magnitude](float signedUnit, float) { return std::copysign(magnitude, signedUnit); };
}

std::function<float(float, float)> Decades(float lowest, float highest)
{
  return [lowest, highest](float signedUnit, float unit) {
    return std::copysign(std::pow(10.0f, lowest + (highest - lowest) * unit), signedUnit);
  };
}

float SignedZeros(float signedUnit, float unit)
{
  return unit < 0.5f ? signedUnit : std::copysign(0.0f, signedUnit);
}

const Numbers AllNumbers[] = {
    {"ordinary", Uniform(1), Uniform(1), 0.6},
    {"denormal_features", Uniform(1), Uniform(1e-40f), 0.8},
    {"denormal_weights", Uniform(1e-40f), Uniform(1), 0.9},
    {"denormal_features_huge_weights", Uniform(1e38f), Uniform(1e-40f), 0.2},
    {"huge_features_tiny_weights", Uniform(1e-38f), Uniform(1e38f), 0.9},
    {"limits_of_half", Either(65504), Either(65504), 0.2},
    {"near_1e38", Uniform(1e38f), Uniform(1e38f), 0.2},
    {"largest_floats", Either(FLT_MAX), Either(FLT_MAX), 0.2},
    {"many_magnitudes", Decades(-5, 3), Decades(-38, 4), 0.25},
    {"signed_zeros", SignedZeros, SignedZeros, 0.7},
};

constexpr inr::Activation Activations[] = {
    inr::Activation::None,        inr::Activation::ReLU,     inr::Activation::LeakyReLU,
    inr::Activation::Exponential, inr::Activation::Sigmoid,  inr::Activation::Sine,
    inr::Activation::Squareplus,  inr::Activation::Softplus, inr::Activation::Tanh};

/// Description number k of a sweep in which every choice meets every other.
inr::Description DescriptionOf(std::size_t k)
{
  constexpr int layers[] = {0, 1, 2, 5};
  constexpr inr::GridType types[] = {inr::GridType::Hash, inr::GridType::Dense,
                                     inr::GridType::Tiled};
  constexpr inr::GridInterpolation interpolations[] = {inr::GridInterpolation::Linear,
                                                       inr::GridInterpolation::Smoothstep,
                                                       inr::GridInterpolation::Nearest};
  constexpr inr::HashFunction hashes[] = {inr::HashFunction::CoherentPrime,
                                          inr::HashFunction::Prime,
                                          inr::HashFunction::ReversedPrime, inr::HashFunction::Rng};
  inr::Description description;
  description.grid.levels = 3;
  description.grid.log2HashmapSize = 7;
  description.grid.baseResolution = 4;
  description.grid.perLevelScale = 1.7f;
  description.network.activation = Activations[k % 9];
  description.network.hiddenLayers = layers[k / 9 % 4];
  description.network.outputActivation = Activations[(k / 9 + 4 * k) % 9];
  description.network.neurons = k % 2 == 0 ? 16 : 19;
  description.grid.features = 1 << (k / 3 + k) % 4;
  description.grid.type = types[(k / 9 + k) % 3];
  description.grid.interpolation = interpolations[(k / 36 + k / 4) % 3];
  description.grid.hash = hashes[k / 5 % 4];
  return description;
}
constexpr std::size_t Descriptions = 108;

inr::ModelPointer MakeModel(const Numbers& numbers, std::size_t k)
{
  auto model = RandomModel(DescriptionOf(k), k);
  const std::uint64_t features = inr::Layout(model->description).gridOffset;
  for (std::size_t p = 0; p < model->parameters.size(); ++p) {
    const auto& kind = p < features ? numbers.weight : numbers.feature;
    model->parameters[p] = kind(model->parameters[p], inr::RandomUnit(k + 1000, p));
  }
  return model;
}

/// Numbers between 0 and 1 among which are the ends, cell faces of a grid and what lies beside
/// them.
std::vector<float> Coordinates(const inr::Layout& layout, std::size_t random, std::uint64_t seed)
{
  std::vector<float> all = {0.0f, 1.0f, 1e-40f, 1.0f - 0x1p-24f};
  for (const inr::GridLevel& level : layout.levels) {
    const float face = (std::floor(level.scale / 2) + 0.5f) / level.scale;
    all.insert(all.end(), {face, std::nextafter(face, 0.0f), std::nextafter(face, 1.0f)});
  }
  for (std::size_t k = 0; k < random; ++k) {
    all.push_back(inr::RandomUnit(seed, k));
  }
  return all;
}

std::vector<glm::vec3> Positions(const inr::Layout& layout)
{
  std::vector<float> coordinates = Coordinates(layout, 12, 5);
  coordinates.insert(coordinates.end(), {NAN, Infinity, -Infinity, -0.0f, -1.0f, 2.0f, 1e38f});
  std::vector<glm::vec3> positions = RandomPositions(40);
  for (std::uint64_t k = 0; k < 60; ++k) {
    glm::vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t bits = inr::RandomBits(9, 3 * k + static_cast<std::uint64_t>(axis));
      position[axis] = coordinates[bits % coordinates.size()];
    }
    positions.push_back(position);
  }
  return positions;
}

/// Whether rounding could move a position into another cell, which only Nearest would show.
bool OnAFace(const inr::Model& model, const glm::vec3& position)
{
  if (model.description.grid.interpolation != inr::GridInterpolation::Nearest) {
    return false;
  }
  for (const inr::GridLevel& level : inr::Layout(model.description).levels) {
    for (int axis = 0; axis < 3; ++axis) {
      const double u = position[axis] > 0 ? std::min(position[axis], 1.0f) : 0.0f;
      const double face = u * level.scale + 0.5;
      if (std::abs(face - std::round(face)) < 1e-5) {
        return true;
      }
    }
  }
  return false;
}

/// Points of a model with their true values.
struct Truth
{
  Truth(const inr::Model& model, const std::vector<glm::vec3>& points,
        const RoundedProducts& products = {})
  {
    const LongDoubleTruth truth(model, products);
    for (const glm::vec3& point : points) {
      this->Values.push_back(truth(point));
      this->Usable.push_back(!OnAFace(model, point));
    }
  }

  /// Fails unless `values` are what this says; both are clamped to [low, high].
  void expect(const std::vector<float>& values, float low, float high, const std::string& who) const
  {
    for (std::size_t k = 0; k < values.size(); ++k) {
      ASSERT_TRUE(std::isfinite(values[k])) << who << " at " << k;
      const Bounded& truth = this->Values[k];
      const long double expected =
          std::clamp<long double>(truth.value, static_cast<long double>(low), high);
      const long double error = truth.error + 0x1p-23L * std::abs(expected);
      if (this->Usable[k]) {
        ASSERT_LE(std::abs(values[k] - expected), error)
            << who << " at " << k << ": " << values[k] << " is not " << expected << " +- " << error;
      }
    }
  }

  /// Samples with an error bound below 1 %, or below a 16-bit step of normalised values.
  std::size_t wellKnown() const
  {
    return static_cast<std::size_t>(
        std::count_if(this->Values.begin(), this->Values.end(), [](const Bounded& b) {
          return b.error <= 0.01L * std::abs(b.value) || b.error <= 1.0L / 65536;
        }));
  }

  std::vector<Bounded> Values;
  std::vector<bool> Usable;
};

std::vector<glm::vec3> PointsOf(const std::vector<float> (&axes)[3])
{
  std::vector<glm::vec3> points;
  for (const float z : axes[2]) {
    for (const float y : axes[1]) {
      for (const float x : axes[0]) {
        points.emplace_back(x, y, z);
      }
    }
  }
  return points;
}

class BadNumbers : public testing::TestWithParam<Numbers>
{
protected:
  /// Calls `check(model, name)` for every description.
  static void
  forEachModel(const std::function<void(const inr::ModelPointer&, const std::string& name)>& check)
  {
    for (std::size_t k = 0; k < Descriptions && !HasFatalFailure(); ++k) {
      check(MakeModel(GetParam(), k), "model " + std::to_string(k) + " with ");
    }
  }
};

TEST_P(BadNumbers, AreTheSameAtPointsInEveryKernel)
{
  std::size_t known = 0;
  std::size_t all = 0;
  forEachModel([&](const inr::ModelPointer& model, const std::string& name) {
    const std::vector<glm::vec3> points = Positions(inr::Layout(model->description));
    const Truth truth(*model, points);
    known += truth.wellKnown();
    all += points.size();
    for (const std::string& kernel : UsableKernels()) {
      std::vector<float> values(points.size());
      inr::MakeEvaluator(model, kernel)
          ->evaluate(points.data(), static_cast<std::int64_t>(points.size()), values.data());
      truth.expect(values, -FLT_MAX, FLT_MAX, name + kernel);
    }
  });
  RecordProperty("known", static_cast<int>(100 * known / all));
  EXPECT_GE(static_cast<double>(known), GetParam().known * static_cast<double>(all));
}

TEST_P(BadNumbers, AreTheSameOnLatticesInEveryKernel)
{
  forEachModel([](const inr::ModelPointer& model, const std::string& name) {
    const inr::Layout layout(model->description);
    std::vector<float> axes[3] = {
        Coordinates(layout, 6, 1), {0.0f, 0.3f, 0.31f, 0.9f, 1.0f}, {0.2f, 0.77f}};
    std::sort(axes[0].begin(), axes[0].end());
    const Truth truth(*model, PointsOf(axes));
    for (const std::string& kernel : UsableKernels()) {
      std::vector<float> values(truth.Values.size());
      inr::MakeEvaluator(model, kernel)->evaluateGrid(axes, values.data());
      truth.expect(values, -FLT_MAX, FLT_MAX, name + kernel);
    }
  });
}

TEST_P(BadNumbers, AreTheSameInBricksOfEveryKernel)
{
  const inr::Hierarchy levels({9, 5, 6}, 6);
  const inr::BrickKey key = inr::KeyOf({0, {0, 0, 0}});
  std::vector<glm::vec3> points;
  for (std::int64_t k = 0; k < levels.voxelsPerBrick(); ++k) {
    const glm::i64vec3 dims(levels.brickDims());
    const glm::dvec3 voxel(k % dims.x, k / dims.x % dims.y, k / (dims.x * dims.y));
    points.emplace_back((voxel + 0.5) / glm::dvec3(levels.size(0)));
  }
  forEachModel([&](const inr::ModelPointer& model, const std::string& name) {
    const Truth truth(*model, points);
    for (const std::string& kernel : UsableKernels()) {
      std::vector<float> values(points.size());
      inr::MakeBrickSource(inr::MakeEvaluator(model, kernel), levels)
          ->infer(&key, 1, values.data(), inr::Arena(1));
      truth.expect(values, 0.0f, 1.0f, name + kernel);
    }
  });
}

TEST_P(BadNumbers, DoNotMakeAValueDependOnItsNeighbours)
{
  forEachModel([](const inr::ModelPointer& model, const std::string& name) {
    const std::vector<glm::vec3> points = Positions(inr::Layout(model->description));
    std::vector<float> axes[3] = {{0.1f, 0.5f, 0.52f, 0.9f}, {0.0f, 0.3f, 0.7f}, {0.2f}};
    const std::vector<glm::vec3> lattice = PointsOf(axes);
    for (const std::string& kernel : UsableKernels()) {
      const auto evaluator = inr::MakeEvaluator(model, kernel);
      std::vector<float> together(points.size());
      evaluator->evaluate(points.data(), static_cast<std::int64_t>(points.size()), together.data());
      for (std::size_t k = 0; k < points.size(); ++k) {
        float alone = 0;
        evaluator->evaluate(&points[k], 1, &alone);
        ASSERT_EQ(alone, together[k]) << name << kernel << " at " << k;
      }
      std::vector<float> values(lattice.size());
      evaluator->evaluateGrid(axes, values.data());
      for (std::size_t k = 0; k < lattice.size(); ++k) {
        float alone = 0;
        evaluator->evaluateGrid({{lattice[k].x}, {lattice[k].y}, {lattice[k].z}}, &alone);
        ASSERT_EQ(alone, values[k]) << name << kernel << " on the lattice at " << k;
      }
    }
  });
}

/// Kernels for bfloat16, where they are used.
TEST_P(BadNumbers, AreWithinTheBoundOfBFloat16)
{
  const RoundingKernels rounding;
  std::vector<float> axes[3] = {{0.1f, 0.5f, 0.52f, 0.9f}, {0.0f, 0.3f, 0.7f}, {0.2f}};
  const std::vector<glm::vec3> lattice = PointsOf(axes);
  int rounded = 0;
  forEachModel([&](const inr::ModelPointer& model, const std::string& name) {
    const auto chosen = inr::MakeEvaluator(model, "", inr::InferencePrecision::BFloat16);
    if (chosen->kernel().find("bfloat16") == std::string::npos) {
      return;
    }
    ++rounded;
    const std::vector<glm::vec3> points = Positions(inr::Layout(model->description));
    for (const inr::InferenceKernels& kernels : rounding) {
      const Truth truth(*model, points, ProductsOf(kernels));
      const Truth latticeTruth(*model, lattice, ProductsOf(kernels));
      const auto evaluator = inr::MakeEvaluator(model, kernels);
      std::vector<float> values(points.size());
      evaluator->evaluate(points.data(), static_cast<std::int64_t>(points.size()), values.data());
      truth.expect(values, -FLT_MAX, FLT_MAX, name + kernels.name);
      values.resize(lattice.size());
      evaluator->evaluateGrid(axes, values.data());
      latticeTruth.expect(values, -FLT_MAX, FLT_MAX, name + kernels.name);
    }
  });
  RecordProperty("rounded", rounded);
}

TEST(BadPositions, ThatAreNaNAreZeroToTheLastBit)
{
  const std::vector<glm::vec3> bad = {{NAN, 0.5f, 0.7f}, {NAN, NAN, NAN}, {-0.0f, 0.1f, -3.0f}};
  const std::vector<glm::vec3> good = {{0, 0.5f, 0.7f}, {0, 0, 0}, {0, 0.1f, 0}};
  for (const std::string& kernel : UsableKernels()) {
    const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()), kernel);
    float values[2][3];
    evaluator->evaluate(bad.data(), 3, values[0]);
    evaluator->evaluate(good.data(), 3, values[1]);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(values[0][k], values[1][k]) << kernel;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Parameters, BadNumbers, testing::ValuesIn(AllNumbers),
                         [](const testing::TestParamInfo<Numbers>& info) {
                           return info.param.name;
                         });

} // namespace test::bad_numbers

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Model/MacroCells.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Core/RandomModel.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>

/// A folder for one test's files, empty before and gone after.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("inr_") + test->test_suite_name() + "_" + test->name();
    std::replace(name.begin(), name.end(), '/', '_');
    // By process too: the same tests may run at once in two build trees.
    this->Path =
        std::filesystem::path(testing::TempDir()) / (name + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(this->Path);
    std::filesystem::create_directory(this->Path);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(this->Path); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const char* name) const { return (this->Path / name).string(); }
  std::ptrdiff_t entries() const
  {
    return std::distance(std::filesystem::directory_iterator(this->Path),
                         std::filesystem::directory_iterator());
  }

private:
  std::filesystem::path Path;
};

/// An untrained INR of a volume with nothing special about its geometry: anisotropic spacing, an
/// origin, turned axes.
inline std::shared_ptr<inr::Model> MakeModel(const glm::i64vec3& dims,
                                             inr::ScalarType type = inr::ScalarType::Float32)
{
  inr::Description description = SmallDescription();
  description.network.outputActivation = inr::Activation::Sigmoid; // values all over the range
  auto model = RandomModel(description);
  model->storedAs = inr::ParameterType::Float;
  model->volume.dims = dims;
  model->volume.spacing = {0.5, 1.25, 3.0};
  model->volume.origin = {10.0, -20.0, 0.125};
  const glm::dmat4 turn =
      glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
  model->volume.direction = glm::dmat3(turn);
  model->volume.arrayName = "density";
  model->volume.type = type;
  model->volume.low = 20.0;
  model->volume.high = 90.0;
  return model;
}

/// The data value at `u` in the unit cube, asked of the network one point at a time.
class Truth
{
public:
  explicit Truth(inr::ModelPointer model)
      : Model(std::move(model)), Evaluator(inr::MakeEvaluator(this->Model))
  {}

  double normalised(const glm::dvec3& u) const
  {
    const glm::vec3 position(u);
    float y = 0;
    this->Evaluator->evaluate(&position, 1, &y);
    return std::fmin(1.0, std::fmax(0.0, static_cast<double>(y)));
  }
  double operator()(const glm::dvec3& u) const
  {
    const inr::VolumeInfo& volume = this->Model->volume;
    return volume.low + (volume.high - volume.low) * this->normalised(u);
  }

private:
  inr::ModelPointer Model;
  std::shared_ptr<const inr::Evaluator> Evaluator;
};

/// Positions are rounded to float on the way to the network; so much its value may change by that,
/// in parts of the value range.
constexpr double PositionTolerance = 2e-5;

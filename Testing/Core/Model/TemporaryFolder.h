// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/ModelFile.h"
#include "Core/Model/Quantised.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

/// A folder of a test's own, removed with it.
struct TemporaryFolder
{
  TemporaryFolder()
      : Path(std::filesystem::path(testing::TempDir()) / ("inr-model-" + std::to_string(getpid())))
  {
    std::filesystem::create_directories(this->Path);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(this->Path); }
  std::string file(const std::string& name) const { return (this->Path / name).string(); }

  std::filesystem::path Path;
};

inline std::string ReadBytes(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void WriteBytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A model that uses every field of the file.
inline std::shared_ptr<inr::Model> FullModel()
{
  auto model = RandomModel(SmallDescription());
  model->storedAs = inr::ParameterType::Float;
  model->volume.dims = {131072, 77, 33};
  model->volume.spacing = {0.1, 2.5, 1e-7};
  model->volume.origin = {-1e6, 0.3, 1.0 / 3.0};
  model->volume.direction = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
  model->volume.arrayName = "Temperature é";
  model->volume.type = inr::ScalarType::Float64;
  model->volume.low = -1.25e-3;
  model->volume.high = 6.02e23;
  model->volume.time = -0.1;
  model->macroCells = inr::MakeMacroCells({40, 30, 20}, 16);
  model->macroCells.provenance = inr::MacroCellProvenance::Decoded;
  model->macroCells.apron = 5.0 / glm::dvec3(model->volume.dims);
  for (std::size_t k = 1; k < model->macroCells.ranges.size(); ++k) {
    const float low = 0.9f * inr::RandomUnit(3, k);
    model->macroCells.ranges[k] = {low, low + 0.1f * inr::RandomUnit(4, k)};
  }
  model->quality = inr::Quality{41.25, 0.987, 3.5, 123456};
  model->training = inr::TrainingRecord{12345, 20000, ~std::uint64_t{0}, 67.5, "avx2", 3, 777};
  return model;
}

/// The same, quantised: every group of parameters has a step of its own.
inline std::shared_ptr<inr::Model> CompactModel()
{
  auto model = FullModel();
  model->storedAs = inr::ParameterType::Quantised;
  for (const inr::ParameterGroup& group : inr::ParameterGroups(model->description)) {
    const float step = 0.7f / static_cast<float>(3 + 4 * model->steps.size());
    inr::RoundToStep(model->parameters.data() + group.offset, group.count, step);
    model->steps.push_back(step);
  }
  return model;
}

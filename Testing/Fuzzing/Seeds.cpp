// SPDX-License-Identifier: BSD-3-Clause
//
// Writes what a fuzzer begins with: small models of all kinds, scenes with them, a checkpoint.
//
//     fuzz_seeds FOLDER      makes FOLDER/model, FOLDER/frame and FOLDER/checkpoint
#include "Core/Error.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Model/Quantised.h"
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Fuzzing/CheckpointArrays.h"
#include "Testing/Fuzzing/FuzzScene.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

inr::Description Tiny()
{
  inr::Description description;
  description.grid.levels = 2;
  description.grid.features = 2;
  description.grid.log2HashmapSize = 5;
  description.grid.baseResolution = 3;
  description.network.neurons = 16;
  description.network.hiddenLayers = 1;
  return description;
}

/// The k-th kind: every enumeration takes all of its values.
inr::Description Kind(int k)
{
  inr::Description description = Tiny();
  inr::GridDescription& grid = description.grid;
  inr::NetworkDescription& network = description.network;
  grid.type = static_cast<inr::GridType>(k % 3);
  grid.interpolation = static_cast<inr::GridInterpolation>(k / 3 % 3);
  grid.hash = static_cast<inr::HashFunction>(k % 4);
  grid.rule = static_cast<inr::HashRule>(k % 2);
  grid.features = 1 << k % 4;
  network.activation = static_cast<inr::Activation>(k % 9);
  network.outputActivation = static_cast<inr::Activation>(k / 2 % 9);
  network.hiddenLayers = k % 3;
  network.neurons = k % 5 == 0 ? 24 : 16;
  network.alignment = k % 2 == 0 ? 16 : 8;
  return description;
}

void Quantise(inr::Model& model)
{
  model.storedAs = inr::ParameterType::Quantised;
  for (const inr::ParameterGroup& group : inr::ParameterGroups(model.description)) {
    model.steps.push_back(0.01f);
    inr::RoundToStep(model.parameters.data() + group.offset, group.count, 0.01f);
  }
}

std::shared_ptr<inr::Model> Seed(int k)
{
  constexpr glm::i64vec3 sizes[] = {{9, 7, 5}, {1, 1, 1}, {131072, 3, 2}, {40, 1, 30}, {17, 16, 2}};
  auto model = RandomModel(Kind(k), static_cast<std::uint64_t>(k));
  model->volume.dims = sizes[k % 5];
  model->volume.type = static_cast<inr::ScalarType>(k % 10);
  model->volume.low = k % 4 == 0 ? -1e38 : 0.0;
  model->volume.high = k % 4 == 1 ? 0.0 : 1e38;
  model->volume.spacing = {0.1, 1.0, k % 2 == 0 ? 3.0 : 1e-3};
  model->volume.origin = {1e9, 0, -1};
  model->macroCells = inr::MakeMacroCells(model->volume.dims, k % 5 == 2 ? 4096 : 4);
  for (inr::ValueRange& range : model->macroCells.ranges) {
    range = {0.0f, 1.0f};
  }
  model->quality = inr::Quality{30.0, 0.9, 1.0, 0};
  model->training = inr::TrainingRecord{100, 200, 1, 2.0, "avx2", 0, 50};
  if (k % 3 == 0) {
    model->storedAs = inr::ParameterType::Float;
  } else if (k % 3 == 1) {
    Quantise(*model);
  }
  return model;
}

void Write(const fs::path& path, const std::string& bytes)
{
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string RandomScene(int k)
{
  std::string scene(SceneSize, '\0');
  for (std::size_t at = 0; at < SceneSize; ++at) {
    scene[at] = static_cast<char>(inr::RandomBits(static_cast<std::uint64_t>(k), at));
  }
  return scene;
}

void WriteSeeds(const fs::path& folder)
{
  constexpr int kinds = 36;
  for (int k = 0; k < kinds; ++k) {
    const std::string bytes = inr::ModelToBytes(*Seed(k));
    const std::string name = "seed-" + std::to_string(k);
    Write(folder / "model" / name, bytes);
    Write(folder / "frame" / name, RandomScene(k) + bytes);
  }
  fs::create_directories(folder / "checkpoint");
  CheckpointArrays arrays;
  inr::WriteCheckpoint((folder / "checkpoint" / "seed").string(), {{"seed", "1"}, {"a", "b"}},
                       {12, 100, 6.5, 38.5, false}, arrays.list());
  inr::WriteCheckpoint((folder / "checkpoint" / "survey").string(), {{"seed", "1"}, {"a", "b"}},
                       {12, 100, 6.5, 38.5, true}, arrays.list(), arrays.list());
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  try {
    WriteSeeds(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

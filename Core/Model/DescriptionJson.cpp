// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/DescriptionJson.h"

#include "Core/Model/JsonSection.h"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace inr {
namespace {

using nlohmann::json;

constexpr NameTable<GridType, 4> EncodingNames = {{{"HashGrid", GridType::Hash},
                                                   {"Grid", GridType::Hash},
                                                   {"DenseGrid", GridType::Dense},
                                                   {"TiledGrid", GridType::Tiled}}};
constexpr NameTable<GridType, 3> TypeNames = {
    {{"Hash", GridType::Hash}, {"Dense", GridType::Dense}, {"Tiled", GridType::Tiled}}};
constexpr NameTable<GridInterpolation, 3> InterpolationNames = {
    {{"Linear", GridInterpolation::Linear},
     {"Smoothstep", GridInterpolation::Smoothstep},
     {"Nearest", GridInterpolation::Nearest}}};
constexpr NameTable<HashFunction, 4> HashNames = {{{"CoherentPrime", HashFunction::CoherentPrime},
                                                   {"Prime", HashFunction::Prime},
                                                   {"ReversedPrime", HashFunction::ReversedPrime},
                                                   {"Rng", HashFunction::Rng}}};
constexpr NameTable<Activation, 9> ActivationNames = {{{"None", Activation::None},
                                                       {"ReLU", Activation::ReLU},
                                                       {"LeakyReLU", Activation::LeakyReLU},
                                                       {"Exponential", Activation::Exponential},
                                                       {"Sigmoid", Activation::Sigmoid},
                                                       {"Sine", Activation::Sine},
                                                       {"Squareplus", Activation::Squareplus},
                                                       {"Softplus", Activation::Softplus},
                                                       {"Tanh", Activation::Tanh}}};

enum class NetworkType { FullyFused, Cutlass };
constexpr NameTable<NetworkType, 4> NetworkNames = {{{"FullyFusedMLP", NetworkType::FullyFused},
                                                     {"MegakernelMLP", NetworkType::FullyFused},
                                                     {"CutlassMLP", NetworkType::Cutlass},
                                                     {"MLP", NetworkType::Cutlass}}};

// Wide enough for every count; Layout knows the true limits.
int Count(const JsonSection& section, const char* key, int fallback)
{
  const std::int64_t value = section.integer(key, fallback);
  if (value < 0 || value > 0x7FFFFFFF) {
    section.refuse(key, "is out of range");
  }
  return static_cast<int>(value);
}

// `n_features` (also `n_grid_features`) is the total over all levels, instead of `n_levels`.
int ParseLevels(const JsonSection& section, int features)
{
  const char* total = section.has("n_grid_features") ? "n_grid_features" : "n_features";
  if (!section.has(total)) {
    return Count(section, "n_levels", 16);
  }
  if (section.has("n_levels")) {
    section.refuse(total, "and 'n_levels' exclude each other");
  }
  const int count = Count(section, total, 0);
  if (features < 1 || count % features != 0) {
    section.refuse(total, "must be a multiple of 'n_features_per_level'");
  }
  return count / features;
}

GridDescription ParseGrid(const json& model)
{
  const JsonSection section = JsonSection(model, "").section("encoding");
  GridDescription grid;
  grid.type = section.choice("otype", EncodingNames, GridType::Hash);
  grid.type = section.choice("type", TypeNames, grid.type);
  grid.interpolation =
      section.choice("interpolation", InterpolationNames, GridInterpolation::Linear);
  grid.hash = section.choice("hash", HashNames, HashFunction::CoherentPrime);
  grid.features = Count(section, "n_features_per_level", 2);
  grid.levels = ParseLevels(section, grid.features);
  grid.log2HashmapSize = Count(section, "log2_hashmap_size", 19);
  grid.baseResolution = Count(section, "base_resolution", 16);
  grid.perLevelScale = static_cast<float>(section.number("per_level_scale", 2.0));
  return grid;
}

bool IsFullyFusedWidth(int neurons)
{
  return neurons == 16 || neurons == 32 || neurons == 64 || neurons == 128;
}

NetworkDescription ParseNetwork(const json& model)
{
  const JsonSection section = JsonSection(model, "").section("network");
  NetworkDescription network;
  const NetworkType type = section.choice("otype", NetworkNames, NetworkType::Cutlass);
  network.neurons = Count(section, "n_neurons", 128);
  network.hiddenLayers = Count(section, "n_hidden_layers", 5);
  network.activation = section.choice("activation", ActivationNames, Activation::ReLU);
  network.outputActivation = section.choice("output_activation", ActivationNames, Activation::None);
  if (type == NetworkType::FullyFused) {
    if (!IsFullyFusedWidth(network.neurons)) {
      section.refuse("n_neurons", "must be 16, 32, 64 or 128 for a FullyFusedMLP");
    }
    if (network.hiddenLayers < 1) {
      section.refuse("n_hidden_layers", "must be at least 1 for a FullyFusedMLP");
    }
  }
  return network;
}

BsonObject GridSection(const GridDescription& grid)
{
  BsonObject section;
  section.text("otype", NameOf(EncodingNames, grid.type))
      .integer("n_levels", grid.levels)
      .integer("n_features_per_level", grid.features)
      .integer("log2_hashmap_size", grid.log2HashmapSize)
      .integer("base_resolution", grid.baseResolution);
  // What has its default is left out, as in upstream's own files; but the default scale of a dense
  // grid changed in 2025.
  if (grid.perLevelScale != 2.0f || grid.type == GridType::Dense) {
    section.real("per_level_scale", static_cast<double>(grid.perLevelScale));
  }
  if (grid.interpolation != GridInterpolation::Linear) {
    section.text("interpolation", NameOf(InterpolationNames, grid.interpolation));
  }
  if (grid.hash != HashFunction::CoherentPrime) {
    section.text("hash", NameOf(HashNames, grid.hash));
  }
  return section;
}

// Upstream's fused kernels know a few widths only, and cannot train a sine.
NetworkType TypeOf(const NetworkDescription& network)
{
  const bool fused = network.alignment == 16 && network.hiddenLayers >= 1 &&
                     network.activation != Activation::Sine && IsFullyFusedWidth(network.neurons);
  return fused ? NetworkType::FullyFused : NetworkType::Cutlass;
}

/// Of those of tiny-cuda-nn that are read, or belong to its training.
void CheckKeys(const json& model)
{
  const JsonSection config(model, "");
  config.allowOnly({"encoding", "network", "loss", "optimizer"});
  config.section("encoding")
      .allowOnly({"otype", "type", "n_levels", "n_features", "n_grid_features",
                  "n_features_per_level", "log2_hashmap_size", "base_resolution", "per_level_scale",
                  "interpolation", "hash"});
  config.section("network").allowOnly(
      {"otype", "n_neurons", "n_hidden_layers", "activation", "output_activation"});
  for (const char* section : {"encoding", "network"}) {
    if (!config.has(section)) {
      config.refuse(section, "is missing from the model configuration");
    }
  }
}

} // namespace

Description ParseDescription(const json& model)
{
  Description description{ParseGrid(model), ParseNetwork(model)};
  (void)Layout(description); // checks every range
  return description;
}

Description ParseModelConfig(const std::string& text)
{
  json model;
  try {
    model = json::parse(text, nullptr, true, /*ignore_comments=*/true);
  } catch (const json::exception& failure) { // a number may be too large for one, too
    throw Error(ErrorCode::Malformed,
                std::string("the model configuration is not JSON: ") + failure.what());
  }
  CheckKeys(model);
  return ParseDescription(model);
}

BsonObject DescriptionSection(const Description& description)
{
  const NetworkDescription& network = description.network;
  return BsonObject()
      .object("encoding", GridSection(description.grid))
      .object("network",
              BsonObject()
                  .text("otype", NameOf(NetworkNames, TypeOf(network)))
                  .integer("n_neurons", network.neurons)
                  .integer("n_hidden_layers", network.hiddenLayers)
                  .text("activation", NameOf(ActivationNames, network.activation))
                  .text("output_activation", NameOf(ActivationNames, network.outputActivation)));
}

json DescriptionToJson(const Description& description)
{
  return json::from_bson(DescriptionSection(description).bytes());
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/DescriptionJson.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using inr::Description;
using inr::ErrorCode;
using inr::ParseDescription;
using inr::ParseModelConfig;
using nlohmann::json;

namespace test::description_json {

// The code and message with which `text` is refused.
std::pair<ErrorCode, std::string> Refusal(const std::string& text)
{
  try {
    ParseModelConfig(text);
  } catch (const inr::Error& error) {
    return {error.code(), error.what()};
  }
  ADD_FAILURE() << "accepted: " << text;
  return {ErrorCode::Cancelled, ""};
}

void ExpectRefused(const std::string& text, ErrorCode code, const std::string& mention)
{
  const auto [found, message] = Refusal(text);
  EXPECT_EQ(found, code) << message;
  EXPECT_NE(message.find(mention), std::string::npos) << message;
}

TEST(DescriptionJson, ReadsTheExampleWithComments)
{
  const Description description = ParseModelConfig(R"({
    "optimizer": {"otype": "Adam"}, // ignored
    /* "network": {"otype": "CutlassMLP", "activation": "Sine"}, */
    "encoding": {"otype": "HashGrid", "n_levels": 8, "n_features_per_level": 8,
                 "log2_hashmap_size": 19, "base_resolution": 16},
    "network": {"otype": "FullyFusedMLP", "activation": "ReLU", "output_activation": "None",
                "n_neurons": 64, "n_hidden_layers": 4}})");
  EXPECT_EQ(inr::Layout(description).parameterCount, 23380992u);
}

TEST(DescriptionJson, SaysOfNumbersThatAreNoneWhereTheyStand)
{
  ExpectRefused(R"({"encoding": {"per_level_scale": 1e999}})", ErrorCode::Malformed,
                "the model configuration is not JSON");
}

TEST(DescriptionJson, DefaultsAreThoseOfTinyCudaNn)
{
  const Description description = ParseDescription(json::object());
  EXPECT_EQ(description.grid.type, inr::GridType::Hash);
  EXPECT_EQ(description.grid.levels, 16);
  EXPECT_EQ(description.grid.features, 2);
  EXPECT_EQ(description.grid.log2HashmapSize, 19);
  EXPECT_EQ(description.grid.baseResolution, 16);
  EXPECT_EQ(description.grid.perLevelScale, 2.0f);
  EXPECT_EQ(description.network.neurons, 128);
  EXPECT_EQ(description.network.hiddenLayers, 5);
  EXPECT_EQ(description.network.activation, inr::Activation::ReLU);
  EXPECT_EQ(description.network.outputActivation, inr::Activation::None);
}

TEST(DescriptionJson, NamesIgnoreCaseAndHaveSynonyms)
{
  const Description description = ParseModelConfig(
      R"({"encoding": {"otype": "grid", "type": "TILED", "interpolation": "smoothstep",
                       "hash": "rng", "n_features": 12, "n_features_per_level": 4},
          "network": {"otype": "megakernelmlp", "n_neurons": 32, "n_hidden_layers": 2,
                      "activation": "SINE", "output_activation": "squareplus"}})");
  EXPECT_EQ(description.grid.type, inr::GridType::Tiled);
  EXPECT_EQ(description.grid.interpolation, inr::GridInterpolation::Smoothstep);
  EXPECT_EQ(description.grid.hash, inr::HashFunction::Rng);
  EXPECT_EQ(description.grid.levels, 3);
  EXPECT_EQ(description.network.activation, inr::Activation::Sine);
  EXPECT_EQ(description.network.outputActivation, inr::Activation::Squareplus);
}

TEST(DescriptionJson, TakesTheTotalOfFeaturesByEitherName)
{
  for (const std::string name : {"n_features", "n_grid_features"}) {
    const Description description =
        ParseModelConfig(R"({"encoding": {")" + name + R"(": 8}, "network": {}})");
    EXPECT_EQ(description.grid.levels * description.grid.features, 8) << name;
  }
}

TEST(DescriptionJson, WholeNumbersMayBeDoubles)
{
  const Description description =
      ParseModelConfig(R"({"encoding": {"n_levels": 4.0, "per_level_scale": 2}, "network": {}})");
  EXPECT_EQ(description.grid.levels, 4);
}

TEST(DescriptionJson, RefusalsNameTheKey)
{
  ExpectRefused("{", ErrorCode::Malformed, "not JSON");
  ExpectRefused("[]", ErrorCode::InvalidModel, "not an object");
  ExpectRefused(R"({"encoding": 3, "network": {}})", ErrorCode::InvalidModel, "'encoding'");
  ExpectRefused(R"({"encoding": {"otype": "Frequency"}, "network": {}})", ErrorCode::Unsupported,
                "'encoding.otype' is 'Frequency'");
  ExpectRefused(R"({"network": {"otype": "CutlassResNet"}, "encoding": {}})",
                ErrorCode::Unsupported, "'network.otype'");
  ExpectRefused(R"({"network": {"activation": "Mish"}, "encoding": {}})", ErrorCode::Unsupported,
                "'network.activation'");
  ExpectRefused(R"({"network": {"activation": 1}, "encoding": {}})", ErrorCode::InvalidModel,
                "'network.activation'");
  ExpectRefused(R"({"encoding": {"n_levels": 2.5}, "network": {}})", ErrorCode::InvalidModel,
                "'encoding.n_levels'");
  ExpectRefused(R"({"encoding": {"n_levels": "8"}, "network": {}})", ErrorCode::InvalidModel,
                "'encoding.n_levels'");
  ExpectRefused(R"({"encoding": {"n_levels": 1e300}, "network": {}})", ErrorCode::InvalidModel,
                "'encoding.n_levels'");
  ExpectRefused(R"({"encoding": {"n_levels": 99999}, "network": {}})", ErrorCode::InvalidModel,
                "grid levels");
  ExpectRefused(R"({"encoding": {"n_levels": 2, "n_features": 4}, "network": {}})",
                ErrorCode::InvalidModel, "'encoding.n_features'");
  ExpectRefused(R"({"encoding": {"n_features": 5}, "network": {}})", ErrorCode::InvalidModel,
                "multiple");
  ExpectRefused(R"({"network": {"otype": "FullyFusedMLP", "n_neurons": 48}, "encoding": {}})",
                ErrorCode::InvalidModel, "'network.n_neurons'");
  ExpectRefused(
      R"({"network": {"otype": "FullyFusedMLP", "n_neurons": 64, "n_hidden_layers": 0},
          "encoding": {}})",
      ErrorCode::InvalidModel, "'network.n_hidden_layers'");
}

// Files come from other programs, which may say more; what a user misspells must not stand for its
// default without a word.
TEST(DescriptionJson, RefusesUnknownKeysOfUsersOnly)
{
  const auto refused = [](const std::string& text, const std::string& mention) {
    ExpectRefused(text, ErrorCode::InvalidModel, mention);
    EXPECT_NO_THROW(ParseDescription(json::parse(text)));
  };
  refused(R"({"encodng": {"n_levels": 4}, "netwok": {}})",
          "'encodng' is not known; what may be here is encoding, network, loss, optimizer");
  refused(R"({"encoding": {"n_level": 4}, "network": {}})", "'encoding.n_level' is not known");
  refused(R"({"encoding": {}, "network": {"neurons": 16}})", "'network.neurons' is not known");
  refused("{}", "'encoding' is missing");
  refused(R"({"encoding": {}})", "'network' is missing");
}

TEST(DescriptionJson, WritesWhatItReads)
{
  Description description;
  description.grid.type = inr::GridType::Dense;
  description.grid.interpolation = inr::GridInterpolation::Nearest;
  description.grid.hash = inr::HashFunction::Prime;
  description.grid.levels = 3;
  description.grid.features = 1;
  description.grid.log2HashmapSize = 7;
  description.grid.baseResolution = 6;
  description.grid.perLevelScale = 1.7f;
  description.network.neurons = 48;
  description.network.hiddenLayers = 0;
  description.network.activation = inr::Activation::LeakyReLU;
  description.network.outputActivation = inr::Activation::Sigmoid;
  const Description back = ParseDescription(inr::DescriptionToJson(description));
  EXPECT_EQ(back.grid.type, description.grid.type);
  EXPECT_EQ(back.grid.interpolation, description.grid.interpolation);
  EXPECT_EQ(back.grid.hash, description.grid.hash);
  EXPECT_EQ(back.grid.levels, description.grid.levels);
  EXPECT_EQ(back.grid.features, description.grid.features);
  EXPECT_EQ(back.grid.log2HashmapSize, description.grid.log2HashmapSize);
  EXPECT_EQ(back.grid.baseResolution, description.grid.baseResolution);
  EXPECT_EQ(back.grid.perLevelScale, description.grid.perLevelScale);
  EXPECT_EQ(back.network.neurons, description.network.neurons);
  EXPECT_EQ(back.network.hiddenLayers, description.network.hiddenLayers);
  EXPECT_EQ(back.network.activation, description.network.activation);
  EXPECT_EQ(back.network.outputActivation, description.network.outputActivation);
}

TEST(DescriptionJson, NetworkTypeIsOneThatUpstreamCanBuild)
{
  const auto typeOf = [](int neurons, int layers, int alignment) {
    Description description;
    description.network.neurons = neurons;
    description.network.hiddenLayers = layers;
    description.network.alignment = alignment;
    return inr::DescriptionToJson(description)["network"]["otype"].get<std::string>();
  };
  EXPECT_EQ(typeOf(64, 4, 16), "FullyFusedMLP");
  EXPECT_EQ(typeOf(48, 4, 16), "CutlassMLP");
  EXPECT_EQ(typeOf(64, 0, 16), "CutlassMLP");
  EXPECT_EQ(typeOf(64, 4, 8), "CutlassMLP");
}

} // namespace test::description_json

// SPDX-License-Identifier: BSD-3-Clause
//
// Files that are sound BSON and say two things at once, or one that cannot be, or that come from a
// later version: each refusal says what it is about.
#include "Core/Error.h"
#include "Core/Model/ModelBytes.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <nlohmann/json.hpp>

#include <functional>

namespace test::contradictions {

using nlohmann::json;

json Document()
{
  const std::string bytes = inr::ModelToBytes(*FullModel());
  return json::from_bson(bytes.begin(), bytes.end());
}

std::string BytesOf(const json& document)
{
  const std::vector<std::uint8_t> bytes = json::to_bson(document);
  return {bytes.begin(), bytes.end()};
}

/// What is said of the document after `change`.
std::string Refusal(const std::function<void(json&)>& change)
{
  json document = Document();
  change(document);
  try {
    inr::ModelFromBytes(BytesOf(document));
    return "accepted";
  } catch (const inr::Error& error) {
    return error.what();
  }
}

void ExpectRefused(const std::string& words, const std::function<void(json&)>& change)
{
  const std::string refusal = Refusal(change);
  EXPECT_NE(refusal.find(words), std::string::npos) << words << ": " << refusal;
}

TEST(Contradictions, TheDocumentItselfIsRead)
{
  EXPECT_EQ(Refusal([](json&) {}), "accepted");
}

TEST(Contradictions, OfNumbersThatBelongTogether)
{
  ExpectRefused("n_params", [](json& root) { root["parameters"]["n_params"] = 1LL << 40; });
  ExpectRefused("parameters", [](json& root) { root["parameters"]["n_params"] = 12; });
  ExpectRefused("parameters", [](json& root) { root["model"]["encoding"]["n_levels"] = 5; });
  ExpectRefused("parameters", [](json& root) { root["parameters"]["params_type"] = "__half"; });
  ExpectRefused("contradict", [](json& root) { root["volume"]["dims"]["x"] = 131071; });
  ExpectRefused("contradict", [](json& root) { root["inr"]["dims"]["z"] = 34; });
  ExpectRefused("dims", [](json& root) { root["macrocell"]["dims"]["y"] = 3; });
  ExpectRefused("cover", [](json& root) { root["macrocell"]["spacings"]["x"] = 0.01; });
  for (const double spacing : {1.1e9, 1e308}) {
    ExpectRefused("at most 1e9", [&](json& root) { root["macrocell"]["spacings"]["y"] = spacing; });
  }
  ExpectRefused("low end", [](json& root) { root["inr"]["data_range"]["low"] = 7e23; });
  ExpectRefused("range", [](json& root) {
    root["inr"]["data_range"] = {{"low", -1e308}, {"high", 1e308}};
  });
  ExpectRefused("a uint8 cannot hold", [](json& root) {
    root["inr"]["array_type"] = "uint8";
    root["inr"]["data_range"] = {{"low", 0}, {"high", 256}};
  });
  ExpectRefused("a float32 cannot hold", [](json& root) {
    root["inr"]["array_type"] = "float32";
    root["inr"]["data_range"] = {{"low", -1e39}, {"high", 0}};
  });
  ExpectRefused("no finite size", [](json& root) { root["inr"]["spacing"]["y"] = 1e308; });
  ExpectRefused("exclude", [](json& root) { root["model"]["encoding"]["n_features"] = 16; });
}

TEST(Contradictions, LeaveNoArrayWithoutAName)
{
  for (const std::string& name : {std::string(), std::string(1, '\0') + "x"}) {
    json document = Document();
    document["inr"]["array_name"] = name;
    EXPECT_EQ(inr::ModelFromBytes(BytesOf(document))->volume.arrayName, "Scalars");
  }
}

TEST(Contradictions, OfKinds)
{
  ExpectRefused("inr", [](json& root) { root["inr"] = 3; });
  ExpectRefused("dims", [](json& root) { root["inr"]["dims"] = {131072, 77, 33}; });
  ExpectRefused("direction", [](json& root) { root["inr"]["direction"] = {1, 0, 0}; });
  ExpectRefused("direction", [](json& root) { root["inr"]["direction"] = json::object(); });
  ExpectRefused("direction", [](json& root) { root["inr"]["direction"][4] = json::array(); });
  ExpectRefused("params_binary", [](json& root) { root["parameters"]["params_binary"] = "none"; });
  ExpectRefused("macrocell/data", [](json& root) { root["macrocell"]["data"] = json::object(); });
  ExpectRefused("array_name", [](json& root) { root["inr"]["array_name"] = json::array(); });
  ExpectRefused("spacing", [](json& root) { root["inr"]["spacing"]["x"] = "1"; });
  ExpectRefused("n_levels", [](json& root) { root["model"]["encoding"]["n_levels"] = 4.5; });
  ExpectRefused("encoding", [](json& root) { root["model"]["encoding"] = true; });
}

TEST(Contradictions, OfDepth)
{
  const auto nested = [](int depth, bool arrays) {
    return [=](json& root) {
      json inner = 1;
      for (int k = 0; k < depth; ++k) {
        inner = arrays && k % 2 == 0 ? json::array({inner}) : json{{"deeper", inner}};
      }
      root["remark"] = inner; // an unknown key, which would be ignored
    };
  };
  EXPECT_EQ(Refusal(nested(15, false)), "accepted");
  EXPECT_EQ(Refusal(nested(15, true)), "accepted");
  ExpectRefused("nested", nested(16, false));
  ExpectRefused("nested", nested(16, true));
  ExpectRefused("nested", nested(500, true));
  ExpectRefused("elements", [](json& root) { root["remark"] = json::array_t(5000); });
}

TEST(LaterVersions, AreToldByTheirNumber)
{
  for (const std::int64_t version : {std::int64_t{3}, std::int64_t{1} << 40}) {
    const std::string refusal =
        Refusal([&](json& root) { root["inr"]["format_version"] = version; });
    EXPECT_NE(refusal.find("format version " + std::to_string(version)), std::string::npos)
        << refusal;
    EXPECT_NE(refusal.find("reads versions 1 and 2"), std::string::npos) << refusal;
  }
  ExpectRefused("format_version", [](json& root) { root["inr"]["format_version"] = "2"; });
  ExpectRefused("format_version", [](json& root) { root["inr"].erase("format_version"); });
}

// What a later version may bring is not to be said in place of its number.
TEST(LaterVersions, AreToldWhateverElseIsNew)
{
  const auto later = [](const std::function<void(json&)>& change) {
    return Refusal([&](json& root) {
      root["inr"]["format_version"] = 3;
      change(root);
    });
  };
  const std::function<void(json&)> changes[] = {
      [](json& root) { root["parameters"]["params_type"] = "bfloat16"; },
      [](json& root) { root["inr"]["transform"] = "symlog"; },
      [](json& root) { root["model"]["encoding"]["otype"] = "Wavelets"; },
      [](json& root) { root["inr"].erase("dims"); },
  };
  for (const auto& change : changes) {
    const std::string refusal = later(change);
    EXPECT_NE(refusal.find("format version 3"), std::string::npos) << refusal;
  }
}

} // namespace test::contradictions

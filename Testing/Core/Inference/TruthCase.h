// SPDX-License-Identifier: BSD-3-Clause
//
// What truth.py wrote; INR_TRUTH_DIR names the folder.
#pragma once

#include "Core/Model/DescriptionJson.h"
#include "Core/Model/Model.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

template <class T> inline std::vector<T> ReadArray(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  std::vector<T> values(bytes.size() / sizeof(T));
  std::copy_n(bytes.data(), values.size() * sizeof(T), reinterpret_cast<char*>(values.data()));
  return values;
}

/// Names of all models.
inline std::vector<std::string> CaseNames()
{
  std::ifstream file(INR_TRUTH_DIR "/cases.txt");
  return {std::istream_iterator<std::string>(file), {}};
}

/// A model, positions and float64 values there.
struct TruthCase
{
  explicit TruthCase(const std::string& name)
      : Positions(ReadArray<glm::vec3>(INR_TRUTH_DIR "/" + name + ".xyz")),
        Values(ReadArray<double>(INR_TRUTH_DIR "/" + name + ".truth"))
  {
    std::ifstream file(INR_TRUTH_DIR "/" + name + ".json");
    this->Source.description = inr::ParseDescription(nlohmann::json::parse(file));
    const auto parameters = ReadArray<float>(INR_TRUTH_DIR "/" + name + ".params");
    this->Source.parameters.assign(parameters.begin(), parameters.end());
  }

  std::vector<glm::vec3> Positions;
  std::vector<double> Values;
  inr::Model Source;
};

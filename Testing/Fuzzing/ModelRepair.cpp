// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/Compression.h"
#include "Core/Model/DescriptionJson.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Model/Quantised.h"
#include "Testing/Fuzzing/ModelMutator.h"

#include <zstd.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t MostBytes = 1 << 17; // that a repair makes

json* Member(json& root, const char* section, const char* key)
{
  const auto found = root.find(section);
  if (found == root.end() || !found->is_object()) {
    return nullptr;
  }
  const auto member = found->find(key);
  return member == found->end() ? nullptr : &*member;
}

Bytes* BlobOf(json& root, const char* section, const char* key)
{
  json* const node = Member(root, section, key);
  return node != nullptr && node->is_binary() ? &node->get_binary() : nullptr;
}

/// The same content over and over.
void Resize(Bytes& bytes, std::size_t size)
{
  const std::size_t had = bytes.size();
  bytes.resize(size, 0);
  for (std::size_t k = had; k < size && had > 0; ++k) {
    bytes[k] = bytes[k - had];
  }
}

bool Unpack(const Bytes& packed, Bytes& plain)
{
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size > MostBytes) { // or not told
    return false;
  }
  plain.resize(size);
  return !ZSTD_isError(ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size()));
}

void Pack(const Bytes& plain, Bytes& packed)
{
  const std::string frame = inr::Compress(std::string(plain.begin(), plain.end()));
  packed.assign(frame.begin(), frame.end());
}

void ResizePacked(Bytes& blob, std::size_t size)
{
  Bytes plain;
  if (Unpack(blob, plain) && plain.size() == size) {
    return;
  }
  Resize(plain, size);
  Pack(plain, blob);
}

void RepairParameters(json& root)
{
  Bytes* const blob = BlobOf(root, "parameters", "params_binary");
  const auto model = root.find("model");
  if (blob == nullptr || model == root.end()) {
    return;
  }
  const inr::Description description = inr::ParseDescription(*model);
  const std::uint64_t count = inr::Layout(description).parameterCount;
  if (count > MostBytes / 4) {
    return;
  }
  json& section = root["parameters"];
  section["n_params"] = count;
  const json type = section.value("params_type", json());
  if (type != "quantised") {
    Resize(*blob, count * (type == "float" ? 4 : 2));
    return;
  }
  ResizePacked(*blob, 2 * count);
  if (json& steps = section["steps"]; steps.is_array()) {
    const std::size_t groups = inr::ParameterGroups(description).size();
    while (steps.size() > groups) {
      steps.erase(steps.size() - 1);
    }
    while (steps.size() < groups) {
      steps.push_back(0.01);
    }
  }
}

void RepairCells(json& root)
{
  Bytes* const blob = BlobOf(root, "macrocell", "data");
  json* const dims = Member(root, "macrocell", "dims");
  if (blob == nullptr || dims == nullptr || !dims->is_object()) {
    return;
  }
  std::uint64_t count = 1;
  for (const char* axis : {"x", "y", "z"}) {
    const json along = dims->value(axis, json());
    if (!along.is_number_integer() || along < 1 || along > 4096) {
      return;
    }
    count *= along.get<std::uint64_t>();
  }
  json* const type = Member(root, "parameters", "params_type");
  const bool packed = type != nullptr && *type == "quantised";
  if (count > MostBytes / 8) {
    return;
  }
  packed ? ResizePacked(*blob, 2 * count) : Resize(*blob, 8 * count);
}

} // namespace

void RepairSizes(json& root)
{
  try {
    RepairParameters(root);
  } catch (const inr::Error&) { // no description to go by
  } catch (const json::exception&) {
  }
  try {
    RepairCells(root);
  } catch (const json::exception&) {
  }
}

void RepairChecksum(json& root)
{
  json* const place = Member(root, "inr", "checksum");
  if (place == nullptr) {
    return;
  }
  std::uint32_t checksum = 0;
  for (const Bytes* blob :
       {BlobOf(root, "parameters", "params_binary"), BlobOf(root, "macrocell", "data")}) {
    checksum =
        blob == nullptr ? checksum : inr::ContinueChecksum(checksum, blob->data(), blob->size());
  }
  char text[16];
  std::snprintf(text, sizeof(text), "crc32:%08x", checksum);
  *place = text;
}

bool MutatePacked(Bytes& blob, Random& random)
{
  Bytes plain;
  if (!Unpack(blob, plain) || plain.empty()) {
    return false;
  }
  for (std::size_t changes = 1 + Below(random, 8); changes > 0; --changes) {
    plain[Below(random, plain.size())] = static_cast<std::uint8_t>(random());
  }
  Pack(plain, blob);
  return true;
}

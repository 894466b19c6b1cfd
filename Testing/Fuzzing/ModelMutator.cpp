// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Fuzzing/ModelMutator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace {

using nlohmann::json;

constexpr const char* Keys[] = {"activation",
                                "apron",
                                "array_name",
                                "array_type",
                                "base_resolution",
                                "checksum",
                                "data",
                                "data_range",
                                "dims",
                                "direction",
                                "earlier_steps",
                                "encoding",
                                "format_version",
                                "groundtruth",
                                "hash",
                                "hash_rule",
                                "high",
                                "inr",
                                "interpolation",
                                "kernel",
                                "log2_hashmap_size",
                                "loss",
                                "low",
                                "macrocell",
                                "macrocell_apron",
                                "macrocell_provenance",
                                "max_error",
                                "model",
                                "n_features",
                                "n_features_per_level",
                                "n_grid_features",
                                "n_hidden_layers",
                                "n_levels",
                                "n_neurons",
                                "n_params",
                                "network",
                                "non_finite",
                                "origin",
                                "otype",
                                "output_activation",
                                "parameters",
                                "params_binary",
                                "params_type",
                                "per_level_scale",
                                "planned_steps",
                                "psnr",
                                "quality",
                                "sampled_voxels",
                                "seconds",
                                "seed",
                                "spacing",
                                "spacings",
                                "ssim",
                                "steps",
                                "time",
                                "training",
                                "transform",
                                "type",
                                "volume",
                                "x",
                                "y",
                                "z",
                                "0",
                                "1"};

constexpr const char* Words[] = {"",
                                 "HashGrid",
                                 "Grid",
                                 "DenseGrid",
                                 "TiledGrid",
                                 "Hash",
                                 "Dense",
                                 "Tiled",
                                 "Linear",
                                 "Smoothstep",
                                 "Nearest",
                                 "CoherentPrime",
                                 "Prime",
                                 "ReversedPrime",
                                 "Rng",
                                 "None",
                                 "ReLU",
                                 "LeakyReLU",
                                 "Exponential",
                                 "Sigmoid",
                                 "Sine",
                                 "Squareplus",
                                 "Softplus",
                                 "Tanh",
                                 "FullyFusedMLP",
                                 "MegakernelMLP",
                                 "CutlassMLP",
                                 "MLP",
                                 "__half",
                                 "float",
                                 "quantised",
                                 "linear",
                                 "symlog",
                                 "wrapping",
                                 "exact",
                                 "decoded",
                                 "training",
                                 "file",
                                 "int8",
                                 "uint8",
                                 "int16",
                                 "uint16",
                                 "int32",
                                 "uint32",
                                 "int64",
                                 "uint64",
                                 "float32",
                                 "float64",
                                 "infinity",
                                 "-infinity",
                                 "nan",
                                 "crc32:00000000",
                                 "crc32:ffffffff"};

template <std::size_t Count> const char* OneOf(const char* const (&words)[Count], Random& random)
{
  return words[Below(random, Count)];
}

std::int64_t Integer(std::int64_t old, Random& random)
{
  const std::int64_t sign = Below(random, 2) == 0 ? 1 : -1;
  switch (Below(random, 6)) {
  case 0:
    return static_cast<std::int64_t>(Below(random, 20));
  case 1: // around powers of two
    return sign * ((std::int64_t{1} << Below(random, 63)) +
                   sign * (static_cast<std::int64_t>(Below(random, 3)) - 1));
  case 2:
    return sign > 0 ? std::numeric_limits<std::int64_t>::max()
                    : std::numeric_limits<std::int64_t>::min();
  case 3:
    return -(old / 2);
  default: // near by
    return std::abs(old) < 1000000 ? old + sign * static_cast<std::int64_t>(Below(random, 9))
                                   : old / 2;
  }
}

double Real(double old, Random& random)
{
  using Limits = std::numeric_limits<double>;
  constexpr double special[] = {0.0,
                                -0.0,
                                1.0,
                                -1.0,
                                0.5,
                                1e-12,
                                1e12,
                                1e38,
                                1e-38,
                                1e300,
                                1e-300,
                                5e-324,
                                2e9,
                                -1e308,
                                1.7976931348623157e308,
                                Limits::infinity(),
                                Limits::quiet_NaN(),
                                65504.0,
                                1.0000001};
  const double factor = std::exp2(static_cast<double>(Below(random, 41)) - 20.0);
  return Below(random, 2) == 0 ? special[Below(random, std::size(special))]
                               : (Below(random, 2) == 0 ? old * factor : -old);
}

void ChangeBytes(std::vector<std::uint8_t>& bytes, Random& random)
{
  constexpr std::size_t most = 1 << 16;
  if (Below(random, 2) == 0 && MutatePacked(bytes, random)) {
    return;
  }
  switch (Below(random, 4)) {
  case 0:
    bytes.resize(Below(random, std::min(2 * bytes.size() + 2, most)));
    return;
  case 1: { // one number: half or single precision, whatever
    const std::uint32_t numbers[] = {0,          0x7f800000, 0x7fc00000, 0x00000001, 0x7f7fffff,
                                     0x7c007c00, 0x7bff7bff, 0xfbfffbff, 0xff7fffff, 0x3f800000};
    if (bytes.size() >= 4) {
      std::memcpy(bytes.data() + Below(random, bytes.size() / 4) * 4,
                  &numbers[Below(random, std::size(numbers))], 4);
    }
    return;
  }
  default: {
    const std::size_t size = bytes.size();
    bytes.resize(std::min(most, size + 64));
    bytes.resize(LLVMFuzzerMutate(bytes.data(), std::min(size, bytes.size()), bytes.size()));
  }
  }
}

void ChangeText(std::string& text, Random& random)
{
  switch (Below(random, 4)) {
  case 0:
    text.resize(Below(random, 6000), 'a');
    return;
  case 1:
    if (!text.empty()) {
      text[Below(random, text.size())] = static_cast<char>(random());
    }
    return;
  default:
    text = OneOf(Words, random);
  }
}

/// Another value, of another kind at times.
void ChangeValue(json& node, Random& random)
{
  switch (Below(random, 8)) {
  case 0: {
    const json others[] = {
        nullptr, true, 1, 2.5, "text", json::array(), json::object(), json::binary({1, 2, 3})};
    node = others[Below(random, std::size(others))];
    return;
  }
  default:
    break;
  }
  if (node.is_number_integer()) {
    const auto old = node.get<std::int64_t>();
    node = Below(random, 8) == 0 ? json(static_cast<double>(old)) : json(Integer(old, random));
  } else if (node.is_number()) {
    node = Real(node.get<double>(), random);
  } else if (node.is_string()) {
    ChangeText(node.get_ref<std::string&>(), random);
  } else if (node.is_binary()) {
    ChangeBytes(node.get_binary(), random);
  } else if (node.is_boolean()) {
    node = !node.get<bool>();
  } else if (node.is_array() && !node.empty()) {
    Below(random, 2) == 0 ? node.erase(Below(random, node.size())) : node.push_back(node.back());
  }
}

std::vector<json*> NodesOf(json& root)
{
  std::vector<json*> nodes{&root};
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k]->is_structured()) {
      for (json& child : *nodes[k]) {
        nodes.push_back(&child);
      }
    }
  }
  return nodes;
}

/// Keys of an object: removed, added, renamed, or with a part of the document hung under them.
void ChangeKeys(json& object, const json& part, Random& random)
{
  const auto at =
      std::next(object.begin(), static_cast<std::ptrdiff_t>(Below(random, object.size())));
  const std::size_t choice = Below(random, 5);
  if (choice == 0 && !object.empty()) {
    object.erase(at);
  } else if (choice == 1 && !object.empty()) {
    json moved = *at;
    object.erase(at);
    object[OneOf(Keys, random)] = std::move(moved);
  } else if (choice == 2) {
    json inner = part;
    for (std::size_t depth = Below(random, 20); depth > 0; --depth) {
      inner = json{{"a", std::move(inner)}};
    }
    object[OneOf(Keys, random)] = std::move(inner);
  } else if (choice == 3) {
    object[OneOf(Keys, random)] = Integer(1, random);
  } else {
    object[OneOf(Keys, random)] = OneOf(Words, random);
  }
}

void Change(json& root, Random& random)
{
  const std::vector<json*> nodes = NodesOf(root);
  json& node = *nodes[Below(random, nodes.size())];
  if (node.is_object()) {
    const json part = *nodes[Below(random, nodes.size())];
    ChangeKeys(node, part, random);
  } else {
    ChangeValue(node, random);
  }
}

std::size_t Rewritten(json root, std::uint8_t* data, std::size_t most, Random& random)
{
  for (std::size_t changes = 1 + Below(random, 3); changes > 0; --changes) {
    Change(root, random);
  }
  if (Below(random, 3) != 0) {
    RepairSizes(root);
  }
  if (Below(random, 8) != 0) {
    RepairChecksum(root);
  }
  const std::vector<std::uint8_t> bytes = json::to_bson(root);
  if (bytes.size() > most) {
    return 0;
  }
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

} // namespace

std::size_t MutateModel(std::uint8_t* data, std::size_t size, std::size_t most, unsigned int seed)
{
  constexpr std::size_t largest = 1 << 20; // nlohmann's reader is recursive
  Random random(seed);
  if (Below(random, 10) == 0 || size > largest) {
    return LLVMFuzzerMutate(data, size, most);
  }
  try {
    const json root = json::from_bson(data, data + size);
    const std::size_t written = Rewritten(root, data, most, random);
    return written > 0 ? written : LLVMFuzzerMutate(data, size, most);
  } catch (const json::exception&) { // text, broken, or with a zero in a key
    return LLVMFuzzerMutate(data, size, most);
  }
}

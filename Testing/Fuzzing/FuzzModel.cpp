// SPDX-License-Identifier: BSD-3-Clause
//
// Bytes -> validator and loader: a model, or inr::Error and nothing else. A model that was read can
// be written, and comes back as it was.
#include "Core/Error.h"
#include "Core/Model/Description.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Fuzzing/Target.h"

#include <cmath>

namespace {

/// Small files may stand for much (up to 256 MiB), and then take a second each.
bool IsSmall(const inr::Model& header)
{
  constexpr std::uint64_t most = 1 << 20;
  return inr::Layout(header.description).parameterCount <= most;
}

void RequireSound(const inr::Model& model)
{
  INR_REQUIRE(model.parameters.size() == inr::Layout(model.description).parameterCount);
  for (const float parameter : model.parameters) {
    INR_REQUIRE(std::isfinite(parameter));
  }
  const glm::i64vec3 cells = model.macroCells.dims;
  INR_REQUIRE(model.macroCells.ranges.size() ==
              static_cast<std::size_t>(cells.x * cells.y * cells.z));
  for (const inr::ValueRange& range : model.macroCells.ranges) {
    INR_REQUIRE(std::isfinite(range.low) && std::isfinite(range.high));
  }
  INR_REQUIRE(model.volume.low <= model.volume.high);
}

void RequireSame(const inr::Model& a, const inr::Model& b)
{
  INR_REQUIRE(a.parameters == b.parameters);
  INR_REQUIRE(a.steps == b.steps);
  INR_REQUIRE(a.volume.dims == b.volume.dims);
  INR_REQUIRE(inr::ResolutionOf(a) == inr::ResolutionOf(b));
  INR_REQUIRE(a.volume.low == b.volume.low && a.volume.high == b.volume.high);
  INR_REQUIRE(a.volume.arrayName == b.volume.arrayName);
  INR_REQUIRE(a.volume.time == b.volume.time);
  INR_REQUIRE(a.quality.has_value() == b.quality.has_value());
  INR_REQUIRE(a.macroCells.ranges.size() == b.macroCells.ranges.size());
  for (std::size_t k = 0; k < a.macroCells.ranges.size(); ++k) {
    const inr::ValueRange& before = a.macroCells.ranges[k];
    const inr::ValueRange& after = b.macroCells.ranges[k];
    INR_REQUIRE(before.empty() || (after.low <= before.low && after.high >= before.high));
  }
}

/// Upstream's ways of saying things are more than ours; what cannot be written says so.
std::string Written(const inr::Model& model)
{
  try {
    return inr::ModelToBytes(model);
  } catch (const inr::Error& error) {
    INR_REQUIRE(error.code() == inr::ErrorCode::InvalidModel);
    return {};
  }
}

inr::ModelPointer Read(const std::string& path)
{
  try {
    const inr::Model header = inr::ReadModelHeader(path);
    return IsSmall(header) ? inr::ReadModel(path) : nullptr;
  } catch (const inr::Error& error) {
    INR_REQUIRE(error.what()[0] != '\0');
    return nullptr;
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const MemoryFile file(data, size);
  static_cast<void>(inr::IsModelFile(file.path()));
  const inr::ModelPointer model = Read(file.path());
  if (!model) {
    return 0;
  }
  RequireSound(*model);
  // The way of a model that is sent to another process.
  RequireSame(*model, *inr::ModelFromBytes(std::string(reinterpret_cast<const char*>(data), size)));
  const std::string written = Written(*model);
  if (!written.empty()) {
    RequireSame(*model, *inr::ModelFromBytes(written));
  }
  return 0;
}

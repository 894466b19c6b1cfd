// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/InrSection.h"

#include "Core/Error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace inr {
namespace {

using nlohmann::json;

constexpr std::int64_t PlainVersion = 1;   // readable upstream, our section ignored
constexpr std::int64_t CompactVersion = 2; // quantised parameters, packed blobs
constexpr const char* ChecksumPrefix = "crc32:";
constexpr const char* AxisNames[3] = {"x", "y", "z"};

constexpr NameTable<HashRule, 2> RuleNames = {
    {{"wrapping", HashRule::Wrapping}, {"exact", HashRule::Exact}}};
constexpr NameTable<MacroCellProvenance, 3> ProvenanceNames = {
    {{"decoded", MacroCellProvenance::Decoded},
     {"training", MacroCellProvenance::Training},
     {"file", MacroCellProvenance::File}}};
enum class Transform { Linear };
constexpr NameTable<Transform, 1> TransformNames = {{{"linear", Transform::Linear}}};

// Quality may be infinite or undefined, which no JSON number can be: those are words.
void SetReal(BsonObject& section, const char* key, double value)
{
  if (std::isfinite(value)) {
    section.real(key, value);
  } else {
    section.text(key, std::isnan(value) ? "nan" : value > 0 ? "infinity" : "-infinity");
  }
}

double ParseReal(const JsonSection& section, const char* key)
{
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  const json* value = section.find(key);
  if (value == nullptr || !value->is_string()) {
    return section.number(key);
  }
  static constexpr std::pair<const char*, double> Words[] = {
      {"nan", std::numeric_limits<double>::quiet_NaN()},
      {"infinity", Infinity},
      {"-infinity", -Infinity}};
  for (const auto& [word, real] : Words) {
    if (*value == word) {
      return real;
    }
  }
  section.refuse(key, "must be a number, 'nan', 'infinity' or '-infinity'");
}

BsonObject AxesSection(const glm::dvec3& vector)
{
  return BsonObject().real("x", vector.x).real("y", vector.y).real("z", vector.z);
}

glm::dvec3 ParseReals(const JsonSection& section)
{
  glm::dvec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] = section.number(AxisNames[axis]);
  }
  return result;
}

// Row by row, as one reads a matrix (GLM stores columns).
std::vector<double> RowsOf(const glm::dmat3& direction)
{
  std::vector<double> rows;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rows.push_back(direction[column][row]);
    }
  }
  return rows;
}

glm::dmat3 ParseDirection(const JsonSection& section)
{
  const json* rows = section.find("direction");
  if (rows == nullptr || !rows->is_array() || rows->size() != 9) {
    section.refuse("direction", "must be an array of 9 numbers");
  }
  glm::dmat3 direction;
  for (int i = 0; i < 9; ++i) {
    const json& element = (*rows)[static_cast<std::size_t>(i)];
    if (!element.is_number()) {
      section.refuse("direction", "must be an array of 9 numbers");
    }
    direction[i % 3][i / 3] = element.get<double>();
  }
  return direction;
}

std::string ChecksumToText(std::uint32_t checksum)
{
  char digits[9];
  std::snprintf(digits, sizeof(digits), "%08x", checksum);
  return std::string(ChecksumPrefix) + digits;
}

std::uint32_t ParseChecksum(const JsonSection& section)
{
  const std::string text = section.text("checksum");
  const std::string prefix = ChecksumPrefix;
  const std::string digits =
      text.substr(0, prefix.size()) == prefix ? text.substr(prefix.size()) : std::string();
  if (digits.size() != 8 || digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
    section.refuse("checksum", "must be 'crc32:' and 8 hexadecimal digits");
  }
  return static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16));
}

VolumeInfo ParseVolume(const JsonSection& section)
{
  VolumeInfo volume;
  volume.dims = ParseDims(section.section("dims"));
  volume.spacing = ParseReals(section.section("spacing"));
  volume.origin = ParseReals(section.section("origin"));
  volume.direction = ParseDirection(section);
  const std::string name = section.text("array_name").c_str(); // as VTK has names
  volume.arrayName = name.empty() ? volume.arrayName : name;   // ParaView dies of an empty one
  const std::string type = section.text("array_type");
  const std::optional<ScalarType> scalar = ScalarFromName(type);
  if (!scalar) {
    throw Error(ErrorCode::Unsupported, "'inr.array_type' is '" + type + "', an unknown type");
  }
  volume.type = *scalar;
  const JsonSection range = section.section("data_range");
  volume.low = range.number("low");
  volume.high = range.number("high");
  if (section.has("time")) {
    volume.time = section.number("time");
  }
  RequireValidVolume(volume, ErrorCode::InvalidModel);
  return volume;
}

Quality ParseQuality(const JsonSection& section)
{
  Quality quality{ParseReal(section, "psnr"), ParseReal(section, "ssim"),
                  ParseReal(section, "max_error")};
  if (section.has("sampled_voxels")) {
    quality.sampledVoxels = static_cast<std::uint64_t>(section.integer("sampled_voxels"));
  }
  return quality;
}

TrainingRecord ParseTraining(const JsonSection& section)
{
  TrainingRecord record;
  record.steps = static_cast<std::uint64_t>(section.integer("steps"));
  if (section.has("planned_steps")) {
    record.plannedSteps = static_cast<std::uint64_t>(section.integer("planned_steps"));
  }
  record.seed = static_cast<std::uint64_t>(section.integer("seed"));
  record.seconds = section.number("seconds");
  record.kernel = section.text("kernel");
  record.nonFinite = static_cast<std::uint64_t>(section.integer("non_finite"));
  if (section.has("earlier_steps")) {
    record.earlierSteps = static_cast<std::uint64_t>(section.integer("earlier_steps"));
  }
  return record;
}

// BSON has signed integers only: the whole range survives as two's complement.
std::int64_t AsSigned(std::uint64_t value) { return static_cast<std::int64_t>(value); }

constexpr std::int64_t LargestApron = 1024;

std::int64_t ParseApron(const JsonSection& section, MacroCellProvenance provenance)
{
  const std::int64_t unsaid = provenance == MacroCellProvenance::Decoded ? 1 : 0;
  const std::int64_t apron = section.integer("macrocell_apron", unsaid);
  if (apron < 0 || apron > LargestApron) {
    throw Error(ErrorCode::InvalidModel, "an apron of " + std::to_string(apron) +
                                             " voxels around macro-cells; it must be 0 to " +
                                             std::to_string(LargestApron));
  }
  return apron;
}

/// One number for all axes, so what holds along each of them: those of another grid than the
/// volume's own differ, and ranges must not be taken for wider than they are. A single cell holds
/// everything.
std::int64_t ApronInVoxels(const MacroCells& cells, const glm::i64vec3& dims)
{
  constexpr double rounding = 1e-6; // of dividing by the dimensions and multiplying again
  auto least = static_cast<double>(cells.ranges.size() > 1 ? LargestApron : 0);
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.dims[axis] > 1) {
      least = std::min(least, cells.apron[axis] * static_cast<double>(dims[axis]));
    }
  }
  return static_cast<std::int64_t>(std::floor(least + rounding));
}

BsonObject QualitySection(const Quality& quality)
{
  BsonObject section;
  SetReal(section, "psnr", quality.psnr);
  SetReal(section, "ssim", quality.ssim);
  SetReal(section, "max_error", quality.maxError);
  if (quality.sampledVoxels > 0) {
    section.integer("sampled_voxels", AsSigned(quality.sampledVoxels));
  }
  return section;
}

BsonObject TrainingSection(const TrainingRecord& record)
{
  BsonObject section;
  section.integer("steps", AsSigned(record.steps))
      .integer("planned_steps", AsSigned(record.plannedSteps))
      .integer("seed", AsSigned(record.seed))
      .real("seconds", record.seconds)
      .text("kernel", record.kernel)
      .integer("non_finite", AsSigned(record.nonFinite));
  if (record.earlierSteps) {
    section.integer("earlier_steps", AsSigned(*record.earlierSteps));
  }
  return section;
}

} // namespace

BsonObject DimsSection(const glm::i64vec3& dims)
{
  return BsonObject().integer("x", dims.x).integer("y", dims.y).integer("z", dims.z);
}

glm::i64vec3 ParseDims(const JsonSection& section)
{
  glm::i64vec3 dims;
  for (int axis = 0; axis < 3; ++axis) {
    dims[axis] = section.integer(AxisNames[axis]);
  }
  return dims;
}

std::int64_t ParseVersion(const JsonSection& section)
{
  const std::int64_t version = section.integer("format_version");
  if (version != PlainVersion && version != CompactVersion) {
    throw Error(ErrorCode::Unsupported, "the file has format version " + std::to_string(version) +
                                            "; this program reads versions " +
                                            std::to_string(PlainVersion) + " and " +
                                            std::to_string(CompactVersion));
  }
  return version;
}

InrSection ParseInrSection(const JsonSection& section)
{
  const std::int64_t version = ParseVersion(section);
  section.choice("transform", TransformNames);
  InrSection result;
  result.compact = version == CompactVersion;
  result.volume = ParseVolume(section);
  if (const JsonSection native = section.section("native_dims"); native.present()) {
    result.nativeDims = ParseDims(native);
    RequireValidDims(*result.nativeDims, ErrorCode::InvalidModel);
  }
  result.rule = section.choice("hash_rule", RuleNames);
  result.provenance = section.choice("macrocell_provenance", ProvenanceNames);
  result.apron = ParseApron(section, result.provenance);
  result.checksum = ParseChecksum(section);
  if (const JsonSection quality = section.section("quality"); quality.present()) {
    result.quality = ParseQuality(quality);
  }
  if (const JsonSection training = section.section("training"); training.present()) {
    result.training = ParseTraining(training);
  }
  return result;
}

BsonObject OwnSection(const Model& model, std::uint32_t checksum)
{
  const VolumeInfo& volume = model.volume;
  const bool compact = model.storedAs == ParameterType::Quantised;
  BsonObject section;
  section.integer("format_version", compact ? CompactVersion : PlainVersion)
      .text("transform", NameOf(TransformNames, Transform::Linear))
      .object("dims", DimsSection(volume.dims))
      .object("spacing", AxesSection(volume.spacing))
      .object("origin", AxesSection(volume.origin))
      .reals("direction", RowsOf(volume.direction))
      .text("array_name", volume.arrayName)
      .text("array_type", ScalarName(volume.type))
      .object("data_range", BsonObject().real("low", volume.low).real("high", volume.high))
      .text("hash_rule", NameOf(RuleNames, model.description.grid.rule))
      .text("macrocell_provenance", NameOf(ProvenanceNames, model.macroCells.provenance))
      .integer("macrocell_apron", ApronInVoxels(model.macroCells, volume.dims))
      .text("checksum", ChecksumToText(checksum));
  if (model.nativeDims.value_or(volume.dims) != volume.dims) {
    section.object("native_dims", DimsSection(*model.nativeDims));
  }
  if (volume.time) {
    section.real("time", *volume.time);
  }
  if (model.quality) {
    section.object("quality", QualitySection(*model.quality));
  }
  if (model.training) {
    section.object("training", TrainingSection(*model.training));
  }
  return section;
}

} // namespace inr

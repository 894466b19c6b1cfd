// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/ModelHeader.h"

#include "Core/Error.h"
#include "Core/Model/CompactBlobs.h"
#include "Core/Model/Compression.h"
#include "Core/Model/DescriptionJson.h"
#include "Core/Model/InrSection.h"
#include "Core/Model/Quantised.h"
#include "Core/NumberText.h"

#include <cmath>
#include <limits>
#include <string>

namespace inr {
namespace {

using nlohmann::json;

const Blob* FindBlob(const Document& document, const std::string& path)
{
  const auto found = document.blobs.find(path);
  return found == document.blobs.end() ? nullptr : &found->second;
}

const Blob& RequireBlob(const Document& document, const std::string& path)
{
  const Blob* blob = FindBlob(document, path);
  if (blob == nullptr) {
    throw Error(ErrorCode::InvalidModel, "the binary value '" + path + "' is missing");
  }
  return *blob;
}

// The parameter section is `parameters`, or in old files the root itself.
std::string ParametersPath(const JsonSection& root)
{
  if (root.has("parameters")) {
    return "parameters";
  }
  if (!root.has("n_params")) {
    throw Error(ErrorCode::InvalidModel, "there are no parameters: this is the configuration of a "
                                         "model that has not been trained");
  }
  return "";
}

// How far the inputs of a CutlassMLP are padded changed in 2022; only the count of parameters
// tells. 8 and 16 never give the same count.
Description DescriptionFor(const json& model, std::uint64_t parameterCount)
{
  Description description = ParseDescription(model);
  std::uint64_t expected = 0;
  for (const int alignment : {16, 8}) {
    description.network.alignment = alignment;
    const std::uint64_t count = Layout(description).parameterCount;
    if (count == parameterCount) {
      return description;
    }
    expected = expected == 0 ? count : expected;
  }
  throw Error(ErrorCode::InvalidModel, "the file has " + std::to_string(parameterCount) +
                                           " parameters, but its model description needs " +
                                           std::to_string(expected));
}

ParameterType TypeOf(const JsonSection& section, const Blob& blob, std::uint64_t count)
{
  const auto fits = [&](ParameterType type) {
    return type == ParameterType::Quantised
               ? MayExpand(blob.size, PlainParameterBytes(count))
               : static_cast<std::uint64_t>(blob.size) == count * ParameterSize(type);
  };
  const ParameterType type =
      section.choice("params_type", ParameterTypeNames,
                     fits(ParameterType::Float) ? ParameterType::Float : ParameterType::Half);
  if (!fits(type)) {
    throw Error(ErrorCode::InvalidModel, "the parameters take " + std::to_string(blob.size) +
                                             " bytes, which does not fit their number of " +
                                             std::to_string(count));
  }
  return type;
}

std::vector<float> ParseSteps(const JsonSection& section, const Description& description)
{
  const std::size_t count = ParameterGroups(description).size();
  const json* values = section.find("steps");
  if (values == nullptr || !values->is_array() || values->size() != count) {
    section.refuse("steps", "must be an array of " + std::to_string(count) +
                                " numbers, for each matrix and level one");
  }
  std::vector<float> steps;
  for (const json& value : *values) {
    if (!value.is_number() || !IsStep(value.get<double>())) {
      section.refuse("steps", "must be positive numbers that single precision can hold 32,768 of");
    }
    steps.push_back(value.get<float>());
  }
  return steps;
}

void ReadParameterSection(const JsonSection& root, const Document& document, ModelHeader& header)
{
  const std::string path = ParametersPath(root);
  const JsonSection section = path.empty() ? root : root.section("parameters");
  const std::int64_t count = section.integer("n_params");
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (count < 1 || count > most) { // more could not be multiplied by a size
    section.refuse("n_params", "must be positive and under 2^31");
  }
  const auto parameterCount = static_cast<std::uint64_t>(count);
  header.parameters = &RequireBlob(document, (path.empty() ? "" : "/" + path) + "/params_binary");
  // A file that claims a vast model is refused by its blob's size, before any table is laid out.
  header.model.storedAs = TypeOf(section, *header.parameters, parameterCount);
  const json& configuration = root.has("model") ? *root.find("model") : *document.header;
  header.model.description = DescriptionFor(configuration, parameterCount);
  if (header.model.storedAs == ParameterType::Quantised) {
    header.model.steps = ParseSteps(section, header.model.description);
  }
}

void RequireValidCells(const JsonSection& section, const MacroCells& cells, const Blob& blob,
                       bool compact)
{
  constexpr std::int64_t mostCells = std::int64_t{1} << 28; // of a packed table
  constexpr auto rangeSize = static_cast<std::int64_t>(sizeof(ValueRange));
  // Dividing what is left by each count keeps every product within bounds.
  std::int64_t left = compact ? mostCells : blob.size / rangeSize;
  std::int64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t along = cells.dims[axis];
    if (along < 1 || along > left) {
      section.refuse("dims", "do not fit the " + std::to_string(blob.size) + " bytes of ranges");
    }
    left /= along;
    count *= along;
  }
  RequireValidGeometry(cells, ErrorCode::InvalidModel);
  if (compact ? !MayExpand(blob.size, PlainRangeBytes(count)) : count * rangeSize != blob.size) {
    section.refuse("dims", "do not fit the " + std::to_string(blob.size) + " bytes of ranges");
  }
}

void ReadMacroCellSection(const JsonSection& root, const Document& document, ModelHeader& header)
{
  const JsonSection section = root.section("macrocell");
  if (!section.present()) {
    return;
  }
  const JsonSection spacings = section.section("spacings");
  MacroCells& cells = header.model.macroCells;
  cells.dims = ParseDims(section.section("dims"));
  cells.spacing = {spacings.number("x"), spacings.number("y"), spacings.number("z")};
  header.ranges = &RequireBlob(document, "/macrocell/data");
  const bool compact = header.model.storedAs == ParameterType::Quantised;
  RequireValidCells(section, cells, *header.ranges, compact);
}

void ReadOwnSection(const JsonSection& root, ModelHeader& header)
{
  InrSection own = ParseInrSection(root.section("inr"));
  if (own.compact != (header.model.storedAs == ParameterType::Quantised)) {
    throw Error(ErrorCode::InvalidModel,
                "format version 2 and quantised parameters belong together, and only one is there");
  }
  const JsonSection dims = root.section("volume").section("dims");
  if (dims.present() && ParseDims(dims) != own.volume.dims) {
    throw Error(ErrorCode::InvalidModel, "'volume.dims' and 'inr.dims' contradict each other");
  }
  header.model.volume = std::move(own.volume);
  header.model.nativeDims = own.nativeDims;
  header.model.description.grid.rule = own.rule;
  header.model.macroCells.provenance = own.provenance;
  header.model.macroCells.apron =
      static_cast<double>(own.apron) / glm::dvec3(header.model.volume.dims);
  header.model.quality = own.quality;
  header.model.training = std::move(own.training);
  header.encoding = CellEncoding::Offset;
  header.checksum = own.checksum;
}

// Upstream stores no more than 1,024 voxels along an axis of what it trained out of core. Where the
// macro-cells, whose edge is 16 voxels in all its files, tell of more, that is how many there were.
std::int64_t TrueDimension(std::int64_t stored, std::int64_t cells, double spacing)
{
  constexpr std::int64_t mostStored = 1024;
  constexpr double edge = 16;
  const double told = std::round(edge / spacing);
  const bool fits = std::ceil(told / edge) == static_cast<double>(cells);
  return stored == mostStored && told > mostStored && fits ? static_cast<std::int64_t>(told)
                                                           : stored;
}

// Upstream's files know nothing of a volume but its dimensions.
void ReadVolumeSection(const JsonSection& root, const ModelOverrides& overrides,
                       ModelHeader& header)
{
  Model& model = header.model;
  const JsonSection dims = root.section("volume").section("dims");
  if (dims.present()) {
    model.volume.dims = ParseDims(dims);
    for (int axis = 0; axis < 3 && header.ranges != nullptr; ++axis) {
      model.volume.dims[axis] = TrueDimension(model.volume.dims[axis], model.macroCells.dims[axis],
                                              model.macroCells.spacing[axis]);
    }
    RequireValidVolume(model.volume, ErrorCode::InvalidModel);
  } else if (!overrides.dims) {
    throw Error(ErrorCode::InvalidModel,
                "the file does not tell the volume's dimensions; give them as Dimensions");
  }
}

// What `inr` says of the volume is true; upstream's dimensions are what may have to be mended.
void ApplyOverrides(const ModelOverrides& overrides, bool isOwn, Model& model)
{
  VolumeInfo& volume = model.volume;
  if (overrides.dims) {
    if (isOwn && !model.nativeDims) {
      model.nativeDims = volume.dims;
    }
    const glm::i64vec3 dims = *overrides.dims;
    if (std::min({dims.x, dims.y, dims.z}) < 1) {
      throw Error(ErrorCode::InvalidArgument,
                  "Dimensions are " + std::to_string(dims.x) + " x " + std::to_string(dims.y) +
                      " x " + std::to_string(dims.z) + "; give the voxels along all three axes");
    }
    if (dims != volume.dims) { // at whose voxels nobody has measured
      model.macroCells.provenance = MacroCellProvenance::File;
      model.quality.reset();
    }
    volume.dims = dims;
  }
  if (overrides.dataRange) {
    if (!(overrides.dataRange->x < overrides.dataRange->y)) {
      throw Error(ErrorCode::InvalidArgument, "DataRange is " + NumberText(overrides.dataRange->x) +
                                                  " to " + NumberText(overrides.dataRange->y) +
                                                  "; give the smallest value and a larger one");
    }
    const double before = volume.high - volume.low;
    volume.low = overrides.dataRange->x;
    volume.high = overrides.dataRange->y;
    if (model.quality && before > 0) { // the other measures are relative to the range
      model.quality->maxError *= (volume.high - volume.low) / before;
    }
  }
  RequireValidVolume(volume, ErrorCode::InvalidArgument);
}

} // namespace

ModelHeader ParseModelHeader(const Document& document, const ModelOverrides& overrides)
{
  const JsonSection root(*document.header, "");
  if (!root.has("model") && !root.has("encoding") && !root.has("network")) {
    throw Error(ErrorCode::Malformed,
                "this is not a model file: it has neither 'model' nor 'encoding' and 'network'");
  }
  if (root.has("inr")) { // first: a later version may be anything else, too
    ParseVersion(root.section("inr"));
  }
  ModelHeader header;
  ReadParameterSection(root, document, header);
  ReadMacroCellSection(root, document, header);
  if (root.has("inr")) {
    ReadOwnSection(root, header);
  } else if (header.model.storedAs == ParameterType::Quantised) {
    throw Error(ErrorCode::InvalidModel,
                "the parameters are quantised, but section 'inr' is missing");
  } else {
    ReadVolumeSection(root, overrides, header);
  }
  ApplyOverrides(overrides, root.has("inr"), header.model);
  return header;
}

} // namespace inr

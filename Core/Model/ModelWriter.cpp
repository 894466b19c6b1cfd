// SPDX-License-Identifier: BSD-3-Clause
#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/Model/BsonObject.h"
#include "Core/Model/CompactBlobs.h"
#include "Core/Model/DescriptionJson.h"
#include "Core/Model/InrSection.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Model/ModelFile.h"
#include "Core/Model/Quantised.h"

#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

namespace inr {
namespace {

constexpr std::size_t LengthSize = sizeof(std::int32_t);

struct BlobSizes
{
  std::int64_t ranges = 0;
  std::int64_t parameters = 0;
};

// A file is text[0], macro-cell ranges, text[1], parameters, text[2].
struct Framing
{
  std::array<std::string, 3> text;
  BlobSizes blobs;

  std::int64_t total() const
  {
    std::int64_t sum = this->blobs.ranges + this->blobs.parameters;
    for (const std::string& piece : this->text) {
      sum += static_cast<std::int64_t>(piece.size());
    }
    return sum;
  }
};

// Adds to the little-endian length at `position`; sizes over the limit are refused before anything
// is written, so what wraps here is never seen.
void AddToLength(std::string& bytes, std::size_t position, std::int64_t amount)
{
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + position, LengthSize);
  length += static_cast<std::uint32_t>(amount);
  std::memcpy(bytes.data() + position, &length, LengthSize);
}

std::string Element(const std::string& key, const BsonObject& section)
{
  return BsonElement(BsonType::Object, key, section.bytes());
}

// An element whose binary value `blobKey` has `blobBytes` bytes that are not there yet; they belong
// between the two results.
std::pair<std::string, std::string> SplitElement(const std::string& key, BsonObject section,
                                                 const std::string& blobKey, std::int64_t blobBytes)
{
  std::string bytes = Element(key, section.emptyBinary(blobKey));
  const std::size_t document = 1 + key.size() + 1;
  const std::string marker = BsonElement(BsonType::Binary, blobKey, "");
  const std::size_t length = bytes.find(marker, document) + marker.size();
  AddToLength(bytes, document, blobBytes);
  AddToLength(bytes, length, blobBytes);
  const std::size_t split = length + LengthSize + 1; // and the subtype
  return {bytes.substr(0, split), bytes.substr(split)};
}

BsonObject MacroCellSection(const MacroCells& cells)
{
  const glm::dvec3& spacing = cells.spacing;
  return BsonObject()
      .object("dims", DimsSection(cells.dims))
      .object("spacings",
              BsonObject().real("x", spacing.x).real("y", spacing.y).real("z", spacing.z))
      .flag("groundtruth", cells.provenance != MacroCellProvenance::File);
}

BsonObject ModelSection(const Description& description)
{
  // Upstream cannot build a model without a loss.
  return DescriptionSection(description).object("loss", BsonObject().text("otype", "L1"));
}

bool IsCompact(const Model& model) { return model.storedAs == ParameterType::Quantised; }

BsonObject ParameterSection(const Model& model)
{
  BsonObject section;
  section.integer("n_params", static_cast<std::int64_t>(Layout(model.description).parameterCount))
      .text("params_type", NameOf(ParameterTypeNames, model.storedAs));
  if (IsCompact(model)) {
    std::vector<double> steps(model.steps.begin(), model.steps.end());
    if (steps.empty()) { // for its size
      steps.resize(ParameterGroups(model.description).size(), 1.0);
    }
    section.reals("steps", steps);
  }
  return section;
}

// Root keys in byte order, as upstream's library writes them.
Framing Frame(const Model& model, const BlobSizes& blobs, std::uint32_t checksum)
{
  Framing framing;
  framing.blobs = blobs;
  framing.text[0] = std::string(LengthSize, '\0') + Element("inr", OwnSection(model, checksum));
  if (!model.macroCells.empty()) {
    const auto [before, after] =
        SplitElement("macrocell", MacroCellSection(model.macroCells), "data", blobs.ranges);
    framing.text[0] += before;
    framing.text[1] = after;
  }
  const auto [before, after] =
      SplitElement("parameters", ParameterSection(model), "params_binary", blobs.parameters);
  framing.text[1] += Element("model", ModelSection(model.description)) + before;
  const BsonObject volume = BsonObject().object("dims", DimsSection(model.volume.dims));
  framing.text[2] = after + Element("volume", volume) + '\0';
  AddToLength(framing.text[0], 0, framing.total());
  return framing;
}

void RequireParameters(const Model& model)
{
  const std::uint64_t count = Layout(model.description).parameterCount;
  if (model.parameters.size() != count) {
    throw Error(ErrorCode::InvalidModel,
                "the model has " + std::to_string(model.parameters.size()) +
                    " parameters where its description needs " + std::to_string(count));
  }
}

std::string ParameterBlob(const Model& model, Packing packing)
{
  RequireParameters(model);
  return IsCompact(model) ? EncodeQuantised(model, packing)
                          : EncodeParameters(model.parameters, model.storedAs);
}

std::string RangeBlob(const Model& model, Packing packing)
{
  const std::vector<ValueRange>& ranges = model.macroCells.ranges;
  return IsCompact(model) && !ranges.empty() ? EncodeCompactRanges(ranges, packing)
                                             : EncodeRanges(ranges);
}

BlobSizes SizesOf(const std::string& ranges, const std::string& parameters)
{
  return {static_cast<std::int64_t>(ranges.size()), static_cast<std::int64_t>(parameters.size())};
}

// What they take at most, whatever the parameters are; exact but for compact files.
BlobSizes LargestSizes(const Model& model)
{
  const auto cells = static_cast<std::int64_t>(model.macroCells.ranges.size());
  if (!IsCompact(model)) {
    const std::uint64_t count = Layout(model.description).parameterCount;
    return {cells * static_cast<std::int64_t>(sizeof(ValueRange)),
            static_cast<std::int64_t>(count * ParameterSize(model.storedAs))};
  }
  return {LargestCompactRanges(cells), LargestQuantised(model.description)};
}

void RequireSize(std::int64_t bytes)
{
  if (bytes > MostBsonBytes) {
    throw Error(ErrorCode::TooLarge, "the model would take " + std::to_string(bytes) +
                                         " bytes; a model file must be smaller than 2 GiB");
  }
}

// Hands the file to `write` piece by piece and returns its size.
template <typename Write>
std::int64_t WritePieces(const Model& model, Packing packing, const Write& write)
{
  const std::string parameters = ParameterBlob(model, packing);
  const std::string ranges = RangeBlob(model, packing);
  const std::uint32_t checksum = ContinueChecksum(
      ContinueChecksum(0, parameters.data(), parameters.size()), ranges.data(), ranges.size());
  const Framing framing = Frame(model, SizesOf(ranges, parameters), checksum);
  for (const std::string* piece :
       {&framing.text[0], &ranges, &framing.text[1], &parameters, &framing.text[2]}) {
    write(*piece);
  }
  return framing.total();
}

std::int64_t WriteFile(const Model& model, const std::string& path)
{
  RequireStorable(model);
  AtomicFile file(path);
  const std::int64_t bytes = WritePieces(model, Packing::Small, [&file](const std::string& piece) {
    file.write(piece.data(), piece.size());
  });
  file.commit();
  return bytes;
}

} // namespace

void RequireStorable(const Model& model)
{
  RequireValidVolume(model.volume, ErrorCode::InvalidModel);
  const MacroCells& cells = model.macroCells;
  const auto cellCount = static_cast<std::int64_t>(cells.ranges.size());
  if (!cells.empty()) {
    RequireValidGeometry(cells, ErrorCode::InvalidModel);
    if (GridCount(cells.dims) != cellCount) {
      throw Error(ErrorCode::InvalidModel,
                  "the number of macro-cell ranges does not fit their dims");
    }
  }
  if (model.training && !std::isfinite(model.training->seconds)) {
    throw Error(ErrorCode::InvalidModel, "the seconds of the training must be a finite number");
  }
  RequireSize(Frame(model, LargestSizes(model), 0).total());
}

std::int64_t ModelFileSize(const Model& model)
{
  const bool pack = IsCompact(model) && !model.parameters.empty();
  const BlobSizes sizes =
      pack ? SizesOf(RangeBlob(model, Packing::Small), ParameterBlob(model, Packing::Small))
           : LargestSizes(model);
  return Frame(model, sizes, 0).total();
}

std::string ModelToBytes(const Model& model)
{
  RequireStorable(model);
  std::string bytes;
  WritePieces(model, Packing::Fast, [&bytes](const std::string& piece) { bytes += piece; });
  return bytes;
}

std::int64_t WriteModel(const Model& model, const std::string& path)
{
  const std::string context = "cannot write '" + path + "': ";
  try {
    return WriteFile(model, path);
  } catch (const Error& error) {
    // AtomicFile's messages say so already.
    throw error.code() == ErrorCode::CannotWrite ? error : error.inContext(context);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::TooLarge, context + "there is not enough memory");
  }
}

} // namespace inr

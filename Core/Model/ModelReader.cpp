// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/Model/BsonScanner.h"
#include "Core/Model/BsonTypes.h"
#include "Core/Model/CompactBlobs.h"
#include "Core/Model/LittleEndian.h"
#include "Core/Model/ModelBytes.h"
#include "Core/Model/ModelFile.h"
#include "Core/Model/ModelHeader.h"

#include <algorithm>
#include <new>
#include <utility>

namespace inr {
namespace {

constexpr std::int64_t StartLength = 4096;
constexpr const char* InriaMagic = "#INRIMAGE";

std::string StartOf(const InputFile& file)
{
  std::string start(static_cast<std::size_t>(std::min(file.size(), StartLength)), '\0');
  file.read(0, start.data(), start.size());
  return start;
}

bool IsRootKey(const std::string& key)
{
  static constexpr const char* Keys[] = {"encoding",      "inr",        "loss",        "macrocell",
                                         "model",         "n_params",   "network",     "optimizer",
                                         "params_binary", "parameters", "params_type", "volume"};
  return std::any_of(std::begin(Keys), std::end(Keys),
                     [&](const char* known) { return key == known; });
}

bool LooksLikeText(const std::string& start)
{
  constexpr const char* byteOrderMark = "\xef\xbb\xbf"; // as editors of some systems put there
  const std::size_t begin = start.rfind(byteOrderMark, 0) == 0 ? 3 : 0;
  const std::size_t first = start.find_first_not_of(" \t\r\n", begin);
  return first != std::string::npos && (start[first] == '{' || start[first] == '/');
}

// The first key of a JSON object; comments in front of it are not worth understanding.
std::string FirstTextKey(const std::string& start)
{
  const std::size_t brace = start.find('{');
  const std::size_t open = start.find('"', brace);
  const std::size_t close = open == std::string::npos ? open : start.find('"', open + 1);
  return close == std::string::npos ? "" : start.substr(open + 1, close - open - 1);
}

// A BSON file that is whole starts with its own size; '{' is a possible first byte of that.
bool StartsWithItsSize(const std::string& start, const InputFile& file)
{
  return start.size() >= 4 && FromBytes<std::int32_t>(start.data()) == file.size();
}

Document Scan(const InputFile& file)
{
  if (file.size() == 0) {
    throw Error(ErrorCode::Malformed, "the file is empty");
  }
  if (file.size() > MostBsonBytes) {
    throw Error(ErrorCode::TooLarge, "a model file is smaller than 2 GiB");
  }
  const std::string start = StartOf(file);
  if (start.rfind(InriaMagic, 0) == 0) {
    throw Error(ErrorCode::Unsupported,
                "this is an INRIA image, which shares the extension; it is no neural model");
  }
  const bool whole = StartsWithItsSize(start, file);
  const bool text = LooksLikeText(start) && !whole;
  if (!text && !whole && !IsRootKey(FirstBsonKey(start))) { // else it may be a part of a model
    throw Error(ErrorCode::Malformed, "this is not a model file: it starts neither as BSON with a "
                                      "known key nor as JSON text");
  }
  return text ? ScanJsonText(file) : ScanBson(file);
}

void RequireChecksum(const ModelHeader& header, std::uint32_t found)
{
  if (header.checksum && *header.checksum != found) {
    throw Error(ErrorCode::Malformed, "the checksum does not match: the file has been damaged "
                                      "since it was written");
  }
}

Model LoadBlobs(const InputFile& file, ModelHeader header)
{
  Model& model = header.model;
  std::uint32_t checksum = 0;
  const bool compact = model.storedAs == ParameterType::Quantised;
  model.parameters = compact ? DecodeQuantised(file, *header.parameters, model, checksum)
                             : DecodeParameters(file, *header.parameters, model.storedAs, checksum);
  if (header.ranges != nullptr) {
    const glm::i64vec3& dims = model.macroCells.dims;
    model.macroCells.ranges =
        compact ? DecodeCompactRanges(file, *header.ranges, GridCount(dims), checksum)
                : DecodeRanges(file, *header.ranges, header.encoding, checksum);
  }
  RequireChecksum(header, checksum);
  if (model.macroCells.empty()) {
    model.macroCells = {};
  }
  return std::move(model);
}

ModelPointer Load(const InputFile& file, const ModelOverrides& overrides)
{
  const Document document = Scan(file);
  return std::make_shared<const Model>(LoadBlobs(file, ParseModelHeader(document, overrides)));
}

// Every way in passes here, so that every message names the file.
template <typename Body> auto Reading(const std::string& path, const Body& body)
{
  const std::string context = "cannot read '" + path + "': ";
  try {
    return body();
  } catch (const Error& error) {
    throw error.inContext(context);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::TooLarge, context + "there is not enough memory");
  } catch (const nlohmann::json::exception& failure) {
    throw Error(ErrorCode::Malformed, context + failure.what());
  }
}

} // namespace

bool IsModelFile(const std::string& path)
{
  try {
    const InputFile file(path);
    const std::string start = StartOf(file);
    return StartsWithItsSize(start, file) || IsRootKey(FirstBsonKey(start)) ||
           (LooksLikeText(start) && IsRootKey(FirstTextKey(start)));
  } catch (const std::exception&) { // Error, or no memory
    return false;
  }
}

Model ReadModelHeader(const std::string& path, const ModelOverrides& overrides)
{
  return Reading(path, [&] {
    const InputFile file(path);
    const Document document = Scan(file);
    Model model = ParseModelHeader(document, overrides).model;
    model.macroCells = {};
    return model;
  });
}

ModelPointer ReadModel(const std::string& path, const ModelOverrides& overrides)
{
  return Reading(path, [&] { return Load(InputFile(path), overrides); });
}

ModelPointer ModelFromBytes(std::string bytes)
{
  const char* const name = "a model that was sent";
  return Reading(name, [&] { return Load(InputFile::OfBytes(std::move(bytes)), {}); });
}

} // namespace inr

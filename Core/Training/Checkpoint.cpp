// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Checkpoint.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/Model/JsonSection.h"
#include "Core/Model/LittleEndian.h"
#include "Core/Model/ModelBlobs.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace inr {

namespace {

using nlohmann::json;

constexpr std::size_t NameSize = 8;
constexpr char Magic[NameSize + 1] = "INRtrain";
constexpr std::uint32_t Version = 1;
constexpr std::size_t StartSize = NameSize + 2 * sizeof(std::uint32_t);
constexpr std::size_t FrontSize = NameSize + sizeof(std::uint64_t); // of an array
constexpr std::int64_t ChecksumSize = sizeof(std::uint32_t);
constexpr std::int64_t LargestHeader = 1 << 16;
constexpr std::int64_t PieceSize = 1 << 20; // bytes that are read together

template <typename T> void Append(std::string& bytes, T value)
{
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::uint32_t ChecksumOf(const std::string& bytes)
{
  return ContinueChecksum(0, bytes.data(), bytes.size());
}

std::string HeaderText(const TrainingIdentity& identity, const TrainingState& state)
{
  const json header = {{"training", identity},
                       {"steps", state.steps},
                       {"planned_steps", state.plannedSteps},
                       {"seconds", state.seconds},
                       {"psnr", std::isfinite(state.psnr) ? state.psnr : 0.0},
                       {"finished", state.finished}};
  return header.dump(-1, ' ', /*ensure_ascii=*/true, json::error_handler_t::replace);
}

std::string HeaderBytes(const std::string& text)
{
  std::string bytes(Magic, NameSize);
  Append(bytes, Version);
  Append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
  Append(bytes, ChecksumOf(bytes));
  return bytes;
}

/// Name and length, as they precede the array.
std::string FrontOf(const StateArray& array)
{
  std::string bytes(array.name);
  bytes.resize(NameSize);
  Append(bytes, static_cast<std::uint64_t>(array.bytes));
  return bytes;
}

std::uint64_t Count(const JsonSection& section, const char* key)
{
  const std::int64_t value = section.integer(key);
  if (value < 0) {
    section.refuse(key, "is negative");
  }
  return static_cast<std::uint64_t>(value);
}

double FiniteNumber(const JsonSection& section, const char* key)
{
  const double value = section.number(key);
  if (!std::isfinite(value)) {
    section.refuse(key, "is not finite");
  }
  return value;
}

TrainingIdentity ParseIdentity(const JsonSection& section)
{
  TrainingIdentity identity;
  for (const auto& [name, value] : section.find("training")->items()) {
    if (!value.is_string()) {
      section.refuse("training", "holds something that is no text");
    }
    identity.emplace(name, value.get<std::string>());
  }
  return identity;
}

/// Without what is nested more deeply than a header is.
json ParseText(const std::string& text)
{
  constexpr int deepest = 4;
  const auto keep = [](int depth, json::parse_event_t, json&) { return depth <= deepest; };
  json header = json::parse(text, keep, /*allow_exceptions=*/false);
  if (!header.is_object()) {
    throw Error(ErrorCode::Malformed, "its header is not a JSON object");
  }
  return header;
}

InputFile Open(const std::string& path)
{
  try {
    return InputFile(path);
  } catch (const Error& error) {
    throw error.inContext("cannot read '" + path + "': ");
  }
}

[[noreturn]] void RefuseAsBroken(const std::string& why, std::int64_t byte = Error::NoOffset)
{
  throw Error(ErrorCode::Malformed, "it is not a whole checkpoint: " + why, byte);
}

} // namespace

std::int64_t WriteCheckpoint(const std::string& path, const TrainingIdentity& identity,
                             const TrainingState& state, const StateArrays& arrays)
{
  AtomicFile file(path);
  const std::string header = HeaderBytes(HeaderText(identity, state));
  file.write(header.data(), header.size());
  auto total = static_cast<std::int64_t>(header.size());
  for (const StateArray& array : arrays) {
    const std::string front = FrontOf(array);
    const auto bytes = static_cast<std::size_t>(array.bytes);
    const std::uint32_t checksum =
        ContinueChecksum(ContinueChecksum(0, array.data, bytes), front.data(), front.size());
    file.write(front.data(), front.size());
    file.write(array.data, bytes);
    file.write(&checksum, sizeof(checksum));
    total += static_cast<std::int64_t>(FrontSize) + array.bytes + ChecksumSize;
  }
  file.commit();
  return total;
}

CheckpointFile::CheckpointFile(const std::string& path) : Path(path), File(Open(path))
{
  try {
    this->readHeader();
  } catch (const Error& error) {
    throw error.inContext("cannot go on from '" + path + "': ");
  }
}

void CheckpointFile::readHeader()
{
  std::string start(StartSize, '\0');
  if (this->File.size() < static_cast<std::int64_t>(StartSize)) {
    RefuseAsBroken("the file has " + std::to_string(this->File.size()) + " bytes");
  }
  this->File.read(0, start.data(), start.size());
  if (start.compare(0, NameSize, Magic) != 0) {
    throw Error(ErrorCode::Malformed, "it is not a checkpoint of a training", 0);
  }
  const auto version = FromBytes<std::uint32_t>(start.data() + NameSize);
  if (version != Version) {
    throw Error(ErrorCode::Unsupported, "it has format version " + std::to_string(version) +
                                            ", this program reads version " +
                                            std::to_string(Version));
  }
  const std::int64_t length = FromBytes<std::uint32_t>(start.data() + NameSize + sizeof(version));
  const auto header = static_cast<std::int64_t>(StartSize);
  if (length > LargestHeader || header + length + ChecksumSize > this->File.size()) {
    RefuseAsBroken("its header would have " + std::to_string(length) + " bytes");
  }
  std::string text(static_cast<std::size_t>(length), '\0');
  this->File.read(header, text.data(), text.size());
  std::uint32_t checksum = 0;
  this->File.read(header + length, &checksum, sizeof(checksum));
  if (ChecksumOf(start + text) != checksum) {
    RefuseAsBroken("the checksum of its header is wrong");
  }
  this->FirstArray = header + length + ChecksumSize;
  this->parseHeader(text);
}

void CheckpointFile::parseHeader(const std::string& text)
{
  const json header = ParseText(text);
  const JsonSection section(header, "header");
  if (!section.section("training").present()) {
    section.refuse("training", "is missing");
  }
  this->Identity = ParseIdentity(section);
  this->State.steps = Count(section, "steps");
  this->State.plannedSteps = Count(section, "planned_steps");
  this->State.seconds = FiniteNumber(section, "seconds");
  this->State.psnr = FiniteNumber(section, "psnr");
  this->State.finished = section.boolean("finished", false);
  if (this->State.seconds < 0) {
    section.refuse("seconds", "is negative");
  }
}

void CheckpointFile::load(const StateArrays& arrays) const
{
  try {
    this->requireSize(arrays);
    this->readArrays(arrays, false);
    this->readArrays(arrays, true);
  } catch (const Error& error) {
    throw error.inContext("cannot go on from '" + this->Path + "': ");
  }
}

/// Nothing is allocated by what the file says: the arrays are there already.
void CheckpointFile::requireSize(const StateArrays& arrays) const
{
  std::int64_t size = this->FirstArray;
  for (const StateArray& array : arrays) {
    size += static_cast<std::int64_t>(FrontSize) + array.bytes + ChecksumSize;
  }
  if (size != this->File.size()) {
    RefuseAsBroken("the file has " + std::to_string(this->File.size()) +
                   " bytes where its model needs " + std::to_string(size));
  }
}

/// Checks them all; with `keep` fills them, too.
void CheckpointFile::readArrays(const StateArrays& arrays, bool keep) const
{
  std::vector<char> piece(static_cast<std::size_t>(keep ? 0 : PieceSize));
  std::int64_t at = this->FirstArray;
  for (const StateArray& array : arrays) {
    std::string front(FrontSize, '\0');
    this->File.read(at, front.data(), front.size());
    if (front != FrontOf(array)) {
      RefuseAsBroken(std::string("'") + array.name + "' is not what comes here", at);
    }
    at += static_cast<std::int64_t>(FrontSize);
    std::uint32_t checksum = 0;
    for (std::int64_t done = 0; done < array.bytes; done += PieceSize) {
      char* const to = keep ? static_cast<char*>(array.data) + done : piece.data();
      const auto bytes = static_cast<std::size_t>(std::min(PieceSize, array.bytes - done));
      this->File.read(at + done, to, bytes);
      checksum = ContinueChecksum(checksum, to, bytes);
    }
    at += array.bytes;
    std::uint32_t expected = 0;
    this->File.read(at, &expected, sizeof(expected));
    if (ContinueChecksum(checksum, front.data(), front.size()) != expected) {
      RefuseAsBroken(std::string("the checksum of '") + array.name + "' is wrong", at);
    }
    at += ChecksumSize;
  }
}

} // namespace inr

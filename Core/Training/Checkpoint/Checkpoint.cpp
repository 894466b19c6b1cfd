// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Checkpoint/Checkpoint.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/Model/LittleEndian.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Training/Checkpoint/CheckpointHeader.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <vector>

namespace inr {

namespace {

constexpr std::size_t NameSize = 8;
constexpr char Magic[NameSize + 1] = "INRtrain";
constexpr std::uint32_t PlainVersion = 1;
constexpr std::uint32_t SurveyVersion = 2;
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

/// In a file.
std::int64_t BytesOf(const StateArrays& arrays)
{
  std::int64_t bytes = 0;
  for (const StateArray& array : arrays) {
    bytes += static_cast<std::int64_t>(FrontSize) + array.bytes + ChecksumSize;
  }
  return bytes;
}

std::string HeaderBytes(const std::string& text, std::uint32_t version)
{
  std::string bytes(Magic, NameSize);
  Append(bytes, version);
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

/// Returns its size.
std::int64_t WriteArray(AtomicFile& file, const StateArray& array)
{
  const std::string front = FrontOf(array);
  const auto bytes = static_cast<std::size_t>(array.bytes);
  const std::uint32_t checksum =
      ContinueChecksum(ContinueChecksum(0, array.data, bytes), front.data(), front.size());
  file.write(front.data(), front.size());
  file.write(array.data, bytes);
  file.write(&checksum, sizeof(checksum));
  return static_cast<std::int64_t>(FrontSize) + array.bytes + ChecksumSize;
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
                             const TrainingState& state, const StateArrays& arrays,
                             const StateArrays& survey)
{
  AtomicFile file(path);
  const std::string header =
      HeaderBytes(CheckpointHeader(identity, state, BytesOf(survey), BytesOf(arrays)).text(),
                  survey.empty() ? PlainVersion : SurveyVersion);
  file.write(header.data(), header.size());
  auto total = static_cast<std::int64_t>(header.size());
  for (const StateArrays& part : {std::cref(survey), std::cref(arrays)}) {
    for (const StateArray& array : part) {
      total += WriteArray(file, array);
    }
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
  if (version != PlainVersion && version != SurveyVersion) {
    throw Error(ErrorCode::Unsupported, "it has format version " + std::to_string(version) +
                                            ", this program reads versions up to " +
                                            std::to_string(SurveyVersion));
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
  const CheckpointHeader parsed(text);
  const std::int64_t rest = this->File.size() - this->FirstArray - parsed.surveyBytes;
  if (parsed.surveyBytes > 0 && (rest < 0 || rest != parsed.trainingBytes)) {
    RefuseAsBroken("the file has " + std::to_string(this->File.size()) + " bytes");
  }
  this->Identity = parsed.identity;
  this->State = parsed.state;
  this->SurveyBytes = parsed.surveyBytes;
}

void CheckpointFile::load(const StateArrays& arrays) const
{
  try {
    const std::int64_t begin = this->FirstArray + this->SurveyBytes;
    if (begin + BytesOf(arrays) != this->File.size()) {
      RefuseAsBroken("the file has " + std::to_string(this->File.size()) +
                     " bytes where its model needs " + std::to_string(begin + BytesOf(arrays)));
    }
    this->readArrays(arrays, begin, false);
    this->readArrays(arrays, begin, true);
  } catch (const Error& error) {
    throw error.inContext("cannot go on from '" + this->Path + "': ");
  }
}

void CheckpointFile::loadSurvey(const StateArrays& survey) const
{
  try {
    if (BytesOf(survey) != this->SurveyBytes) {
      RefuseAsBroken("its survey has " + std::to_string(this->SurveyBytes) +
                     " bytes where this one has " + std::to_string(BytesOf(survey)));
    }
    this->requireWhole();
    this->readArrays(survey, this->FirstArray, false);
    this->readArrays(survey, this->FirstArray, true);
  } catch (const Error& error) {
    throw error.inContext("cannot go on from '" + this->Path + "': ");
  }
}

/// Whatever its arrays are.
void CheckpointFile::requireWhole() const
{
  std::int64_t at = this->FirstArray;
  while (at < this->File.size()) {
    const std::int64_t room =
        this->File.size() - at - static_cast<std::int64_t>(FrontSize) - ChecksumSize;
    std::string front(FrontSize, '\0');
    if (room >= 0) {
      this->File.read(at, front.data(), front.size());
    }
    const auto bytes = FromBytes<std::uint64_t>(front.data() + NameSize);
    if (room < 0 || bytes > static_cast<std::uint64_t>(room)) {
      RefuseAsBroken("an array goes beyond its end", at);
    }
    at = this->readArray(front, at, nullptr);
  }
}

/// Checks them all; with `keep` fills them, too. Nothing is allocated by what the file says: the
/// arrays are there already.
void CheckpointFile::readArrays(const StateArrays& arrays, std::int64_t at, bool keep) const
{
  for (const StateArray& array : arrays) {
    std::string front(FrontSize, '\0');
    this->File.read(at, front.data(), front.size());
    if (front != FrontOf(array)) {
      RefuseAsBroken(std::string("'") + array.name + "' is not what comes here", at);
    }
    at = this->readArray(front, at, keep ? static_cast<char*>(array.data) : nullptr);
  }
}

/// What comes behind `front`, which is at byte `at`; null = only checks it. Returns where it ends.
std::int64_t CheckpointFile::readArray(const std::string& front, std::int64_t at, char* to) const
{
  const auto size = static_cast<std::int64_t>(FromBytes<std::uint64_t>(front.data() + NameSize));
  std::vector<char> piece(static_cast<std::size_t>(to ? 0 : std::min(PieceSize, size)));
  at += static_cast<std::int64_t>(FrontSize);
  std::uint32_t checksum = 0;
  for (std::int64_t done = 0; done < size; done += PieceSize) {
    char* const there = to ? to + done : piece.data();
    const auto bytes = static_cast<std::size_t>(std::min(PieceSize, size - done));
    this->File.read(at + done, there, bytes);
    checksum = ContinueChecksum(checksum, there, bytes);
  }
  at += size;
  std::uint32_t expected = 0;
  this->File.read(at, &expected, sizeof(expected));
  if (ContinueChecksum(checksum, front.data(), front.size()) != expected) {
    RefuseAsBroken("the checksum of '" + std::string(front, 0, front.find('\0')) + "' is wrong",
                   at);
  }
  return at + ChecksumSize;
}

} // namespace inr

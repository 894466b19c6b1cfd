// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace inr {

/// The bytes of a binary value: a range of the file or, from a text file, decoded already.
struct Blob
{
  std::int64_t offset = 0; ///< in the file; meaningless where `bytes` holds the data
  std::int64_t size = 0;
  std::vector<std::uint8_t> bytes;
  bool inMemory = false;
};

/// A model file taken apart: a small header, and the blobs by their place in it.
struct Document
{
  /// From the leaves on: a json takes memory to destroy what holds something, and ends the process
  /// where there is none.
  struct Dismantle
  {
    void operator()(nlohmann::json* header) const;
  };
  std::unique_ptr<nlohmann::json, Dismantle> header{new nlohmann::json};
  std::map<std::string, Blob> blobs; ///< by JSON pointer ("/parameters/params_binary")
};

/// Builds a Document element by element, however the file spells them, and holds every limit that
/// keeps a hostile file from costing more than its size: depth, number and length of elements. It
/// also refuses duplicate keys and numbers that are not finite. All of it throws Error(Malformed).
/// `offset` is the element's position for messages, or Error::NoOffset.
class DocumentBuilder
{
public:
  static constexpr std::size_t MaximumDepth = 16;
  static constexpr std::size_t MaximumElements = 4096;
  static constexpr std::size_t MaximumTextLength = 4096; ///< of a key or string, in bytes

  enum class Container { Object, Array };

  /// `key` is ignored for the root and for elements of arrays.
  void begin(Container kind, const std::string& key, std::int64_t offset);
  void end();
  void value(const std::string& key, nlohmann::json value, std::int64_t offset);
  void blob(const std::string& key, Blob blob, std::int64_t offset);

  /// Makes the innermost open object stand for a blob (text files spell them as objects).
  void becomeBlob(Blob blob);

  /// True when the next element belongs to an object (and so has a key).
  bool inObject() const { return !this->Open.empty() && this->Open.back().node->is_object(); }

  Document finish() { return std::move(this->Result); }

private:
  struct Frame
  {
    nlohmann::json* node;
    nlohmann::json::json_pointer path;
  };

  nlohmann::json* append(const std::string& key, nlohmann::json value, std::int64_t offset);
  nlohmann::json::json_pointer pathOf(const std::string& key) const;

  Document Result;
  std::vector<Frame> Open;
  std::size_t Elements = 0;
};

} // namespace inr

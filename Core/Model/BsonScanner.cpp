// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/BsonScanner.h"

#include "Core/Error.h"
#include "Core/Model/BsonTypes.h"
#include "Core/Model/LittleEndian.h"

#include <algorithm>
#include <array>
#include <utility>

namespace inr {
namespace {

using Container = DocumentBuilder::Container;

constexpr std::int64_t SmallestDocument = 5; // its length and the closing zero

// Reads forward within a limit, through a small window of the file.
class Cursor
{
public:
  explicit Cursor(const InputFile& file) : File(file), Limit(file.size()) {}

  std::int64_t position() const { return this->Position; }
  void setLimit(std::int64_t limit) { this->Limit = limit; }

  std::uint8_t byte()
  {
    this->require(1);
    if (this->Position < this->WindowBegin || this->Position >= this->WindowEnd) {
      this->fill();
    }
    return this->Window[static_cast<std::size_t>(this->Position++ - this->WindowBegin)];
  }

  template <typename T> T number()
  {
    std::array<std::uint8_t, sizeof(T)> bytes{};
    this->require(sizeof(T));
    std::generate(bytes.begin(), bytes.end(), [this] { return this->byte(); });
    return FromBytes<T>(bytes.data());
  }

  std::string key()
  {
    std::string text;
    while (const std::uint8_t next = this->byte()) {
      text += static_cast<char>(next);
      if (text.size() > DocumentBuilder::MaximumTextLength) {
        throw Error(ErrorCode::Malformed, "a key does not end", this->Position);
      }
    }
    return text;
  }

  std::string text()
  {
    const std::int64_t at = this->Position;
    const auto length = this->number<std::int32_t>();
    if (length < 1 || static_cast<std::size_t>(length) > DocumentBuilder::MaximumTextLength) {
      throw Error(ErrorCode::Malformed,
                  "a string claims a length of " + std::to_string(length) + " bytes", at);
    }
    this->require(length);
    std::string text(static_cast<std::size_t>(length) - 1, '\0');
    std::generate(text.begin(), text.end(), [this] { return static_cast<char>(this->byte()); });
    if (this->byte() != 0) {
      throw Error(ErrorCode::Malformed, "a string does not end with a zero byte", at);
    }
    return text;
  }

  void skip(std::int64_t bytes)
  {
    this->require(bytes);
    this->Position += bytes;
  }

private:
  void require(std::int64_t bytes) const
  {
    if (bytes > this->Limit - this->Position) {
      throw Error(ErrorCode::Malformed,
                  "an element reaches beyond the end of its document; the file is truncated or "
                  "damaged",
                  this->Position);
    }
  }

  void fill()
  {
    const auto capacity = static_cast<std::int64_t>(this->Window.size());
    this->WindowBegin = this->Position;
    this->WindowEnd = std::min(this->File.size(), this->Position + capacity);
    this->File.read(this->WindowBegin, this->Window.data(),
                    static_cast<std::size_t>(this->WindowEnd - this->WindowBegin));
  }

  const InputFile& File;
  std::int64_t Position = 0;
  std::int64_t Limit;
  std::int64_t WindowBegin = 0;
  std::int64_t WindowEnd = 0;
  std::array<std::uint8_t, 4096> Window{};
};

class Scanner
{
public:
  explicit Scanner(const InputFile& file) : Size(file.size()), Input(file) {}

  Document run()
  {
    this->open(Container::Object, "", 0);
    while (!this->Ends.empty()) {
      this->element();
    }
    if (this->Input.position() != this->Size) {
      throw Error(ErrorCode::Malformed, "bytes follow the end of the document",
                  this->Input.position());
    }
    return this->Builder.finish();
  }

private:
  void open(Container kind, const std::string& key, std::int64_t at)
  {
    const std::int64_t begin = this->Input.position();
    const std::int64_t length = this->Input.number<std::int32_t>();
    const std::int64_t parentEnd = this->Ends.empty() ? this->Size : this->Ends.back();
    if (length < SmallestDocument || length > parentEnd - begin) {
      throw Error(ErrorCode::Malformed,
                  "a document claims a length of " + std::to_string(length) + " bytes where " +
                      std::to_string(parentEnd - begin) +
                      " are left; the file is truncated or damaged",
                  begin);
    }
    this->Builder.begin(kind, key, at);
    this->Ends.push_back(begin + length);
    this->Input.setLimit(this->Ends.back());
  }

  void close(std::int64_t at)
  {
    if (this->Input.position() != this->Ends.back()) {
      throw Error(ErrorCode::Malformed, "a document ends before its declared length", at);
    }
    this->Builder.end();
    this->Ends.pop_back();
    this->Input.setLimit(this->Ends.empty() ? this->Size : this->Ends.back());
  }

  void element()
  {
    const std::int64_t at = this->Input.position();
    const auto type = static_cast<BsonType>(this->Input.byte());
    if (type == BsonType::EndOfDocument) {
      this->close(at);
      return;
    }
    const std::string key = this->Input.key();
    switch (type) {
    case BsonType::Object:
      return this->open(Container::Object, key, at);
    case BsonType::Array:
      return this->open(Container::Array, key, at);
    case BsonType::Binary:
      return this->binary(key, at);
    default:
      return this->Builder.value(key, this->scalar(type, at), at);
    }
  }

  void binary(const std::string& key, std::int64_t at)
  {
    Blob blob;
    blob.size = this->Input.number<std::int32_t>();
    if (blob.size < 0) {
      throw Error(ErrorCode::Malformed, "'" + key + "' claims a negative length", at);
    }
    this->Input.byte(); // any subtype will do
    blob.offset = this->Input.position();
    this->Input.skip(blob.size);
    this->Builder.blob(key, std::move(blob), at);
  }

  nlohmann::json scalar(BsonType type, std::int64_t at)
  {
    switch (type) {
    case BsonType::Double:
      return this->Input.number<double>();
    case BsonType::String:
      return this->Input.text();
    case BsonType::Boolean:
      return this->Input.byte() != 0;
    case BsonType::Null:
      return nullptr;
    case BsonType::Int32:
      return this->Input.number<std::int32_t>();
    case BsonType::Int64:
      return this->Input.number<std::int64_t>();
    default:
      throw Error(ErrorCode::Malformed,
                  "there is no element type " + std::to_string(static_cast<int>(type)) +
                      " in a model file",
                  at);
    }
  }

  std::int64_t Size;
  Cursor Input;
  DocumentBuilder Builder;
  std::vector<std::int64_t> Ends; // of the open documents
};

} // namespace

Document ScanBson(const InputFile& file) { return Scanner(file).run(); }

std::string FirstBsonKey(const std::string& start)
{
  constexpr std::size_t Header = 5; // length and the first element's type
  if (start.size() <= Header || FromBytes<std::int32_t>(start.data()) < SmallestDocument) {
    return "";
  }
  const std::size_t end = start.find('\0', Header);
  return end == std::string::npos ? "" : start.substr(Header, end - Header);
}

} // namespace inr

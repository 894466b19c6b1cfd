// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/BsonScanner.h"

#include <algorithm>
#include <array>
#include <istream>
#include <limits>
#include <streambuf>
#include <utility>

namespace inr {
namespace {

using nlohmann::json;
using Container = DocumentBuilder::Container;

// The file as a stream, through a small window of it.
class FileBuffer : public std::streambuf
{
public:
  explicit FileBuffer(const InputFile& file) : File(file) {}

protected:
  int_type underflow() override
  {
    const std::int64_t left = this->File.size() - this->Position;
    const auto bytes = std::min(left, static_cast<std::int64_t>(this->Window.size()));
    if (bytes == 0) {
      return traits_type::eof();
    }
    this->File.read(this->Position, this->Window.data(), static_cast<std::size_t>(bytes));
    this->Position += bytes;
    this->setg(this->Window.data(), this->Window.data(), this->Window.data() + bytes);
    return traits_type::to_int_type(this->Window[0]);
  }

private:
  const InputFile& File;
  std::int64_t Position = 0;
  std::array<char, 1 << 14> Window{};
};

// Receives nlohmann's parsing events. An array under the key "bytes" goes straight into bytes: as
// JSON values it would take many times the file's size.
class TextHandler : public nlohmann::json_sax<json>
{
public:
  bool null() override { return this->value(nullptr); }
  bool boolean(bool value) override { return this->value(value); }
  bool number_integer(number_integer_t value) override { return this->number(value); }
  bool number_unsigned(number_unsigned_t value) override
  {
    constexpr auto Largest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    return value <= Largest ? this->number(static_cast<std::int64_t>(value))
                            : this->value(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return this->value(value); }
  bool string(string_t& value) override { return this->value(value); }
  bool binary(binary_t&) override { return this->value(nullptr); } // not in text

  bool start_object(std::size_t) override { return this->begin(Container::Object); }
  bool end_object() override { return this->end(); }
  bool start_array(std::size_t) override
  {
    this->requireNoBytes(); // else the array's end would be taken for that of the bytes
    this->CollectsBytes = this->Key == "bytes" && this->Builder.inObject();
    return this->CollectsBytes || this->begin(Container::Array);
  }
  bool end_array() override
  {
    if (!std::exchange(this->CollectsBytes, false)) {
      return this->end();
    }
    Blob blob;
    blob.bytes = std::move(this->Bytes);
    blob.size = static_cast<std::int64_t>(blob.bytes.size());
    blob.inMemory = true;
    this->Builder.becomeBlob(std::move(blob));
    this->Bytes = {};
    return true;
  }
  bool key(string_t& key) override
  {
    this->Key = key;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& failure) override
  {
    constexpr std::size_t Clipped = 200; // the message quotes the last token, whatever its length
    throw Error(ErrorCode::Malformed,
                "the text is not JSON: " + std::string(failure.what()).substr(0, Clipped),
                static_cast<std::int64_t>(position));
  }

  Document finish() { return this->Builder.finish(); }

private:
  bool begin(Container kind)
  {
    this->requireNoBytes();
    this->Builder.begin(kind, this->Key, Error::NoOffset);
    this->Key.clear();
    return true;
  }

  bool end()
  {
    this->Builder.end();
    return true;
  }

  bool number(std::int64_t value)
  {
    if (!this->CollectsBytes) {
      return this->value(value);
    }
    if (value < 0 || value > 255) {
      throw Error(ErrorCode::Malformed,
                  "'bytes' holds " + std::to_string(value) + ", which is no byte");
    }
    this->Bytes.push_back(static_cast<std::uint8_t>(value));
    return true;
  }

  bool value(json value)
  {
    this->requireNoBytes();
    this->Builder.value(this->Key, std::move(value), Error::NoOffset);
    return true;
  }

  void requireNoBytes() const
  {
    if (this->CollectsBytes) {
      throw Error(ErrorCode::Malformed, "'bytes' holds something that is no byte");
    }
  }

  DocumentBuilder Builder;
  std::string Key;
  std::vector<std::uint8_t> Bytes;
  bool CollectsBytes = false;
};

} // namespace

Document ScanJsonText(const InputFile& file)
{
  FileBuffer buffer(file);
  std::istream stream(&buffer);
  TextHandler handler;
  json::sax_parse(stream, &handler, json::input_format_t::json, /*strict=*/true,
                  /*ignore_comments=*/true);
  return handler.finish();
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Document.h"

#include "Core/Error.h"

#include <cmath>
#include <utility>

namespace inr {
namespace {

using nlohmann::json;

[[noreturn]] void Refuse(const std::string& reason, std::int64_t offset)
{
  throw Error(ErrorCode::Malformed, reason, offset);
}

void RequireShort(const std::string& text, std::int64_t offset)
{
  if (text.size() > DocumentBuilder::MaximumTextLength) {
    Refuse("a key or string is " + std::to_string(text.size()) + " bytes long; at most " +
               std::to_string(DocumentBuilder::MaximumTextLength) + " are accepted",
           offset);
  }
}

// No deeper than a document is.
void Clear(json& node)
{
  if (node.is_structured()) {
    for (json& child : node) {
      Clear(child);
    }
    node.clear();
  }
}

} // namespace

void Document::Dismantle::operator()(json* header) const
{
  Clear(*header);
  delete header;
}

void DocumentBuilder::begin(Container kind, const std::string& key, std::int64_t offset)
{
  if (this->Open.size() >= MaximumDepth) {
    Refuse("objects are nested deeper than " + std::to_string(MaximumDepth) + " levels", offset);
  }
  json empty = kind == Container::Object ? json::object() : json::array();
  if (this->Open.empty()) {
    *this->Result.header = std::move(empty);
    this->Open.push_back({this->Result.header.get(), json::json_pointer()});
    return;
  }
  const json::json_pointer path = this->pathOf(key);
  json* node = this->append(key, std::move(empty), offset);
  this->Open.push_back({node, path});
}

void DocumentBuilder::end() { this->Open.pop_back(); }

void DocumentBuilder::value(const std::string& key, json value, std::int64_t offset)
{
  if (this->Open.empty()) {
    Refuse("the document is not an object", offset);
  }
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    Refuse("'" + key + "' is not a finite number", offset);
  }
  if (value.is_string()) {
    RequireShort(value.get_ref<const std::string&>(), offset);
  }
  this->append(key, std::move(value), offset);
}

void DocumentBuilder::blob(const std::string& key, Blob blob, std::int64_t offset)
{
  const std::string path = this->pathOf(key).to_string();
  this->value(key, nullptr, offset);
  this->Result.blobs.emplace(path, std::move(blob));
}

void DocumentBuilder::becomeBlob(Blob blob)
{
  this->value("bytes", nullptr, Error::NoOffset); // a second one is a duplicate key
  this->Result.blobs.emplace(this->Open.back().path.to_string(), std::move(blob));
}

json* DocumentBuilder::append(const std::string& key, json value, std::int64_t offset)
{
  if (++this->Elements > MaximumElements) {
    Refuse("there are more than " + std::to_string(MaximumElements) + " elements", offset);
  }
  json& parent = *this->Open.back().node;
  if (parent.is_array()) {
    parent.push_back(std::move(value));
    return &parent.back();
  }
  RequireShort(key, offset);
  const auto [position, inserted] = parent.emplace(key, std::move(value));
  if (!inserted) {
    Refuse("the key '" + key + "' occurs twice", offset);
  }
  return &*position;
}

json::json_pointer DocumentBuilder::pathOf(const std::string& key) const
{
  const Frame& frame = this->Open.back();
  return frame.node->is_array() ? frame.path / frame.node->size() : frame.path / key;
}

} // namespace inr

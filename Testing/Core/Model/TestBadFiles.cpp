// SPDX-License-Identifier: BSD-3-Clause
//
// Every broken file gives one inr::Error that names it.
#include "Core/Error.h"
#include "Testing/Core/Model/TemporaryFolder.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <utility>

namespace test::bad_files {

struct BadFiles : testing::Test
{
  BadFiles() { this->start(*FullModel()); }

  void start(const inr::Model& model)
  {
    inr::WriteModel(model, Folder.file("good.inr"));
    this->Good = ReadBytes(Folder.file("good.inr"));
  }

  /// `words`: of the reason, where another one would do, too.
  void expectRefused(const std::string& bytes, const std::string& what,
                     const std::string& words = "")
  {
    const std::string path = Folder.file("bad.inr");
    WriteBytes(path, bytes);
    this->expectRefusedPath(path, what, words);
  }

  void expectRefusedPath(const std::string& path, const std::string& what,
                         const std::string& words = "")
  {
    try {
      inr::ReadModel(path);
      ADD_FAILURE() << what << " was accepted";
    } catch (const inr::Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(path), std::string::npos) << what;
      EXPECT_NE(message.find(words), std::string::npos) << what << ": " << message;
    }
  }

  /// `Good` with the bytes after the `skip`-th byte behind `key` replaced.
  std::string with(const std::string& key, std::size_t skip, const void* value, std::size_t size)
  {
    std::string bytes = this->Good;
    const std::size_t at = bytes.find(key + '\0');
    EXPECT_NE(at, std::string::npos) << key;
    std::memcpy(bytes.data() + at + key.size() + 1 + skip, value, size);
    return bytes;
  }

  TemporaryFolder Folder;
  std::string Good;
};

TEST_F(BadFiles, TheGoodOneIsGood) { EXPECT_NO_THROW(inr::ReadModel(Folder.file("good.inr"))); }

TEST_F(BadFiles, MissingEmptyAndFolders)
{
  this->expectRefusedPath(Folder.file("missing.inr"), "a missing file");
  this->expectRefusedPath(Folder.Path.string(), "a folder");
  this->expectRefused("", "an empty file");
}

TEST_F(BadFiles, OtherFormats)
{
  this->expectRefused("#INRIMAGE-4#{\nXDIM=3\nYDIM=3\n##}\n", "an INRIA image");
  this->expectRefused("{\"some\": \"json\"}", "other JSON");
  this->expectRefused("{\"model\": ", "half a JSON");
  this->expectRefused(std::string(5000, '\xff'), "noise");
}

TEST_F(BadFiles, BytesThatAreNone)
{
  for (const char* bytes : {"[[]]", "[[1, 2]]", "[1, [2]]", "[[1], 2]", "[{}]", "[\"1\"]", "[1.5]",
                            "[null]", "[-1]", "[256]"}) {
    const std::string blob = std::string("{\"bytes\": ") + bytes + "}";
    this->expectRefused("{\"n_params\": 1, \"params_binary\": " + blob + "}", bytes);
    this->expectRefused("{\"model\": {}, \"parameters\": {\"params_binary\": " + blob + "}}",
                        bytes);
  }
}

// The first bytes of a text are no length worth telling anybody about.
TEST_F(BadFiles, SaysOfATextThatItIsNoModel)
{
  WriteBytes(Folder.file("notes.inr"), "all about kittens\n");
  try {
    inr::ReadModel(Folder.file("notes.inr"));
    FAIL();
  } catch (const inr::Error& error) {
    EXPECT_NE(std::string(error.what()).find("not a model file"), std::string::npos)
        << error.what();
  }
}

TEST_F(BadFiles, TruncatedAnywhere)
{
  for (std::size_t length = 1; length < this->Good.size(); length += 97) {
    this->expectRefused(this->Good.substr(0, length), "cut to " + std::to_string(length));
  }
}

TEST_F(BadFiles, SomethingBehindTheEnd) { this->expectRefused(this->Good + "x", "a tail"); }

TEST_F(BadFiles, HugeClaims)
{
  const std::int32_t huge = 0x7fffffff;
  const std::int32_t negative = -5;
  for (const std::int32_t& length : {huge, negative}) {
    this->expectRefused(this->with("params_binary", 0, &length, 4), "a length of a blob");
    this->expectRefused(this->with("n_params", 0, &length, 4), "a number of parameters");
    this->expectRefused(this->with("n_levels", 0, &length, 4), "a number of levels");
    this->expectRefused(this->with("macrocell", 0, &length, 4), "a length of a document");
    this->expectRefused(this->with("n_neurons", 0, &length, 4), "a width");
    this->expectRefused(this->with("macrocell_apron", 0, &length, 4), "an apron");
  }
  // The first "x" belongs to our own dimensions: its neighbours' product must not overflow.
  std::string bytes = this->Good;
  for (const char* axis : {"x", "y", "z"}) {
    const std::size_t at = bytes.find(std::string("\x10") + axis + '\0', bytes.find("dims"));
    std::memcpy(bytes.data() + at + 3, &huge, 4);
  }
  this->expectRefused(bytes, "2^93 voxels");
}

TEST_F(BadFiles, DamagedParameters)
{
  const float other = 0.125f;
  this->expectRefused(this->with("params_binary", 5 + 40, &other, 4), "a parameter", "checksum");
  nlohmann::json document = nlohmann::json::from_bson(this->Good);
  document.erase("inr"); // and the checksum with it
  const std::vector<std::uint8_t> unchecked = nlohmann::json::to_bson(document);
  this->Good.assign(unchecked.begin(), unchecked.end());
  for (const float value : {NAN, HUGE_VALF}) {
    this->expectRefused(this->with("params_binary", 5 + 40, &value, 4), "a parameter",
                        "not a finite number");
    this->expectRefused(this->with("data", 5 + 8, &value, 4), "a range", "not a finite number");
  }
}

TEST_F(BadFiles, WrongWordsAndTypes)
{
  this->expectRefused(this->with("hash_rule", 4, "wrapperg", 8), "an unknown rule");
  this->expectRefused(this->with("array_type", 4, "uint61", 6), "an unknown type");
  const std::int32_t version = 99;
  this->expectRefused(this->with("format_version", 0, &version, 4), "a later version");
  std::string bytes = this->Good;
  bytes[bytes.find("n_params") - 1] = '\x08'; // a bool where a number belongs
  this->expectRefused(bytes, "a wrong type");
  bytes = this->Good;
  bytes[bytes.find("n_params") - 1] = '\x7f';
  this->expectRefused(bytes, "an unknown type tag");
}

/// `depth` documents inside each other.
std::string Nested(int depth)
{
  std::string inner("\x05\0\0\0\0", 5);
  for (int k = 0; k < depth; ++k) {
    const auto length = static_cast<std::int32_t>(inner.size() + 8);
    std::string outer("\0\0\0\0\x03"
                      "a\0",
                      7);
    std::memcpy(outer.data(), &length, 4);
    outer += inner;
    outer += '\0';
    inner = std::move(outer);
  }
  return inner;
}

TEST_F(BadFiles, DeepNesting) { this->expectRefused(Nested(2000), "2,000 levels"); }

TEST_F(BadFiles, DuplicateKeys)
{
  std::string bytes = this->Good;
  bytes.replace(bytes.find(std::string("ssim\0", 5)), 4, "psnr");
  this->expectRefused(bytes, "a duplicate", "'psnr' occurs twice");
  this->expectRefused(R"({"model": {}, "model": {}})", "a duplicate in a text",
                      "'model' occurs twice");
}

} // namespace test::bad_files

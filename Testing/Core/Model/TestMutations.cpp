// SPDX-License-Identifier: BSD-3-Clause
//
// Thousands of damaged files, the same on every run: each must load or give an inr::Error. What
// loads is decoded and drawn, some of it.
#include "Core/Error.h"
#include "Core/Model/ModelBytes.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Fuzzing/FuzzScene.h"

#include <cmath>

namespace test::mutations {

struct Mutations : testing::TestWithParam<bool>
{
  Mutations()
  {
    inr::WriteModel(this->GetParam() ? *CompactModel() : *FullModel(), Folder.file("good.inr"));
    this->Good = ReadBytes(Folder.file("good.inr"));
  }

  /// Anything but inr::Error ends the test.
  bool loads(const std::string& bytes)
  {
    try {
      const inr::ModelPointer model = this->read(bytes);
      if (this->Loaded++ < 60) {
        inr::Model shown = *model;
        shown.volume.spacing = glm::dvec3(1.0); // as it is, a ray would be of 10^11 voxels
        this->draw(std::make_shared<inr::Model>(std::move(shown)));
      }
      return true;
    } catch (const inr::Error&) {
      return false;
    }
  }

  /// Every tenth from a file: the rest is the same, and a disk may be busy.
  inr::ModelPointer read(const std::string& bytes)
  {
    if (this->Read++ % 10 != 0) {
      return inr::ModelFromBytes(bytes);
    }
    const std::string path = Folder.file("mutant.inr");
    WriteBytes(path, bytes);
    static_cast<void>(inr::IsModelFile(path));
    return inr::ReadModel(path);
  }

  /// From somewhere, in some way.
  void draw(const inr::ModelPointer& model)
  {
    std::vector<std::uint8_t> random(SceneSize);
    for (std::size_t k = 0; k < SceneSize; ++k) {
      random[k] = static_cast<std::uint8_t>(inr::RandomBits(this->Loaded, k));
    }
    SceneBytes bytes(random.data());
    const FuzzScene scene = MakeFuzzScene(model->volume, bytes);
    if (!scene.quick) {
      return;
    }
    try {
      inr::Renderer renderer(model, scene.options);
      renderer.setTransferFunction(scene.colors);
      inr::Image image;
      renderer.render(scene.frame, image);
      ++this->Drawn;
      for (const float value : image.pixels) {
        ASSERT_TRUE(std::isfinite(value)) << "picture " << this->Drawn;
      }
    } catch (const inr::Error&) { // a cache too small, a singular matrix
    }
  }

  TemporaryFolder Folder;
  std::string Good;
  std::uint64_t Read = 0;
  std::uint64_t Loaded = 0;
  int Drawn = 0;
};

TEST_P(Mutations, OfRandomBytes)
{
  int loaded = 0;
  for (std::uint64_t mutant = 0; mutant < 3000; ++mutant) {
    std::string bytes = this->Good;
    const int changes = 1 + static_cast<int>(inr::RandomBits(1, mutant) % 6);
    for (int k = 0; k < changes; ++k) {
      const std::uint64_t random = inr::RandomBits(mutant, static_cast<std::uint64_t>(k));
      // Most changes go where the structure is: the blobs are the bulk of the file.
      const std::size_t range =
          k % 3 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 2048);
      bytes[random % range] = static_cast<char>(random >> 40);
    }
    loaded += this->loads(bytes) ? 1 : 0;
  }
  EXPECT_LT(loaded, 1500); // most damage is noticed
  EXPECT_GT(this->Drawn, 5);
}

TEST_P(Mutations, OfAWindowThatSlidesOverTheHeader)
{
  for (const char fill : {'\0', '\x7f', '\xff'}) {
    for (std::size_t at = 0; at + 4 <= std::min<std::size_t>(this->Good.size(), 2048); at += 2) {
      std::string bytes = this->Good;
      bytes.replace(at, 4, std::string(4, fill));
      static_cast<void>(this->loads(bytes));
    }
  }
}

TEST_P(Mutations, OfLengths)
{
  for (std::uint64_t mutant = 0; mutant < 500; ++mutant) {
    std::string bytes = this->Good;
    const std::uint64_t random = inr::RandomBits(2, mutant);
    const std::size_t at = random % bytes.size();
    bytes.erase(at, 1 + (random >> 32) % 64);
    EXPECT_FALSE(this->loads(bytes)) << "without bytes from " << at;
  }
}

INSTANTIATE_TEST_SUITE_P(PlainAndCompact, Mutations, testing::Bool(),
                         testing::PrintToStringParamName());

} // namespace test::mutations

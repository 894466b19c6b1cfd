// SPDX-License-Identifier: BSD-3-Clause
//
// A hundred files opened, drawn and closed leave nothing behind: no memory, no open file, no
// thread.
#include "Core/Error.h"
#include "Core/Model/ModelFile.h"
#include "Testing/Core/Memory/FailingMemory.h"
#include "Testing/Core/Model/TemporaryFolder.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <chrono>
#include <filesystem>
#include <thread>

namespace test::open_and_close {

constexpr glm::i64vec3 Dims(17, 21, 13);

std::int64_t EntriesOf(const char* folder)
{
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

constexpr const char* Threads = "/proc/self/task";

/// One that was joined stands there until the kernel has time for it: on a busy machine later than
/// one would think.
void WaitForThreads(std::int64_t most)
{
  for (int tries = 0; EntriesOf(Threads) > most && tries < 3000; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

struct Leftovers
{
  std::int64_t blocks = BlocksInUse();
  std::int64_t files = EntriesOf("/proc/self/fd");
  std::int64_t threads = EntriesOf(Threads);
};

void OpenAndClose(const std::string& path, int round)
{
  const inr::ModelPointer model = inr::ReadModel(path);
  inr::RendererOptions options;
  options.threads = 2;
  options.cache = Options(inr::CachePrecision::Bits16, 8);
  inr::Renderer renderer(model, options);
  renderer.setTransferFunction(Colours());
  inr::Frame frame = Oblique(glm::dvec3(Dims), 16);
  frame.mode = round % 3 == 0 ? inr::RenderMode::PathTracing : inr::RenderMode::RayMarching;
  frame.samplesPerPixel = 1;
  frame.timeLimit = round % 2 == 0 ? 0.001 : 0; // bricks are still loading when it is closed
  inr::Image image;
  renderer.render(frame, image);
  EXPECT_THROW(inr::ReadModel(path + "-not"), inr::Error);
}

TEST(OpenAndClose, LeavesNothingBehind)
{
  const TemporaryFolder folder;
  const std::string path = folder.file("model.inr");
  auto model = RandomModel(SmallDescription());
  model->volume.dims = Dims;
  inr::WriteModel(*model, path);
  for (int round = 0; round < 12; ++round) { // what is made once
    OpenAndClose(path, round);
  }
  const Leftovers before;
  for (int round = 0; round < 100; ++round) {
    OpenAndClose(path, round);
  }
  WaitForThreads(before.threads);
  const Leftovers after;
  EXPECT_LE(after.blocks, before.blocks);
  EXPECT_LE(after.files, before.files);
  EXPECT_LE(after.threads, before.threads);
}

} // namespace test::open_and_close

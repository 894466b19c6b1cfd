// SPDX-License-Identifier: BSD-3-Clause
//
// How soon a model file gives something: a part of its voxels, a picture.
//
//   bench_random_access MODEL.inr SIDE
//
// prints one JSON object: wall and processor seconds from the file to SIDE^3 voxels out of the
// middle, to a first picture in the time that an interactive one has, and to a complete picture.
// random_access.py writes the result file.
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/FrameScenes.h"

#include <chrono>
#include <ctime>
#include <functional>

namespace {

constexpr int Repetitions = 5;
constexpr double Interactive = 0.1; ///< seconds

/// The best of a few runs by each clock, as a JSON array.
std::string Seconds(const std::function<void()>& work)
{
  double wall = 1e30;
  double processor = 1e30;
  for (int k = 0; k < Repetitions; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    wall = std::min(wall, taken.count());
    processor = std::min(processor, static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC);
  }
  std::ostringstream text;
  text << "[" << wall << ", " << processor << "]";
  return text.str();
}

void DecodeMiddle(const char* path, std::int64_t side)
{
  const inr::ModelPointer model = inr::ReadModel(path);
  const inr::Arena arena(Threads);
  const glm::i64vec3 dims = model->volume.dims;
  const glm::i64vec3 size = glm::min(dims, glm::i64vec3(side));
  std::vector<float> values(static_cast<std::size_t>(size.x * size.y * size.z));
  inr::EvaluateLattice(*inr::MakeEvaluator(model), arena,
                       inr::VoxelLattice(dims, (dims - size) / std::int64_t{2}, size),
                       values.data());
}

void Draw(const char* path, double timeLimit)
{
  const inr::ModelPointer model = inr::ReadModel(path);
  inr::Renderer renderer(model, Cached());
  renderer.setTransferFunction(Looks(model->volume).back().function);
  inr::Frame frame = View(model->volume);
  frame.timeLimit = timeLimit;
  inr::Image picture;
  renderer.render(frame, picture);
}

void Measure(const char* path, std::int64_t side)
{
  std::cout << R"({"part": )" << Seconds([&] { DecodeMiddle(path, side); })
            << R"(, "first picture": )" << Seconds([&] { Draw(path, Interactive); })
            << R"(, "complete picture": )" << Seconds([&] { Draw(path, 0); }) << "}" << std::endl;
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3) {
    std::cerr << "usage: bench_random_access MODEL.inr SIDE\n";
    return 2;
  }
  try {
    Measure(argv[1], std::stoll(argv[2]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}

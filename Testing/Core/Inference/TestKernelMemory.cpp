// SPDX-License-Identifier: BSD-3-Clause
//
// What kernels find in the memory that they are given, and what they leave of it.
#include "Core/Inference/ModelView.h"
#include "Core/Inference/OverflowWatch.h"
#include "Testing/Core/Inference/OddShapes.h"
#include "Testing/Core/Inference/RoundingKernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace test::kernel_memory {

/// A kernel's memory, full of something. Nobody writes behind it.
class Workspace
{
public:
  Workspace(std::int64_t bytes, unsigned char garbage)
      : Bytes(static_cast<std::size_t>(bytes) + Behind, garbage)
  {}
  ~Workspace()
  {
    EXPECT_TRUE(std::all_of(this->Bytes.end() - Behind, this->Bytes.end(),
                            [&](unsigned char byte) { return byte == this->Bytes.back(); }));
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  void* data() { return this->Bytes.data(); }

private:
  static constexpr int Behind = 4096;

  std::vector<unsigned char> Bytes;
};

class KernelMemory : public testing::Test
{
protected:
  /// Values at `count` points, computed in memory that is full of `garbage`.
  std::vector<float> atPoints(unsigned char garbage, const inr::InferenceKernels& kernels,
                              const inr::Model& model, std::int64_t count) const
  {
    const inr::ModelViewStorage views(model.description, inr::Layout(model.description),
                                      model.parameters.data());
    const inr::PackedNetwork network(views.view(), kernels.layout);
    const std::vector<glm::vec3> positions = RandomPositions(count);
    std::vector<float> values(positions.size());
    Workspace workspace(kernels.points->workspace(network.view()) * 4, garbage);
    kernels.points->evaluate(network.view(), &positions[0].x, count, values.data(),
                             static_cast<float*>(workspace.data()));
    return values;
  }

  /// The same on a lattice of width x height x 2 points.
  std::vector<float> onLattice(unsigned char garbage, const inr::InferenceKernels& kernels,
                               const inr::Model& model, int width, int height) const
  {
    const inr::ModelViewStorage views(model.description, inr::Layout(model.description),
                                      model.parameters.data());
    const inr::PackedNetwork network(views.view(), kernels.layout);
    std::vector<float> axis(12);
    for (std::size_t k = 0; k < axis.size(); ++k) {
      axis[k] = 0.08f * static_cast<float>(k) + 0.1f;
    }
    const inr::LatticeAxis axes[3] = {
        {axis.data(), width}, {axis.data(), height}, {axis.data(), 2}};
    std::vector<float> values(static_cast<std::size_t>(width * height * 2));
    Workspace workspace(kernels.lattices->workspace(network.view()), garbage);
    kernels.lattices->evaluate(network.view(), axes, values.data(), workspace.data());
    return values;
  }

  const RoundingKernels Rounding;
  const std::vector<inr::InferenceKernels> Kernels = AllKernels(Rounding);
  /// Thin and whole pieces, and strips that no vector fills, some of an odd number of rows.
  const std::vector<std::pair<int, int>> Lattices = {{1, 1}, {1, 11}, {3, 5},  {5, 4}, {7, 3},
                                                     {8, 1}, {8, 5},  {11, 3}, {9, 10}};
};

/// An overflow of numbers that belong to no sample would have samples done again.
TEST_F(KernelMemory, IsNotComputedWith)
{
  constexpr unsigned char large = 0x71; // 1e30
  for (const inr::Activation activation :
       {inr::Activation::Exponential, inr::Activation::Squareplus}) {
    const inr::ModelPointer model = CalmModel(ShapeOf(4, 2, 40, 2, activation));
    for (const inr::InferenceKernels& kernels : this->Kernels) {
      const inr::OverflowWatch watch;
      for (const std::int64_t count : {1, 16, 17, 32, 33, 40, 48, 49, 100}) {
        this->atPoints(large, kernels, *model, count);
        EXPECT_FALSE(watch.overflowed()) << kernels.name << " " << count;
      }
      for (const auto& [width, height] : this->Lattices) {
        this->onLattice(large, kernels, *model, width, height);
        EXPECT_FALSE(watch.overflowed()) << kernels.name << " " << width << " x " << height;
      }
    }
  }
}

TEST_F(KernelMemory, ChangesNoValue)
{
  constexpr unsigned char nan = 0xff;
  for (const inr::Description& description : OddShapes()) {
    const inr::ModelPointer model = CalmModel(description);
    for (const inr::InferenceKernels& kernels : this->Kernels) {
      EXPECT_EQ(this->atPoints(nan, kernels, *model, 39), this->atPoints(0, kernels, *model, 39))
          << kernels.name;
      for (const auto& [width, height] : this->Lattices) {
        EXPECT_EQ(this->onLattice(nan, kernels, *model, width, height),
                  this->onLattice(0, kernels, *model, width, height))
            << kernels.name << " " << width << " x " << height;
      }
    }
  }
}

} // namespace test::kernel_memory

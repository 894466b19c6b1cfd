// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels of the GPU, run on the host: the same source, with loops in place of threads.
#pragma once

#include "CUDA/Inference/BrickBatch.h"
#include "CUDA/Inference/Kernels/BrickKernels.h"
#include "CUDA/Inference/Overflow.h"
#include "CUDA/Inference/PackedModel.h"
#include "CUDA/Inference/Precision.h"
#include "Testing/CUDA/HostLaunch.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

/// A model's tables and how they are run, as DeviceModel has them on a GPU.
class EmulatedModel
{
public:
  EmulatedModel(inr::ModelPointer model, inr::cuda::Precision precision, HostLaunch launch)
      : Source(std::move(model)), Launch(launch)
  {
    using inr::cuda::Precision;
    if (precision == Precision::Half) {
      this->Half = std::make_unique<HalfModel>(*this->Source);
      return;
    }
    if (precision == Precision::Float32 && inr::cuda::WhyNotFused(*this->Source).empty()) {
      auto wide = std::make_unique<WideModel>(*this->Source);
      if (inr::cuda::FitsShared(*wide, MostShared)) {
        this->Wide = std::move(wide);
        return;
      }
    }
    const inr::Layout layout = inr::CheckedLayout(*this->Source);
    const inr::AlignedVector<float>& parameters = this->Source->parameters;
    this->Features.assign(parameters.begin() + static_cast<std::ptrdiff_t>(layout.gridOffset),
                          parameters.end());
    this->Plain = std::make_unique<inr::cuda::FloatTables>(*this->Source, parameters.data(),
                                                           this->Features.data());
  }

  const inr::ModelPointer& source() const { return this->Source; }
  const HostLaunch& launch() const { return this->Launch; }

  void inferPoints(const float* positions, std::int64_t count, float* values) const
  {
    this->inferPoints(positions, count, nullptr, values);
  }
  void inferPoints(const float* positions, const std::uint64_t* end, float* values) const
  {
    this->inferPoints(positions, 0, end, values);
  }

  void inferBricks(const inr::cuda::BrickBatch& batch, float* values) const
  {
    const auto count = static_cast<std::int64_t>(batch.jobs.size());
    this->inferBricks(batch.jobs.data(), count, batch.items, nullptr, values);
  }
  void inferBricks(const inr::cuda::BrickJob* jobs, const inr::cuda::BrickEnd* end,
                   float* values) const
  {
    this->inferBricks(jobs, 0, 0, end, values);
  }

private:
  static constexpr std::int64_t MostShared = 227 << 10; ///< of a block

  using HalfModel = inr::cuda::PackedModel<inr::cuda::HalfNumbers>;
  using WideModel = inr::cuda::PackedModel<inr::cuda::FloatNumbers>;

  void inferPoints(const float* positions, std::int64_t count, const std::uint64_t* end,
                   float* values) const
  {
    if (this->Plain) {
      std::vector<float> scratch = this->scratch();
      const inr::cuda::FloatPoints kernel{this->plainView(), positions, count, values,
                                          scratch.data(),    end};
      this->Launch.run(kernel, 0);
      return;
    }
    this->withFused([&](const auto& model, auto numbers) {
      const inr::cuda::FusedShared shared = this->plan(model, false);
      inr::cuda::WithTiles(model.neuronTiles, [&](auto tiles) {
        const inr::cuda::FusedPoints<decltype(tiles)::value, decltype(numbers)> kernel{
            model.view(), shared, positions, count, values, end};
        this->Launch.run(kernel, shared.end);
      });
    });
  }

  void inferBricks(const inr::cuda::BrickJob* jobs, std::int64_t count, std::int64_t items,
                   const inr::cuda::BrickEnd* end, float* values) const
  {
    if (this->Plain) {
      std::vector<float> scratch = this->scratch();
      const inr::cuda::FloatBricks kernel{this->plainView(), jobs, count, values,
                                          scratch.data(),    end};
      this->Launch.run(kernel, 0);
      return;
    }
    this->withFused([&](const auto& model, auto numbers) {
      const inr::cuda::FusedShared shared = this->plan(model, true);
      inr::cuda::WithTiles(model.neuronTiles, [&](auto tiles) {
        const inr::cuda::FusedBricks<decltype(tiles)::value, decltype(numbers)> kernel{
            model.view(), shared, jobs, count, items, values, end};
        this->Launch.run(kernel, shared.end);
      });
    });
  }

  /// Calls function(model, numbers) with the packed one.
  template <class Function> void withFused(const Function& function) const
  {
    if (this->Half) {
      function(*this->Half, inr::cuda::HalfNumbers());
    } else {
      function(*this->Wide, inr::cuda::FloatNumbers());
    }
  }

  template <class Packed> inr::cuda::FusedShared plan(const Packed& model, bool bricks) const
  {
    return inr::cuda::PlanShared(model, bricks, this->Launch.shared, MostShared);
  }
  inr::cuda::FloatModel plainView() const
  {
    return this->Plain->view(this->Plain->levels.data(), this->Plain->layers.data());
  }
  std::vector<float> scratch() const
  {
    const std::int64_t threads = std::int64_t{this->Launch.blocks} * inr::cuda::ThreadsPerBlock;
    return std::vector<float>(
        static_cast<std::size_t>(threads * inr::cuda::ScratchPerThread(this->plainView())));
  }

  inr::ModelPointer Source;
  HostLaunch Launch;
  std::unique_ptr<HalfModel> Half; ///< one of the three
  std::unique_ptr<WideModel> Wide;
  std::vector<float> Features;
  std::unique_ptr<inr::cuda::FloatTables> Plain;
};

class EmulatedEvaluator : public inr::Evaluator
{
public:
  explicit EmulatedEvaluator(std::shared_ptr<const EmulatedModel> model)
      : Model(std::move(model)), Core(inr::MakeEvaluator(this->Model->source()))
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    if (count > 0) {
      this->Model->inferPoints(&positions->x, count, values);
      const std::int64_t repaired = inr::cuda::RepairPoints(*this->Core, positions, count, values);
      EXPECT_EQ(repaired > 0, this->Model->launch().overflows) << repaired;
    }
  }
  std::string kernel() const override { return "emulated"; }

private:
  std::shared_ptr<const EmulatedModel> Model;
  std::shared_ptr<const Evaluator> Core;
};

class EmulatedBricks : public inr::BrickSource
{
public:
  EmulatedBricks(std::shared_ptr<const EmulatedModel> model, const inr::Hierarchy& levels)
      : BrickSource(levels), Model(std::move(model)),
        Core(inr::MakeBrickSource(inr::MakeEvaluator(this->Model->source()), levels))
  {}

  std::int64_t bricksAtOnce() const override { return 4; }

  void inferLayer(inr::BrickKey key, std::int64_t z, float* values) const override
  {
    this->inferLayers(&key, 1, z, 1, values);
  }
  void infer(const inr::BrickKey* keys, std::int64_t count, float* values,
             const inr::Arena&) const override
  {
    this->inferLayers(keys, count, 0, this->hierarchy().brickDims().z, values);
  }

private:
  void inferLayers(const inr::BrickKey* keys, std::int64_t count, std::int64_t z,
                   std::int64_t layers, float* values) const
  {
    inr::cuda::BrickBatch batch;
    for (std::int64_t k = 0; k < count; ++k) {
      batch.append(this->hierarchy(), keys[k], z, layers);
    }
    this->Model->inferBricks(batch, values);
    std::int64_t repaired = 0;
    for (std::int64_t k = 0; k < count; ++k) {
      repaired += inr::cuda::RepairLayers(*this->Core, keys[k], z, layers,
                                          values + batch.values / count * k);
    }
    EXPECT_EQ(repaired > 0, this->Model->launch().overflows) << repaired;
  }

  std::shared_ptr<const EmulatedModel> Model;
  std::shared_ptr<const BrickSource> Core;
};

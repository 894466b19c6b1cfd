// SPDX-License-Identifier: BSD-3-Clause
//
// Training as instantvnr does it with its default configuration, for comparison: batches of 65,536
// uniform positions, mean absolute error, Adam at 5e-3 that decays by 1 % every thousand steps from
// step 2000 on. Only its gradients of half precision are not imitated: these are float32.
#pragma once

#include "Core/Inference/EvaluateKernel.h"
#include "Core/Random.h"
#include "Core/Training/Descent/GradientDescent.h"

#include <cmath>
#include <vector>

class UpstreamRecipe
{
public:
  static constexpr std::int64_t Batch = 65536;

  UpstreamRecipe(const inr::Description& description, inr::InstructionSet set,
                 const inr::Arena& arena)
      : Threads(arena), Values(inr::EvaluateKernelFor(set)), Shape(description),
        Descent(description, 1, set, arena), FirstMoments(this->Shape.parameterCount),
        SecondMoments(this->Shape.parameterCount), Updates(this->Shape.parameterCount),
        Positions(Batch), Targets(Batch)
  {
    this->initialise();
  }

  void step(const inr::SampleSource& source)
  {
    this->drawBatch(source);
    this->aimBeyond();
    this->Descent.computeGradient(this->Positions, this->Targets);
    ++this->Steps;
    this->update();
  }

  const inr::AlignedVector<float>& parameters() { return this->Descent.parameters(); }

private:
  static constexpr std::int64_t BlockSize = 4096;

  /// Xavier-uniform weights; features uniform in +-1e-4.
  void initialise()
  {
    inr::AlignedVector<float>& parameters = this->Descent.parameters();
    const auto fill = [&](std::uint64_t begin, std::uint64_t end, float bound) {
      for (std::uint64_t k = begin; k < end; ++k) {
        parameters[k] = bound * (2.0f * inr::RandomUnit(1, k) - 1.0f);
      }
    };
    for (const inr::LayerShape& layer : this->Shape.layers) {
      const auto weights = static_cast<std::uint64_t>(layer.rows) * layer.columns;
      fill(layer.offset, layer.offset + weights,
           std::sqrt(6.0f / static_cast<float>(layer.rows + layer.columns)));
    }
    fill(this->Shape.gridOffset, this->Shape.parameterCount, 1e-4f);
  }

  void drawBatch(const inr::SampleSource& source)
  {
    const std::uint64_t drawn = this->Steps * Batch;
    this->Threads.forEachBlock(Batch, BlockSize, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k) {
        this->Positions[k] =
            inr::RandomPosition(2, drawn + static_cast<std::uint64_t>(k), source.dims());
      }
      source.sample(&this->Positions[begin], end - begin, &this->Targets[begin]);
    });
  }

  /// Moves each target to half a unit from the output, on the side where it lies: the gradient of
  /// the squared error, which GradientDescent computes, is then that of the absolute one.
  void aimBeyond()
  {
    const inr::PackedNetwork network(this->Descent.view());
    this->Threads.forEachBlock(Batch, BlockSize, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> outputs(BlockSize);
      std::vector<float> workspace(
          static_cast<std::size_t>(this->Values.workspace(network.view())));
      this->Values.evaluate(network.view(), &this->Positions[begin].x, end - begin, outputs.data(),
                            workspace.data());
      for (std::int64_t k = begin; k < end; ++k) {
        const float output = outputs[static_cast<std::size_t>(k - begin)];
        const float target = this->Targets[k];
        const auto sign = static_cast<float>(output > target) - static_cast<float>(output < target);
        this->Targets[k] = std::isnan(target) ? target : output - 0.5f * sign;
      }
    });
  }

  /// The factor is applied after step 2000, 3000, ...
  double learningRate() const
  {
    const std::uint64_t times = this->Steps > 2000 ? (this->Steps - 1001) / 1000 : 0;
    return 5e-3 * std::pow(0.99, static_cast<double>(times));
  }

  /// Adam. A feature without gradient is left alone and counts its own updates; the network's
  /// weights are drawn to 0.
  void update()
  {
    const inr::AlignedVector<float>& gradient = this->Descent.gradient();
    const auto updates = static_cast<double>(this->Steps);
    this->Corrections.push_back(std::sqrt(1.0 - std::pow(0.999, updates)) /
                                (1.0 - std::pow(0.9, updates)));
    const auto count = static_cast<std::int64_t>(gradient.size());
    const double rate = this->learningRate();
    this->Threads.forEachBlock(count, BlockSize, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k) {
        const bool weight = static_cast<std::uint64_t>(k) < this->Shape.gridOffset;
        if (weight || gradient[k] != 0.0f) {
          const float decay = weight ? 1e-6f * this->Descent.parameters()[k] : 0.0f;
          this->updateOne(k, gradient[k] + decay, rate);
        }
      }
    });
  }

  void updateOne(std::int64_t k, float gradient, double rate)
  {
    constexpr float beta1 = 0.9f;
    constexpr float beta2 = 0.999f;
    constexpr float epsilon = 1e-15f;
    float& first = this->FirstMoments[k];
    float& second = this->SecondMoments[k];
    const double correction = this->Corrections[++this->Updates[k]];
    first = beta1 * first + (1.0f - beta1) * gradient;
    second = beta2 * second + (1.0f - beta2) * gradient * gradient;
    this->Descent.parameters()[k] -=
        static_cast<float>(rate * correction * first / (std::sqrt(second) + epsilon));
  }

  const inr::Arena& Threads;
  const inr::EvaluateKernel& Values;
  inr::Layout Shape;
  inr::GradientDescent Descent;
  std::vector<float> FirstMoments;
  std::vector<float> SecondMoments;
  std::vector<std::uint32_t> Updates;   ///< of each parameter
  std::vector<double> Corrections{1.0}; ///< of Adam's bias, after so many updates
  std::vector<glm::vec3> Positions;
  std::vector<float> Targets;
  std::uint64_t Steps = 0;
};

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/AlignedVector.h"
#include "Core/Inference/ModelView.h"
#include "Core/Parallel.h"
#include "Core/Training/Descent/Descent.h"
#include "Core/Training/Descent/GradientExchange.h"
#include "Core/Training/Descent/GridGradient.h"
#include "Core/Training/Descent/Optimiser.h"
#include "Core/Training/Descent/TrainKernel.h"
#include "Core/Training/Runtime/LearningRate.h"
#include "Core/Training/Samples/BatchSource.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace inr {

/// Xavier-uniform MLP weights (SIREN's for sine; Sitzmann et al., NeurIPS 2020) and grid features
/// uniform in +-1e-4, from `seed`.
AlignedVector<float> InitialParameters(const Description& description, const Layout& layout,
                                       std::uint64_t seed);

/// Draws a whole mini-batch, which was prepared: batches.count() positions and targets.
void DrawBatch(const BatchSource& batches, std::uint64_t stream, std::uint64_t step,
               const Arena& arena, glm::vec3* positions, float* targets);

/// Fits the parameters of one INR on mini-batches, by the CPU: features of the grid with Adam, the
/// network as Optimiser.h says. The parameters after n steps depend on description, seed, plan,
/// batches and instruction set, not on the number of threads.
class GradientDescent : public Descent
{
public:
  GradientDescent(const Description& description, std::uint64_t seed, InstructionSet set,
                  const Arena& arena);
  /// Before the first step: takes these parameters instead of random ones. The learning rate is the
  /// same: half of it gains some tenths of a dB in one time step, and may lose them after several.
  void startFrom(const AlignedVector<float>& parameters);

  /// Parameters, their first and second moments (float), and how often each parameter of the grid
  /// was updated (uint16; it stops where nothing depends on it any more), in this order.
  StateArrays state() override;
  void goOnAfter(std::uint64_t steps) override { this->Steps = steps; }
  void startAnew(std::uint64_t seed) override;

  /// Before the first step: the mini-batches are shares of larger ones, and the parameters of all
  /// processes stay the same. The group must outlive this.
  void share(const TrainingGroup& group);

  /// How long this process has waited for the others and told them its gradients.
  ExchangeTimes exchangeTimes() const
  {
    return this->Exchange ? this->Exchange->times() : ExchangeTimes();
  }

  /// After the last step: leaves what state() tells.
  void freeWorkspace();

  void plan(std::uint64_t steps) override { this->PlannedSteps = steps; }

  /// In a group all must call it; it returns the same to all, and throws when one's does.
  std::optional<double> step(BatchSource& batches, const StopCheck& check = StopCheck()) override;

  /// Fills gradient() with d (mean (output - target)^2) / d parameter for `count` samples (targets
  /// that are NaN count as fitted) and returns the mean; nothing when `check` stopped it.
  std::optional<double> computeGradient(const std::vector<glm::vec3>& positions,
                                        const std::vector<float>& targets,
                                        const StopCheck& check = StopCheck());

  std::uint64_t steps() const override { return this->Steps; }
  const ModelView& view() override { return this->Views.view(); }
  AlignedVector<float>& parameters() override { return this->Parameters; }
  std::size_t weightCount() const { return this->Shape.gridOffset; } ///< parameters before the grid
  std::vector<LayerShape> orthogonalisedLayers() const;              ///< see Optimiser.h
  std::size_t firstOtherWeight() const; ///< of the layers behind them, which Adam updates
  std::uint64_t stream() const;         ///< of the random numbers of mini-batches
  const AlignedVector<float>& gradient() const { return this->Gradient; }

private:
  std::optional<double> computeTogether(BatchSource& batches, const StopCheck& check);
  std::optional<double> computeShare(BatchSource& batches, const StopCheck& check);
  std::optional<double> backpropagate(const std::vector<glm::vec3>& positions,
                                      const std::vector<float>& targets, std::int64_t total,
                                      const StopCheck& check);
  void encode(const float* xyz, std::int64_t count, const StopCheck& check);
  void backpropagateShard(std::int64_t shard, const float* targets, std::int64_t begin,
                          std::int64_t end, std::int64_t total, const StopCheck& check);
  void sumShards();
  void scatter(const float* xyz, std::int64_t count, const StopCheck& check);
  void update();
  void updateLayers(float learningRate);
  AdamRun adamFrom(std::size_t first, float decay);
  void updateOtherLayers(float learningRate);
  void updateGrid(float learningRate);

  const Arena& Threads;
  std::optional<GradientExchange> Exchange; ///< empty = alone
  const TrainKernel& Kernel;
  Description Kind;
  Layout Shape;
  std::size_t Orthogonalised; ///< so many layers, whose second moments stay zero
  std::uint64_t Seed;
  std::uint64_t Steps = 0;
  std::uint64_t PlannedSteps = std::numeric_limits<std::uint64_t>::max();
  LearningRate Rate;
  AlignedVector<float> Parameters;
  ModelViewStorage Views;
  AlignedVector<float> Gradient;
  GridGradient Grid; ///< marks in `Gradient`
  AlignedVector<float> FirstMoments;
  AlignedVector<float> SecondMoments;
  AlignedVector<std::uint16_t> Updates; ///< of each parameter of the grid
  std::vector<AdamStep> Updating;       ///< by the number of the update
  std::vector<glm::vec3> Positions;
  std::vector<float> Targets;
  AlignedVector<float> Encoded; ///< features of the batch, then their gradients
  std::vector<std::vector<float>> ShardGradients;
  std::vector<double> ShardLosses;
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Training/Kernels/TrainDraw.h"
#include "CUDA/Training/Kernels/TrainLayers.h"
#include "CUDA/Training/Kernels/TrainNetwork.h"
#include "CUDA/Training/Kernels/TrainUpdate.h"
#include "CUDA/Training/PackedVolume.h"
#include "CUDA/Training/TrainingPlan.h"
#include "Core/Inference/ModelView.h"
#include "Core/Training/Descent/AdamSchedule.h"
#include "Core/Training/Descent/GradientDescent.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace inr {
namespace cuda {

/// A training on a machine (CUDA/Device/Machine.h).
///
/// A step is nine launches, eight where Adam updates all, and two more for each further piece of a
/// batch whose layers would take more than 256 MiB: draw or copy the samples, encode them, then
/// through the network and back, weights' gradients, grid's gradients, update. The host waits for
/// it once, for the loss.
template <class Machine> class MachineTraining : public AcceleratedTraining
{
public:
  MachineTraining(std::unique_ptr<Machine> machine, const TrainingTask& task,
                  const TrainingPlan& plan)
      : Place(std::move(machine)), Count(task.samples), Stream(task.stream), Plan(plan),
        Shape(task.description), WeightCount(static_cast<std::int64_t>(this->Shape.gridOffset)),
        ParameterCount(static_cast<std::int64_t>(this->Shape.parameterCount)),
        GridCount(this->ParameterCount - this->WeightCount),
        Orthogonalised(OrthogonalisedLayers(task.description.network)),
        Weights(this->Place->template allocate<float>(this->WeightCount)),
        Features(this->Place->template allocate<float>(this->GridCount)),
        FirstMoments(this->Place->template allocate<float>(this->ParameterCount)),
        SecondMoments(this->Place->template allocate<float>(this->ParameterCount)),
        Updates(this->Place->template allocate<std::uint16_t>(this->GridCount)),
        Sums(this->Place->template allocate<std::uint64_t>(this->GridCount)),
        Touched(this->Place->template allocate<std::uint8_t>(Lines(this->GridCount))),
        ShardGradients(this->Place->template allocate<float>(plan.shards * this->WeightCount)),
        Positions(this->Place->template allocate<float>(3 * this->Count)),
        Targets(this->Place->template allocate<float>(this->Count)),
        Encoded(this->Place->template allocate<float>(this->Count * this->Shape.encodedWidth)),
        EncodedDelta(this->Place->template allocate<float>(this->Count * this->Shape.encodedWidth)),
        LayerRows(this->Place->template allocate<float>(
            plan.pieceSize * LayerFloats(task.description, this->Shape))),
        UpdateRows(this->Place->template allocate<float>(
            this->Orthogonalised * LargestUpdate(this->Shape, this->Orthogonalised))),
        Losses(this->Place->template allocate<double>(TilesOf(this->Count))),
        Largest(this->Place->template allocate<std::uint32_t>(1)),
        Schedule(this->uploaded(AdamUpdates())), Updating(AdamUpdates()),
        Levels(this->levelsOf(task.description)), Layers(this->layersOf(task.description))
  {
    // Sums and marks are zero between steps, gradients of weights without an input always.
    this->Place->fill(this->Sums.data(), 0, this->GridCount);
    this->Place->fill(this->Touched.data(), 0, Lines(this->GridCount));
    this->Place->fill(this->ShardGradients.data(), 0, plan.shards * this->WeightCount);
    if (plan.holdsVolume) {
      this->Volume.emplace(*this->Place, *task.volume, this->Count);
    } else {
      for (int k = 0; k < 2; ++k) {
        this->Staged.push_back({this->Place->template allocatePinned<float>(3 * this->Count),
                                this->Place->template allocatePinned<float>(this->Count)});
      }
    }
  }

  ~MachineTraining() override
  {
    try {
      this->Place->wait(); // for what uses the memory that is about to go
    } catch (const Error&) {
      return; // it has failed: nothing is on its way
    }
  }

  bool drawsSamples() const override { return this->Volume.has_value(); }

  void put(const StateArrays& state) override
  {
    const auto* const values = static_cast<const float*>(state[0].data);
    this->Place->toMachine(this->Weights.data(), values, this->WeightCount);
    this->Place->toMachine(this->Features.data(), values + this->WeightCount, this->GridCount);
    this->Place->toMachine(this->FirstMoments.data(), static_cast<const float*>(state[1].data),
                           this->ParameterCount);
    this->Place->toMachine(this->SecondMoments.data(), static_cast<const float*>(state[2].data),
                           this->ParameterCount);
    this->Place->toMachine(this->Updates.data(), static_cast<const std::uint16_t*>(state[3].data),
                           this->GridCount);
  }

  void get(const StateArrays& state) override
  {
    auto* const values = static_cast<float*>(state[0].data);
    this->Place->toHost(values, this->Weights.data(), this->WeightCount);
    this->Place->toHost(values + this->WeightCount, this->Features.data(), this->GridCount);
    this->Place->toHost(static_cast<float*>(state[1].data), this->FirstMoments.data(),
                        this->ParameterCount);
    this->Place->toHost(static_cast<float*>(state[2].data), this->SecondMoments.data(),
                        this->ParameterCount);
    this->Place->toHost(static_cast<std::uint16_t*>(state[3].data), this->Updates.data(),
                        this->GridCount);
  }

  Samples samples(int buffer) override
  {
    const auto& [positions, targets] = this->Staged[static_cast<std::size_t>(buffer)];
    return {reinterpret_cast<glm::vec3*>(positions.data()), targets.data()};
  }

  void begin(const Step& step) override
  {
    if (this->Volume) {
      this->Volume->draw(*this->Place, this->Stream, step.number, this->Positions.data(),
                         this->Targets.data());
    } else {
      const auto& [positions, targets] = this->Staged[static_cast<std::size_t>(step.buffer)];
      this->Place->beginToMachine(this->Positions.data(), positions.data(), 3 * this->Count);
      this->Place->beginToMachine(this->Targets.data(), targets.data(), this->Count);
    }
    this->computeGradient();
    this->update(step.number + 1, step.learningRate);
  }

  double finish() override
  {
    std::vector<double> losses(static_cast<std::size_t>(TilesOf(this->Count)));
    this->Place->toHost(losses.data(), this->Losses.data(), TilesOf(this->Count));
    return std::accumulate(losses.begin(), losses.end(), 0.0) / static_cast<double>(this->Count);
  }

private:
  template <class T> using Array = typename Machine::template Array<T>;

  static std::int64_t Lines(std::int64_t parameters)
  {
    return (parameters + GradientLine - 1) / GradientLine;
  }

  template <class T> Array<T> uploaded(const std::vector<T>& from) const
  {
    const auto count = static_cast<std::int64_t>(from.size());
    auto array = this->Place->template allocate<T>(count);
    this->Place->toMachine(array.data(), from.data(), count);
    return array;
  }

  Array<LevelView> levelsOf(const Description& description)
  {
    const ModelViewStorage views(description, this->Shape, this->Weights.data());
    const ModelView& view = views.view();
    this->Grid = {nullptr, view.levelCount, view.features, view.interpolation,
                  this->Features.data()};
    auto levels =
        this->uploaded(std::vector<LevelView>(view.levels, view.levels + view.levelCount));
    this->Grid.levels = levels.data();
    return levels;
  }

  /// Layers, whose rows follow each other in LayerRows.
  Array<TrainLayer> layersOf(const Description& description)
  {
    const NetworkDescription& network = description.network;
    const std::int64_t stride = this->Plan.pieceSize;
    float* rows = this->LayerRows.data();
    const auto take = [&](std::int64_t count) {
      return std::exchange(rows, rows + count * stride);
    };
    std::vector<TrainLayer> layers;
    this->WeightTiles = 0;
    for (const LayerShape& shape : this->Shape.layers) {
      const bool isFirst = layers.empty();
      const bool isLast = &shape == &this->Shape.layers.back();
      TrainLayer layer{};
      layer.weights = this->Weights.data() + shape.offset;
      layer.rows = isLast ? 1 : shape.rows;
      layer.columns = shape.columns;
      layer.used = isFirst ? this->Shape.encodedWidth : shape.columns;
      layer.firstWeight = static_cast<std::int64_t>(shape.offset);
      layer.activation = isLast ? network.outputActivation : network.activation;
      layer.input = isFirst ? this->Encoded.data() : layers.back().after;
      layer.inputStride = isFirst ? this->Count : stride;
      layer.before = SlopeFromResult(layer.activation) ? nullptr : take(layer.rows);
      layer.after = take(layer.rows);
      layer.delta = take(layer.rows);
      layer.inputDelta = isFirst ? this->EncodedDelta.data() : layers.back().delta;
      this->WeightTiles += TrainWeights::tilesOf(layer);
      layers.push_back(layer);
    }
    return this->uploaded(layers);
  }

  /// Sums of the grid in units, weights' gradients in shards, losses.
  void computeGradient()
  {
    const std::int64_t levelsOfSamples = this->Grid.levelCount * this->Count;
    this->Place->fill(this->Largest.data(), 0, 1);
    this->Place->run(
        TrainEncode{this->Grid, this->Positions.data(), this->Count, this->Encoded.data()},
        levelsOfSamples);
    for (std::int64_t first = 0; first < this->Count; first += this->Plan.pieceSize) {
      this->backpropagate(first, std::min(this->Plan.pieceSize, this->Count - first));
    }
    this->Place->run(TrainScatter{this->Grid, this->Positions.data(), this->Count,
                                  this->EncodedDelta.data(), this->Largest.data(),
                                  this->Sums.data(), this->Touched.data()},
                     levelsOfSamples);
  }

  void backpropagate(std::int64_t first, std::int64_t count)
  {
    const auto layerCount = static_cast<int>(this->Shape.layers.size());
    const TrainPiece piece{this->Layers.data(), layerCount, this->Plan.pieceSize, first, count};
    this->Place->run(TrainNetwork{piece, this->Targets.data(),
                                  1.0f / static_cast<float>(this->Count), this->Losses.data(),
                                  this->Largest.data()},
                     TilesOf(count) * WarpSize, TrainNetwork::SharedBytes);
    const std::int64_t shards = (count + this->Plan.shardSize - 1) / this->Plan.shardSize;
    this->Place->run(TrainWeights{piece, this->Plan.shardSize, this->WeightCount,
                                  this->ShardGradients.data(), first > 0},
                     shards * this->WeightTiles * WarpSize, TrainWeights::SharedBytes);
  }

  void update(std::uint64_t number, float learningRate)
  {
    this->Place->run(
        TrainSumShards{this->ShardGradients.data(), this->WeightCount, this->Plan.shards},
        this->WeightCount);
    if (this->Orthogonalised > 0) {
      this->Place->run(
          TrainUpdateLayers{this->Layers.data(), this->Orthogonalised, this->Weights.data(),
                            this->FirstMoments.data(), this->ShardGradients.data(), MomentumKept,
                            learningRate * OrthogonalRate(number), this->UpdateRows.data(),
                            LargestUpdate(this->Shape, this->Orthogonalised)},
          this->Orthogonalised * TrainUpdateLayers::Threads, TrainUpdateLayers::SharedBytes);
    }
    AdamRun run{this->Weights.data(),
                this->ShardGradients.data(),
                this->FirstMoments.data(),
                this->SecondMoments.data(),
                FirstMomentKept,
                AdamEpsilon,
                WeightDecay};
    AdamStep step =
        this->Updating[static_cast<std::size_t>(std::min<std::uint64_t>(number, LastAdamUpdate))];
    step.rate *= learningRate;
    const auto first = static_cast<std::int64_t>(
        this->Shape.layers[static_cast<std::size_t>(this->Orthogonalised)].offset);
    this->Place->run(TrainUpdateWeights{run, first, this->WeightCount, step},
                     this->WeightCount - first);
    run.parameters = this->Features.data();
    run.gradients = nullptr;
    run.firstMoments += this->WeightCount;
    run.secondMoments += this->WeightCount;
    this->Place->run(TrainUpdateGrid{run,
                                     this->Sums.data(),
                                     this->Touched.data(),
                                     this->Updates.data(),
                                     this->GridCount,
                                     this->Largest.data(),
                                     this->Count,
                                     learningRate,
                                     {this->Schedule.data(), LastAdamUpdate}},
                     Lines(this->GridCount));
  }

  const std::unique_ptr<Machine> Place;
  std::int64_t Count;
  std::uint64_t Stream;
  TrainingPlan Plan;
  Layout Shape;
  std::int64_t WeightCount;
  std::int64_t ParameterCount;
  std::int64_t GridCount;
  int Orthogonalised; ///< layers
  Array<float> Weights;
  Array<float> Features;
  Array<float> FirstMoments;
  Array<float> SecondMoments;
  Array<std::uint16_t> Updates;
  Array<std::uint64_t> Sums;
  Array<std::uint8_t> Touched;
  Array<float> ShardGradients;
  Array<float> Positions;
  Array<float> Targets;
  Array<float> Encoded;
  Array<float> EncodedDelta;
  Array<float> LayerRows;
  Array<float> UpdateRows;
  Array<double> Losses;
  Array<std::uint32_t> Largest;
  Array<AdamStep> Schedule;
  std::vector<AdamStep> Updating;
  GridView<float> Grid{};
  std::int64_t WeightTiles = 0;
  Array<LevelView> Levels;
  Array<TrainLayer> Layers;
  std::optional<PackedVolume<Machine>> Volume;               ///< where it is there
  std::vector<std::pair<Array<float>, Array<float>>> Staged; ///< else: two of positions, targets
};

} // namespace cuda
} // namespace inr

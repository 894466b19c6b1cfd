// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Descent/GradientDescent.h"

#include "Core/Error.h"
#include "Core/Inference/HugePages.h"
#include "Core/Training/Descent/AdamSchedule.h"
#include "Core/Training/Samples/RandomStream.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <numeric>
#include <string>

namespace inr {

namespace {

/// Samples whose weight gradients are summed in one buffer; the buffers are then added in order.
constexpr std::int64_t ShardSize = 2 * TrainBlockSize;

/// Samples that a thread encodes on a level at a time: many, so that it stays with the level's
/// table.
constexpr std::int64_t EncodePiece = 8 * TrainBlockSize;

/// Samples between two looks at the StopCheck: a block, but less of one where the network is so
/// large that a block takes seconds. A power of two; depends on the network alone, as sums do on
/// it.
std::int64_t SamplesPerCheck(std::uint64_t weights)
{
  constexpr std::uint64_t mostProducts = std::uint64_t{1} << 29;
  constexpr std::int64_t fewest = 16;
  std::int64_t samples = TrainBlockSize;
  while (samples > fewest && static_cast<std::uint64_t>(samples) * weights > mostProducts) {
    samples /= 2;
  }
  return samples;
}

float InitialBound(const Description& description, const Layout& layout, std::size_t layer)
{
  const LayerShape& shape = layout.layers[layer];
  if (description.network.activation != Activation::Sine) {
    return std::sqrt(6.0f / static_cast<float>(shape.rows + shape.columns));
  }
  const float columns = static_cast<float>(shape.columns);
  return layer == 0 ? 30.0f / columns : std::sqrt(6.0f / columns);
}

} // namespace

AlignedVector<float> InitialParameters(const Description& description, const Layout& layout,
                                       std::uint64_t seed)
{
  constexpr float gridBound = 1e-4f;
  const std::uint64_t stream = StreamSeed(seed, RandomStream::InitialParameters);
  AlignedVector<float> parameters(layout.parameterCount);
  const auto fill = [&](std::uint64_t begin, std::uint64_t end, float bound) {
    for (std::uint64_t k = begin; k < end; ++k) {
      parameters[k] = bound * (2.0f * RandomUnit(stream, k) - 1.0f);
    }
  };
  for (std::size_t l = 0; l < layout.layers.size(); ++l) {
    const LayerShape& layer = layout.layers[l];
    const std::uint64_t weights = static_cast<std::uint64_t>(layer.rows) * layer.columns;
    fill(layer.offset, layer.offset + weights, InitialBound(description, layout, l));
  }
  fill(layout.gridOffset, layout.parameterCount, gridBound);
  return parameters;
}

void DrawBatch(const BatchSource& batches, std::uint64_t stream, std::uint64_t step,
               const Arena& arena, glm::vec3* positions, float* targets)
{
  arena.forEachBlock(batches.count(), ShardSize, [&](std::int64_t begin, std::int64_t end) {
    batches.draw(stream, step, begin, end, positions + begin, targets + begin);
  });
}

GradientDescent::GradientDescent(const Description& description, std::uint64_t seed,
                                 InstructionSet set, const Arena& arena)
    : Threads(arena), Kernel(TrainKernelFor(set)), Kind(description), Shape(description),
      Orthogonalised(static_cast<std::size_t>(OrthogonalisedLayers(description.network))),
      Seed(seed), Parameters(InitialParameters(description, this->Shape, seed)),
      Views(description, this->Shape, this->Parameters.data()), Gradient(this->Parameters.size()),
      Grid(this->Views.view(), this->Gradient.data() + this->Shape.gridOffset),
      FirstMoments(this->Parameters.size()), SecondMoments(this->Parameters.size()),
      Updates(this->Parameters.size() - this->Shape.gridOffset), Updating(AdamUpdates())
{
  for (AlignedVector<float>* const values :
       {&this->Parameters, &this->Gradient, &this->FirstMoments, &this->SecondMoments}) {
    PreferHugePages(values->data(), values->size() * sizeof(float));
  }
  PreferHugePages(this->Updates.data(), this->Updates.size() * sizeof(std::uint16_t));
}

void GradientDescent::startFrom(const AlignedVector<float>& parameters)
{
  std::copy(parameters.begin(), parameters.end(), this->Parameters.begin());
}

void GradientDescent::startAnew(std::uint64_t seed)
{
  this->startFrom(InitialParameters(this->Kind, this->Shape, seed));
  std::fill(this->FirstMoments.begin(), this->FirstMoments.end(), 0.0f);
  std::fill(this->SecondMoments.begin(), this->SecondMoments.end(), 0.0f);
  std::fill(this->Updates.begin(), this->Updates.end(), std::uint16_t{0});
}

void GradientDescent::share(const TrainingGroup& group)
{
  if (group.size() > 1) {
    this->Exchange.emplace(group, this->Threads);
  }
}

std::vector<LayerShape> GradientDescent::orthogonalisedLayers() const
{
  const auto first = this->Shape.layers.begin();
  return {first, first + static_cast<std::ptrdiff_t>(this->Orthogonalised)};
}

std::size_t GradientDescent::firstOtherWeight() const
{
  return this->Shape.layers[this->Orthogonalised].offset;
}

std::uint64_t GradientDescent::stream() const
{
  return StreamSeed(this->Seed, RandomStream::Batches);
}

StateArrays GradientDescent::state()
{
  const auto array = [](const char* name, auto& values) {
    return StateArray{name, values.data(),
                      static_cast<std::int64_t>(values.size() * sizeof(values[0]))};
  };
  return {array("values", this->Parameters), array("moment1", this->FirstMoments),
          array("moment2", this->SecondMoments), array("updates", this->Updates)};
}

void GradientDescent::freeWorkspace()
{
  this->Gradient = {};
  this->Encoded = {};
  this->Positions = {};
  this->Targets = {};
  this->ShardGradients = {};
}

std::optional<double> GradientDescent::step(BatchSource& batches, const StopCheck& check)
{
  batches.prepare({this->Steps, this->PlannedSteps, this->stream()}, check);
  const std::optional<double> loss =
      this->Exchange ? this->computeTogether(batches, check) : this->computeShare(batches, check);
  if (!loss) {
    return loss;
  }
  this->update();
  return loss;
}

void GradientDescent::update()
{
  const float rate = this->Rate.at(this->Steps, this->PlannedSteps);
  ++this->Steps;
  try {
    this->updateLayers(rate);
    this->updateOtherLayers(rate);
    this->updateGrid(rate);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::InvalidModel, "memory ran out within step " +
                                             std::to_string(this->Steps) +
                                             " of the training: some parameters are those of the "
                                             "step before; choose a smaller model");
  }
}

std::optional<double> GradientDescent::computeTogether(BatchSource& batches, const StopCheck& check)
{
  std::optional<double> loss;
  this->Exchange->together([&] { loss = this->computeShare(batches, check); });
  return this->Exchange->sum(loss, this->Gradient.data(), this->Shape.gridOffset, this->Grid);
}

std::optional<double> GradientDescent::computeShare(BatchSource& batches, const StopCheck& check)
{
  if (!check.goesOn()) {
    return std::nullopt;
  }
  const auto count = static_cast<std::size_t>(batches.count());
  this->Positions.resize(count);
  this->Targets.resize(count);
  DrawBatch(batches, this->stream(), this->Steps, this->Threads, this->Positions.data(),
            this->Targets.data());
  return this->backpropagate(this->Positions, this->Targets, batches.total(), check);
}

std::optional<double> GradientDescent::computeGradient(const std::vector<glm::vec3>& positions,
                                                       const std::vector<float>& targets,
                                                       const StopCheck& check)
{
  return this->backpropagate(positions, targets, static_cast<std::int64_t>(positions.size()),
                             check);
}

/// Of a mini-batch of `total` samples those that are here.
std::optional<double> GradientDescent::backpropagate(const std::vector<glm::vec3>& positions,
                                                     const std::vector<float>& targets,
                                                     std::int64_t total, const StopCheck& check)
{
  const auto count = static_cast<std::int64_t>(positions.size());
  const std::int64_t shards = (count + ShardSize - 1) / ShardSize;
  const std::int64_t blocks = (count + TrainBlockSize - 1) / TrainBlockSize;
  this->Encoded.resize(static_cast<std::size_t>(blocks * this->Shape.encodedWidth * TrainRowSize));
  this->Grid.clear(); // an update leaves nothing, but not every gradient is entered
  this->ShardGradients.resize(static_cast<std::size_t>(shards));
  this->ShardLosses.assign(static_cast<std::size_t>(shards), 0.0);
  if (count == 0) { // all samples are other processes'
    this->sumShards();
    return 0.0;
  }
  const float* xyz = &positions.data()->x;
  this->encode(xyz, count, check);
  this->Threads.forEachBlock(count, ShardSize, [&](std::int64_t begin, std::int64_t end) {
    this->backpropagateShard(begin / ShardSize, targets.data(), begin, end, total, check);
  });
  if (!check.goesOn()) {
    return std::nullopt;
  }
  this->sumShards();
  this->scatter(xyz, count, check);
  if (!check.goesOn()) {
    return std::nullopt;
  }
  return std::accumulate(this->ShardLosses.begin(), this->ShardLosses.end(), 0.0) /
         static_cast<double>(total);
}

void GradientDescent::encode(const float* xyz, std::int64_t count, const StopCheck& check)
{
  const ModelView& model = this->Views.view();
  const std::int64_t pieces = (count + EncodePiece - 1) / EncodePiece;
  this->Threads.forEachBlock(model.levelCount * pieces, 1, [&](std::int64_t task, std::int64_t) {
    const std::int64_t first = task % pieces * EncodePiece;
    if (check.goesOn()) {
      this->Kernel.encode(model, static_cast<int>(task / pieces), xyz + 3 * first,
                          std::min(EncodePiece, count - first),
                          this->Encoded.data() +
                              first / TrainBlockSize * TrainRowSize * model.encodedWidth);
    }
  });
}

void GradientDescent::backpropagateShard(std::int64_t shard, const float* targets,
                                         std::int64_t begin, std::int64_t end, std::int64_t total,
                                         const StopCheck& check)
{
  if (!check.goesOn()) { // gradients of gigabytes are not worth their zeros then
    return;
  }
  const ModelView& model = this->Views.view();
  const auto floats = static_cast<std::size_t>(this->Kernel.workspace(model));
  const std::unique_ptr<float[]> workspace(new float[floats]); // left as it is: no need for zeros
  std::vector<float>& weightGradient = this->ShardGradients[static_cast<std::size_t>(shard)];
  weightGradient.assign(this->Shape.gridOffset, 0.0f);
  const std::int64_t samples = SamplesPerCheck(this->Shape.gridOffset);
  for (std::int64_t first = begin; first < end && check.goesOn(); first += samples) {
    const std::int64_t within = first % TrainBlockSize;
    TrainBlock block{};
    block.targets = targets + first;
    block.count = std::min(samples, end - first);
    block.gradientScale = 1.0f / static_cast<float>(total);
    block.encoded = this->Encoded.data() +
                    (first - within) / TrainBlockSize * TrainRowSize * this->Shape.encodedWidth +
                    within;
    block.weightGradient = weightGradient.data();
    this->Kernel.backpropagate(model, block, workspace.get());
    this->ShardLosses[static_cast<std::size_t>(shard)] += block.loss;
  }
}

void GradientDescent::sumShards()
{
  std::fill_n(this->Gradient.begin(), this->Shape.gridOffset, 0.0f);
  for (const std::vector<float>& shard : this->ShardGradients) {
    for (std::size_t k = 0; k < shard.size(); ++k) {
      this->Gradient[k] += shard[k];
    }
  }
}

void GradientDescent::scatter(const float* xyz, std::int64_t count, const StopCheck& check)
{
  // One task per level: levels share no entry, and within a level the order stays that of the
  // samples.
  const ModelView& model = this->Views.view();
  this->Threads.forEachBlock(model.levelCount, 1, [&](std::int64_t task, std::int64_t) {
    const int level = static_cast<int>(task);
    if (check.goesOn()) {
      this->Kernel.scatter(model, level, xyz, count, this->Encoded.data(), this->Grid.level(level));
    }
  });
}

void GradientDescent::updateLayers(float learningRate)
{
  const auto count = static_cast<std::int64_t>(this->Orthogonalised);
  this->Threads.forEachBlock(count, 1, [&](std::int64_t task, std::int64_t) {
    const LayerShape& layer = this->Shape.layers[static_cast<std::size_t>(task)];
    const OrthogonalRun run{&this->Parameters[layer.offset],
                            &this->Gradient[layer.offset],
                            &this->FirstMoments[layer.offset],
                            layer.rows,
                            layer.columns,
                            MomentumKept,
                            learningRate * OrthogonalRate(this->Steps)};
    std::vector<float> workspace(
        static_cast<std::size_t>(this->Kernel.orthogonalWorkspace(layer.rows, layer.columns)));
    this->Kernel.orthogonal(run, workspace.data());
  });
}

AdamRun GradientDescent::adamFrom(std::size_t first, float decay)
{
  return {&this->Parameters[first],
          &this->Gradient[first],
          &this->FirstMoments[first],
          &this->SecondMoments[first],
          FirstMomentKept,
          AdamEpsilon,
          decay};
}

void GradientDescent::updateOtherLayers(float learningRate)
{
  const std::size_t first = this->firstOtherWeight();
  const AdamRun run = this->adamFrom(first, WeightDecay);
  const std::size_t last = std::min<std::uint64_t>(this->Steps, LastAdamUpdate);
  AdamStep step = this->Updating[last];
  step.rate *= learningRate;
  this->Kernel.adam(run, static_cast<std::int64_t>(this->Shape.gridOffset - first), step);
}

void GradientDescent::updateGrid(float learningRate)
{
  const AdamSchedule schedule{this->Updating.data(), LastAdamUpdate};
  const std::vector<GridGradient::Piece>& pieces = this->Grid.pieces();
  const auto count = static_cast<std::int64_t>(pieces.size());
  this->Threads.forEachBlock(count, 1, [&](std::int64_t task, std::int64_t) {
    const GridGradient::Piece& piece = pieces[static_cast<std::size_t>(task)];
    const std::size_t first = this->Shape.gridOffset + piece.first;
    const AdamRun run = this->adamFrom(first, 0.0f);
    this->Kernel.adamSparse(run, piece.count, piece.touched, learningRate,
                            &this->Updates[piece.first], schedule);
  });
}

} // namespace inr

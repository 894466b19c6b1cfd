// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Inference/Overflow.h"
#include "CUDA/Render/Kernels/Wave.h"
#include "CUDA/Render/WindowedRays.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Render/Tiles/TileLoop.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace inr {
namespace cuda {

/// A wave of rays on a machine; see Render/Kernels/Wave.h. `Inference` has
///
///   const ModelPointer& source() const;
///   void infer(Machine&, const float* positions, const std::uint64_t* count, float* values) const;
///
/// the second of which begins with as many points as the machine finds at `count` by then, and
/// makes a NaN of what does not fit the kernel's numbers.
template <class Machine, class Inference, class Stages> class DeviceWave
{
public:
  /// `most`: rays of a wave.
  DeviceWave(Machine& machine, const Inference& inference, std::int64_t most)
      : Where(machine), Network(inference), Most(most)
  {}

  /// Lets all rays come to their end. The host waits once for WaveCounts::Rounds rounds: only then
  /// it knows whether there are rays left, and that no value is left for Core to compute.
  /// `gradients`: whether the stages want any; only where they have neighbors at all.
  void run(const Stages& stages, const RayOrder& order, bool gradients, FrameCounts* frame,
           const std::function<bool()>& keepGoing)
  {
    const std::int64_t slots = std::min(order.rays(), this->Most);
    this->reserve(slots, gradients);
    Kernel kernel = this->kernel(stages, order, frame);
    kernel.task = Kernel::Task::Begin;
    WaveCounts counts{};
    counts.rounds[0].rays = static_cast<std::uint64_t>(slots);
    while (counts.rounds[0].rays > 0) {
      RequireGoing(keepGoing);
      this->advance(kernel, counts);
      kernel.task = Kernel::Task::GoOn;
      if (counts.marked > 0) {
        this->inferAgain(kernel, counts);
      }
    }
  }

  /// Gives its memory back.
  void release() { this->Room.reset(); }

private:
  using Kernel = AdvanceWave<Stages>;
  using Ray = typename Stages::Ray;
  template <class T> using Array = typename Machine::template Array<T>;

  static constexpr bool HasNeighbors = Stages::MostNeighbors > 0;

  /// Of a number of slots.
  struct Buffers
  {
    Buffers(Machine& machine, std::int64_t slots, bool withNeighbors)
        : neighbors(withNeighbors), rays(machine.template allocate<Ray>(slots)),
          lists{machine.template allocate<std::uint32_t>(slots),
                machine.template allocate<std::uint32_t>(slots)},
          marked(machine.template allocate<std::uint32_t>(slots)),
          counts(machine.template allocate<WaveCounts>(1)),
          positions(machine.template allocate<float>(3 * slots * Stages::MostPoints)),
          values(machine.template allocate<float>(slots * Stages::MostPoints)),
          around(machine.template allocate<float>(3 * NeighborsOf(slots, withNeighbors))),
          aroundValues(machine.template allocate<float>(NeighborsOf(slots, withNeighbors)))
    {}

    static std::int64_t NeighborsOf(std::int64_t slots, bool any)
    {
      return any ? slots * Stages::MostNeighbors : 0;
    }
    static std::int64_t BytesFor(std::int64_t slots, bool withNeighbors)
    {
      constexpr std::int64_t perPoint = 4 * sizeof(float);
      constexpr std::int64_t lists = 3 * sizeof(std::uint32_t);
      return slots *
                 (static_cast<std::int64_t>(sizeof(Ray)) + lists + Stages::MostPoints * perPoint) +
             NeighborsOf(slots, withNeighbors) * perPoint;
    }

    bool neighbors;
    Array<Ray> rays;
    std::array<Array<std::uint32_t>, 2> lists;
    Array<std::uint32_t> marked;
    Array<WaveCounts> counts;
    Array<float> positions;
    Array<float> values;
    Array<float> around; ///< positions of neighbors
    Array<float> aroundValues;
  };

  void reserve(std::int64_t slots, bool gradients)
  {
    const bool neighbors = HasNeighbors && gradients;
    if (!this->Room || this->Room->rays.size() < slots || (neighbors && !this->Room->neighbors)) {
      this->Room.reset();
      this->Where.requireFree(Buffers::BytesFor(slots, neighbors), "the rays of a picture");
      this->Room.emplace(this->Where, slots, neighbors);
    }
    this->Gradients = neighbors;
    this->Current = 0;
  }

  Kernel kernel(const Stages& stages, const RayOrder& order, FrameCounts* frame) const
  {
    Kernel kernel{};
    kernel.stages = stages;
    kernel.order = order;
    kernel.lists.marked = this->Room->marked.data();
    kernel.lists.counts = this->Room->counts.data();
    kernel.rays = this->Room->rays.data();
    kernel.values = {this->Room->values.data(), this->Room->aroundValues.data()};
    kernel.positions = this->Room->positions.data();
    kernel.counts = frame;
    return kernel;
  }

  WaveRound* round(int k) const { return this->Room->counts.data()->rounds + k; }

  /// So many rounds, and what is left behind them: the next first one.
  void advance(Kernel kernel, WaveCounts& counts)
  {
    const auto live = static_cast<std::int64_t>(counts.rounds[0].rays);
    counts.marked = 0;
    this->Where.toMachine(this->Room->counts.data(), &counts, 1);
    for (int k = 0; k < WaveCounts::Rounds; ++k) {
      this->move(kernel, live, k);
      this->infer(kernel, live, k + 1);
      kernel.task = Kernel::Task::GoOn;
    }
    this->look(WaveCounts::Rounds, counts);
  }

  /// The rays of round k to the next one.
  void move(Kernel& kernel, std::int64_t most, int k)
  {
    const bool begins = kernel.task == Kernel::Task::Begin;
    kernel.lists.now = begins ? nullptr : this->Room->lists[this->Current].data();
    kernel.lists.nowCount = &this->round(k)->rays;
    this->Current = 1 - this->Current;
    kernel.lists.later = this->Room->lists[this->Current].data();
    kernel.lists.round = this->round(k + 1);
    this->Where.run(kernel, most);
  }

  void infer(const Kernel& kernel, std::int64_t most, int k)
  {
    this->Network.infer(this->Where, this->Room->positions.data(), &this->round(k)->points,
                        this->Room->values.data());
    if (this->Gradients) {
      this->listNeighbors(kernel, most, k);
      this->inferNeighbors(k);
    }
  }

  void listNeighbors(const Kernel& kernel, std::int64_t most, int k)
  {
    if constexpr (HasNeighbors) {
      ListNeighbors<Stages> neighbors{kernel.stages, kernel.lists, kernel.rays, kernel.values,
                                      this->Room->around.data()};
      neighbors.lists.now = this->Room->lists[this->Current].data();
      neighbors.lists.nowCount = &this->round(k)->rays;
      neighbors.lists.round = this->round(k);
      this->Where.run(neighbors, most);
    }
  }

  void inferNeighbors(int k)
  {
    this->Network.infer(this->Where, this->Room->around.data(), &this->round(k)->neighbors,
                        this->Room->aroundValues.data());
  }

  /// Waits. What is found in round k becomes the first one.
  void look(int k, WaveCounts& counts) const
  {
    this->Where.toHost(&counts, this->Room->counts.data(), 1);
    const WaveRound last = counts.rounds[k];
    std::fill(std::begin(counts.rounds), std::end(counts.rounds), WaveRound{});
    counts.rounds[0] = last;
  }

  /// The first round's values and those that marked rays wait for, with what Core computes of them:
  /// hardly ever.
  void inferAgain(Kernel kernel, WaveCounts& counts)
  {
    const auto live = static_cast<std::int64_t>(counts.rounds[0].rays);
    const auto marked = static_cast<std::int64_t>(counts.marked);
    this->Where.copy(this->Room->lists[this->Current].data() + live, this->Room->marked.data(),
                     marked);
    counts.rounds[0] = {static_cast<std::uint64_t>(live + marked), 0, 0};
    this->Where.toMachine(this->Room->counts.data(), &counts, 1);
    kernel.task = Kernel::Task::Again;
    this->move(kernel, live + marked, 0);
    this->Network.infer(this->Where, this->Room->positions.data(), &this->round(1)->points,
                        this->Room->values.data());
    this->repair(this->Room->positions, &this->round(1)->points, this->Room->values);
    if (this->Gradients) {
      this->listNeighbors(kernel, live + marked, 1);
      this->inferNeighbors(1);
      this->repair(this->Room->around, &this->round(1)->neighbors, this->Room->aroundValues);
    }
    this->look(1, counts);
  }

  void repair(const Array<float>& positions, const std::uint64_t* count, Array<float>& values)
  {
    if (!this->Core) {
      this->Core = MakeEvaluator(this->Network.source());
    }
    std::uint64_t points = 0;
    this->Where.toHost(&points, count, 1);
    std::vector<glm::vec3> places(points);
    std::vector<float> found(points);
    const auto size = static_cast<std::int64_t>(points);
    this->Where.toHost(&places.data()->x, positions.data(), 3 * size);
    this->Where.toHost(found.data(), values.data(), size);
    RepairPoints(*this->Core, places.data(), size, found.data());
    this->Where.toMachine(values.data(), found.data(), size);
  }

  Machine& Where;
  const Inference& Network;
  std::int64_t Most;
  std::shared_ptr<const Evaluator> Core; ///< for what overflows
  std::optional<Buffers> Room;
  bool Gradients = false;
  int Current = 0; ///< list of the rays whose values are there
};

} // namespace cuda
} // namespace inr

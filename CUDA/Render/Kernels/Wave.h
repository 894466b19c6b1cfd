// SPDX-License-Identifier: BSD-3-Clause
//
// Rays that go on together, round by round: each says where it asks for the field next, all these
// points are inferred in one launch, and each goes on with its values. Whose ray has ended takes
// the picture's next one, so that a wave stays full until there are no more; and who has none is
// not in the list of the next round.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Render/Kernels/FrameCounts.h"
#include "CUDA/Render/Kernels/Listed.h"
#include "CUDA/Render/Kernels/RayOrder.h"

#include <cmath>
#include <cstdint>

namespace inr {
namespace cuda {

/// What is in a round.
struct WaveRound
{
  std::uint64_t rays;
  std::uint64_t points;    ///< of them
  std::uint64_t neighbors; ///< of these, for gradients
};

/// What host and kernels tell each other, in the machine's memory.
struct WaveCounts
{
  /// Rounds until the host looks. 2^19 points make one of about a millisecond: it is asked whether
  /// to go on a hundred times a second, and a look costs a hundredth of that. What little is
  /// launched in vain behind the last ray costs about as much.
  static constexpr int Rounds = 16;

  WaveRound rounds[Rounds + 1]; ///< the first: as the one before has left it
  std::uint64_t marked;         ///< rays some of whose values are no numbers
  std::uint64_t begun;          ///< rays of the picture
};

/// Slots of a wave, by lists of their numbers, in no order.
struct WaveLists
{
  const std::uint32_t* now; ///< those whose turn it is; null: all, to get their first rays
  const std::uint64_t* nowCount;
  std::uint32_t* later; ///< those with points in the next round
  WaveRound* round;     ///< what is in that
  std::uint32_t* marked;
  WaveCounts* counts;

  /// Lists a ray with so many points; returns the number of the first.
  INR_HOST_DEVICE std::int64_t list(std::uint32_t slot, int points) const
  {
    this->later[AtomicAddTogether(this->round->rays, 1)] = slot;
    return static_cast<std::int64_t>(
        AtomicAddTogether(this->round->points, static_cast<std::uint32_t>(points)));
  }
  INR_HOST_DEVICE void mark(std::uint32_t slot) const
  {
    this->marked[AtomicAdd(this->counts->marked, std::uint64_t{1})] = slot;
  }

  /// Calls function(slot) for the calling thread's share.
  template <class Block, class Function>
  INR_HOST_DEVICE void forEach(Block& block, int threads, const Function& function) const
  {
    ForEachListed(block, threads, this->now, this->nowCount, function);
  }
};

/// Values at a round's points, and at those around them.
struct WaveValues
{
  const float* points;
  const float* neighbors;
};

/// Whether any of them is no number: it left the range of what the network is computed with.
INR_HOST_DEVICE inline bool HasMarked(const float* values, int count)
{
  bool marked = false;
  for (int k = 0; k < count; ++k) {
    marked = marked || std::isnan(values[k]);
  }
  return marked;
}

/// `Stages`, of a kind of rays: plain data with
///
///   Ray                         // as the wave keeps it
///   void begin(x, y, ray)       // of a pixel
///   bool meets(ray)             // the volume
///   int place(ray)              // its next points; 0: it has ended
///   glm::vec3 position(ray, k)  // of one of them, in the unit cube
///   int points(ray)             // so many they are
///   bool isMarked(ray, values)
///   bool take(ray, values, counts) // false: it has ended
///   void write(ray, pixel, counts) // of a ray that has
///
/// and a ray with members pixel and first, which are the wave's.
template <class Stages> struct AdvanceWave
{
  static constexpr int Threads = 128;

  enum class Task {
    Begin, ///< the slots' first rays
    GoOn,  ///< with the values
    Again  ///< only lists their points once more
  };

  Stages stages;
  Task task;
  RayOrder order;
  WaveLists lists;
  typename Stages::Ray* rays; ///< of the slots
  WaveValues values;
  float* positions; ///< of the next round
  FrameCounts* counts;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    this->lists.forEach(block, Threads, [&](std::uint32_t slot) { this->advance(slot); });
  }

private:
  using Ray = typename Stages::Ray;

  INR_HOST_DEVICE void advance(std::uint32_t slot) const
  {
    Ray& ray = this->rays[slot];
    if (this->task == Task::Again) {
      this->list(slot, ray);
      return;
    }
    if (this->task == Task::GoOn && this->stages.isMarked(ray, this->values)) {
      this->lists.mark(slot);
      return;
    }
    RayCounts counts;
    if (this->findPoints(ray, counts)) {
      this->list(slot, ray);
    }
    this->counts->add(counts);
  }

  /// Those of the slot's ray or, where that ends, of the next one that has any; false: there is
  /// none.
  INR_HOST_DEVICE bool findPoints(Ray& ray, RayCounts& counts) const
  {
    bool goesOn = this->task == Task::GoOn ? this->stages.take(ray, this->values, counts)
                                           : this->enter(ray, counts);
    bool has = this->task == Task::GoOn || goesOn;
    while (has && !(goesOn && this->stages.place(ray) > 0)) {
      this->stages.write(ray, ray.pixel, counts);
      has = goesOn = this->enter(ray, counts);
    }
    return has;
  }

  /// The picture's next ray that meets the volume; false where there is none. What the others show
  /// is written.
  INR_HOST_DEVICE bool enter(Ray& ray, RayCounts& counts) const
  {
    const auto all = static_cast<std::uint64_t>(this->order.rays());
    for (std::uint64_t next = 0; next < all;) {
      next = AtomicAddTogether(this->lists.counts->begun, 1);
      const std::int64_t pixel =
          next < all ? this->order.pixel(static_cast<std::int64_t>(next)) : -1;
      if (pixel < 0) {
        continue;
      }
      const int width = this->order.width;
      this->stages.begin(static_cast<int>(pixel % width), static_cast<int>(pixel / width), ray);
      ray.pixel = pixel;
      if (this->stages.meets(ray)) {
        ++counts.rays;
        return true;
      }
      this->stages.write(ray, pixel, counts);
    }
    return false;
  }

  INR_HOST_DEVICE void list(std::uint32_t slot, Ray& ray) const
  {
    const int points = this->stages.points(ray);
    ray.first = this->lists.list(slot, points);
    for (int k = 0; k < points; ++k) {
      const glm::vec3 position = this->stages.position(ray, k);
      float* const to = this->positions + 3 * (ray.first + k);
      to[0] = position.x;
      to[1] = position.y;
      to[2] = position.z;
    }
  }
};

/// Lists the points around those of rays that have their values, where Stages::MostNeighbors is
/// more than 0:
///
///   int findNeighbors(ray, values)                 // how many it wants
///   void listNeighbors(ray, positions)             // where they are
///
/// and a ray with a member firstNeighbor, which is the wave's.
template <class Stages> struct ListNeighbors
{
  static constexpr int Threads = 128;

  Stages stages;
  WaveLists lists; ///< `now` are these; `round` is theirs
  typename Stages::Ray* rays;
  WaveValues values;
  float* positions;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    this->lists.forEach(block, Threads, [&](std::uint32_t slot) {
      typename Stages::Ray& ray = this->rays[slot];
      const int count = this->stages.findNeighbors(ray, this->values);
      if (count > 0) {
        ray.firstNeighbor = static_cast<std::int64_t>(
            AtomicAddTogether(this->lists.round->neighbors, static_cast<std::uint32_t>(count)));
        this->stages.listNeighbors(ray, this->positions + 3 * ray.firstNeighbor);
      }
    });
  }
};

} // namespace cuda
} // namespace inr

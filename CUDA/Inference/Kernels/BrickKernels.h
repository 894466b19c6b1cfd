// SPDX-License-Identifier: BSD-3-Clause
//
// Voxels of bricks, many bricks in one launch: fused, and by a thread each.
#pragma once

#include "CUDA/Inference/Kernels/BrickInputs.h"
#include "CUDA/Inference/Kernels/PointKernels.h"

namespace inr {
namespace cuda {

constexpr int BrickThreads = 256; ///< of fused kernels at bricks

/// Layers of an item's samples that a block's warps take at once.
template <class Numbers> INR_HOST_DEVICE constexpr int LayersAtOnce(int tiles)
{
  return BrickThreads / WarpSize * Numbers::halves(tiles) * TileSize / (ItemSize * ItemSize);
}

/// A block works on one cube of samples after another. Values are the same, to the last bit, as
/// FusedPoints gives at the same positions.
template <int Tiles, class Numbers> struct FusedBricks
{
  static constexpr int Threads = BrickThreads;
  /// One computes while the other waits, unless layers are wide.
  static constexpr int LeastBlocks = Tiles < 8 ? 2 : 1;

  FusedModel<Numbers> model;
  FusedShared shared;
  const BrickJob* jobs;
  std::int64_t jobCount;
  std::int64_t items;            ///< of all jobs
  float* values;                 ///< normalised; NaN where a number left the range of `Numbers`
  const BrickEnd* end = nullptr; ///< where not null, of so many jobs and items instead

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    const std::int64_t count = this->end != nullptr ? this->end->jobs : this->jobCount;
    const std::int64_t items = this->end != nullptr ? this->end->items : this->items;
    const std::int64_t first = items * block.index() / block.count();
    const std::int64_t last = items * (block.index() + 1) / block.count();
    if (first == last) {
      return;
    }
    const FusedNetwork<Numbers> network =
        ShareWeights(block, Threads, this->model.network, this->shared.keepsWeights);
    BrickItem item = FindItem(this->jobs, count, first);
    block.threads([&](int thread) { this->place(block.shared(), item, thread); });
    for (std::int64_t k = first; k < last; ++k) {
      block.threads([&](int thread) { this->locate(block.shared(), thread); });
      block.threads([&](int thread) { this->findRows(block.shared(), thread); });
      for (int z = 0; z < ItemSize; z += Layers) {
        block.threads([&](int thread) { this->mix(block.shared(), z, thread); });
        block.warps([&](auto& warp) { this->infer(block.shared(), warp, network, z); });
      }
      const BrickItem next = k + 1 < last ? NextItem(item, this->jobs + count, k + 1) : item;
      block.threads([&](int thread) {
        this->place(block.shared(), next, thread);
        this->write(block.shared(), item, thread);
      });
      item = next;
    }
  }

private:
  static constexpr int Halves = Numbers::halves(Tiles);
  static constexpr int Layers = LayersAtOnce<Numbers>(Tiles);

  /// The samples' coordinates.
  INR_HOST_DEVICE void place(unsigned char* memory, const BrickItem& item, int thread) const
  {
    const int k = Threads - 1 - thread; // the last ones have less to write
    if (k < 3 * ItemSize) {
      const int axis = k / ItemSize;
      this->coordinates(memory)[k] =
          SampleCoordinate(*item.job, axis, item.firstSample(axis) + k % ItemSize);
    }
  }

  INR_HOST_DEVICE void locate(unsigned char* memory, int thread) const
  {
    const auto& grid = this->model.grid;
    const auto placesIn = [&](int level) {
      return SamplePlaces(this->coordinates(memory), grid.levels[level], grid.interpolation);
    };
    constexpr int cells = 3 * ItemSize;
    for (int k = thread; k < grid.levelCount * cells; k += Threads) {
      SetCell(placesIn(k / cells), k % cells, this->parts(memory)[k / cells]);
    }
    for (int l = Threads - 1 - thread; l < grid.levelCount; l += Threads) {
      SetExtent(placesIn(l), this->parts(memory)[l]);
    }
  }

  INR_HOST_DEVICE void findRows(unsigned char* memory, int thread) const
  {
    const auto& grid = this->model.grid;
    for (int l = thread; l < grid.levelCount; l += Threads) {
      SetFirst(this->parts(memory), l, this->shared.room);
    }
    WithFeatures(grid.features, [&](auto features) {
      FindRows<decltype(features)::value>(grid, this->parts(memory), this->shared.room,
                                          this->lattice(memory), thread, Threads);
    });
  }

  INR_HOST_DEVICE void mix(unsigned char* memory, int z, int thread) const
  {
    WithFeatures(this->model.grid.features, [&](auto features) {
      MixLayers<decltype(features)::value>(this->parts(memory), this->model.grid.levelCount,
                                           this->lattice(memory), z, Layers, this->mixed(memory),
                                           thread, Threads);
    });
  }

  /// The warp's tiles of the layers from `z` on.
  template <class Warp>
  INR_HOST_DEVICE void infer(unsigned char* memory, Warp& warp,
                             const FusedNetwork<Numbers>& network, int z) const
  {
    constexpr int samplesOfLayer = ItemSize * ItemSize;
    const int first = z * samplesOfLayer + warp.index() * Halves * TileSize;
    const LayerGrid<Numbers> grid{this->model.grid, this->parts(memory), this->mixed(memory), z,
                                  Layers};
    const BrickInputs<Numbers, Halves, Warp> inputs(warp, grid, first % samplesOfLayer / ItemSize,
                                                    first / samplesOfLayer);
    RunNetwork<Numbers, Tiles, Halves>(warp, network, inputs, this->results(memory) + first);
  }

  /// A thread's share of the item's voxels.
  INR_HOST_DEVICE void write(unsigned char* memory, const BrickItem& item, int thread) const
  {
    const BrickJob& job = *item.job;
    const float* const results = this->results(memory);
    const int power = job.points == 1 ? ItemPower : ItemPower - 1;
    const int side = 1 << power; // voxels
    for (int k = thread; k < 1 << 3 * power; k += Threads) {
      const int within[3] = {k & (side - 1), k >> power & (side - 1), k >> 2 * power};
      std::int64_t at[3];
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] = std::int64_t{item.at[axis]} * side + within[axis];
      }
      if (at[0] < job.voxels[0] && at[1] < job.voxels[1] && at[2] < job.voxels[2]) {
        const std::int64_t row = at[2] * job.voxels[1] + at[1];
        this->values[job.firstValue + row * job.voxels[0] + at[0]] =
            job.points == 1 ? Normalised(results[k]) : Mean(results, within);
      }
    }
  }

  /// Over a voxel's 2 x 2 x 2 samples.
  INR_HOST_DEVICE static float Mean(const float* results, const int (&voxel)[3])
  {
    float sum = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
      const int x = 2 * voxel[0] + (corner & 1);
      const int y = 2 * voxel[1] + (corner >> 1 & 1);
      const int z = 2 * voxel[2] + (corner >> 2);
      sum += Normalised(results[(z * ItemSize + y) * ItemSize + x]);
    }
    return sum / 8;
  }

  INR_HOST_DEVICE float* coordinates(unsigned char* memory) const ///< of each axis
  {
    return reinterpret_cast<float*>(memory + this->shared.coordinates);
  }
  INR_HOST_DEVICE LevelPart* parts(unsigned char* memory) const ///< of each level
  {
    return reinterpret_cast<LevelPart*>(memory + this->shared.parts);
  }
  INR_HOST_DEVICE float* lattice(unsigned char* memory) const
  {
    return reinterpret_cast<float*>(memory + this->shared.lattice);
  }
  INR_HOST_DEVICE float* mixed(unsigned char* memory) const
  {
    return reinterpret_cast<float*>(memory + this->shared.mixed);
  }
  INR_HOST_DEVICE float* results(unsigned char* memory) const ///< of all the item's samples
  {
    return reinterpret_cast<float*>(memory + this->shared.results);
  }
};

/// The same in float32 without tensor cores, by the voxel.
struct FloatBricks
{
  static constexpr int Threads = ThreadsPerBlock;

  FloatModel model;
  const BrickJob* jobs; ///< all of the same number of voxels
  std::int64_t jobCount;
  float* values;                 ///< normalised; NaN where a number left the range of floats
  float* scratch;                ///< as for FloatPoints
  const BrickEnd* end = nullptr; ///< where not null, of so many jobs instead

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    const std::int64_t jobs = this->end != nullptr ? this->end->jobs : this->jobCount;
    if (jobs == 0) {
      return;
    }
    const std::int32_t* const dims = this->jobs[0].voxels;
    const std::int64_t voxels = std::int64_t{dims[0]} * dims[1] * dims[2];
    block.threads([&](int thread) {
      const ThreadScratch scratch(this->model, this->scratch, block, thread, Threads);
      for (std::int64_t k = scratch.index(); k < jobs * voxels; k += scratch.threads()) {
        const BrickJob& job = this->jobs[k / voxels];
        const auto within = static_cast<std::int32_t>(k % voxels);
        this->values[job.firstValue + within] = this->voxel(job, within, scratch);
      }
    });
  }

private:
  INR_HOST_DEVICE float voxel(const BrickJob& job, std::int32_t index,
                              const ThreadScratch& scratch) const
  {
    const int x = index % job.voxels[0];
    const int y = index / job.voxels[0] % job.voxels[1];
    const int z = index / (job.voxels[0] * job.voxels[1]);
    const int samples = job.points * job.points * job.points;
    float sum = 0.0f;
    for (int corner = 0; corner < samples; ++corner) {
      const Point point{SampleCoordinate(job, 0, x * job.points + (corner & 1)),
                        SampleCoordinate(job, 1, y * job.points + (corner >> 1 & 1)),
                        SampleCoordinate(job, 2, z * job.points + (corner >> 2))};
      sum += Normalised(EvaluateFloat(this->model, point, scratch));
    }
    return sum / static_cast<float>(samples);
  }
};

} // namespace cuda
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
//
// Where a kernel runs. A kernel is a struct with
//
//   static constexpr int Threads;                                 // per block, whole warps
//   template <class Block> INR_HOST_DEVICE void operator()(Block& block) const;
//
// whose body is a sequence of phases: block.threads(f) calls f(thread) for all threads of the
// block, block.warps(f) calls f(warp) for all warps, and everybody has finished a phase before the
// next one begins. Within a warp, warp.lanes(f) is for what a lane does for itself, and
// warp.exchange(f) for what writes shared memory that other lanes of the warp read later or have
// read before. What a lane keeps from one call to the next, it keeps in a PerLane.
//
// On the device these are the threads of a launch and their barriers; on the host a loop. So the
// same source runs in both places, and tests run it where there is no GPU.
#pragma once

#include "CUDA/Device/Kernels/WideTiles.h"

#include <cstddef>

namespace inr {
namespace cuda {

/// A warp whose lanes take turns.
class HostWarp
{
public:
  template <class T> class PerLane
  {
  public:
    T& operator[](int lane) { return this->Items[lane]; }
    const T& operator[](int lane) const { return this->Items[lane]; }

  private:
    T Items[WarpSize];
  };

  HostWarp(int index, bool backward) : Index(index), Backward(backward) {}

  int index() const { return this->Index; } ///< in its block

  template <class Function> void lanes(const Function& function) const
  {
    for (int k = 0; k < WarpSize; ++k) {
      function(this->Backward ? WarpSize - 1 - k : k);
    }
  }
  template <class Function> void exchange(const Function& function) const { this->lanes(function); }

  /// sums += inputs * weights; see Tiles.h.
  static void multiplyAdd(const PerLane<InputShare>& inputs, const PerLane<WeightShare>& weights,
                          PerLane<SumShare>& sums)
  {
    MultiplyTiles([&](int lane) -> const InputShare& { return inputs[lane]; },
                  [&](int lane) -> const WeightShare& { return weights[lane]; },
                  [&](int lane) -> SumShare& { return sums[lane]; });
  }
  /// The same of float32 numbers, for one half of the outputs; see WideTiles.h.
  static void multiplyAdd(const PerLane<WideInputShare>& inputs,
                          const PerLane<WideWeightShare>& weights, int half,
                          PerLane<SumShare>& sums)
  {
    multiplyWide(inputs, weights, half, sums, BothParts);
  }
  /// Of the inputs' first parts only.
  static void multiplyAddFirst(const PerLane<WideInputShare>& inputs,
                               const PerLane<WideWeightShare>& weights, int half,
                               PerLane<SumShare>& sums)
  {
    multiplyWide(inputs, weights, half, sums, FirstPart);
  }

private:
  template <class ValueOf>
  static void multiplyWide(const PerLane<WideInputShare>& inputs,
                           const PerLane<WideWeightShare>& weights, int half,
                           PerLane<SumShare>& sums, const ValueOf& valueOf)
  {
    MultiplyWideTiles([&](int lane) -> const WideInputShare& { return inputs[lane]; },
                      [&](int lane) -> const WideWeightShare& { return weights[lane]; }, half,
                      [&](int lane) -> SumShare& { return sums[lane]; }, valueOf);
  }

  int Index;
  bool Backward;
};

/// A block whose threads take turns, forwards or backwards: a phase whose threads depend on each
/// other gives different results.
template <int ThreadCount> class HostBlock
{
public:
  HostBlock(int index, int count, unsigned char* shared, bool backward)
      : Index(index), Count(count), Shared(shared), Backward(backward)
  {}

  int index() const { return this->Index; } ///< in the grid
  int count() const { return this->Count; } ///< blocks in the grid
  unsigned char* shared() const { return this->Shared; }

  template <class Function> void threads(const Function& function) const
  {
    for (int k = 0; k < ThreadCount; ++k) {
      function(this->Backward ? ThreadCount - 1 - k : k);
    }
  }
  template <class Function> void warps(const Function& function) const
  {
    constexpr int warps = ThreadCount / WarpSize;
    for (int k = 0; k < warps; ++k) {
      HostWarp warp(this->Backward ? warps - 1 - k : k, this->Backward);
      function(warp);
    }
  }

private:
  int Index;
  int Count;
  unsigned char* Shared;
  bool Backward;
};

#ifdef __CUDACC__

/// The calling thread's warp.
class DeviceWarp
{
public:
  template <class T> class PerLane
  {
  public:
    INR_HOST_DEVICE T& operator[](int) { return this->Item; }
    INR_HOST_DEVICE const T& operator[](int) const { return this->Item; }

  private:
    T Item;
  };

  INR_HOST_DEVICE int index() const
  {
#ifdef __CUDA_ARCH__
    return static_cast<int>(threadIdx.x) / WarpSize;
#else
    return 0;
#endif
  }

  template <class Function> INR_HOST_DEVICE void lanes(const Function& function) const
  {
#ifdef __CUDA_ARCH__
    function(static_cast<int>(threadIdx.x) % WarpSize);
#else
    static_cast<void>(function);
#endif
  }

  template <class Function> INR_HOST_DEVICE void exchange(const Function& function) const
  {
#ifdef __CUDA_ARCH__
    __syncwarp();
    function(static_cast<int>(threadIdx.x) % WarpSize);
    __syncwarp();
#else
    static_cast<void>(function);
#endif
  }

  INR_HOST_DEVICE static void multiplyAdd(const PerLane<InputShare>& inputs,
                                          const PerLane<WeightShare>& weights,
                                          PerLane<SumShare>& sums)
  {
    MultiplyShares(inputs[0], weights[0], sums[0]);
  }
  INR_HOST_DEVICE static void multiplyAdd(const PerLane<WideInputShare>& inputs,
                                          const PerLane<WideWeightShare>& weights, int half,
                                          PerLane<SumShare>& sums)
  {
    MultiplyWideShares(inputs[0].second, weights[0], half, sums[0]);
    MultiplyWideShares(inputs[0].first, weights[0], half, sums[0]);
  }
  INR_HOST_DEVICE static void multiplyAddFirst(const PerLane<WideInputShare>& inputs,
                                               const PerLane<WideWeightShare>& weights, int half,
                                               PerLane<SumShare>& sums)
  {
    MultiplyWideShares(inputs[0].first, weights[0], half, sums[0]);
  }
};

/// The calling thread's block.
class DeviceBlock
{
public:
  INR_HOST_DEVICE int index() const
  {
#ifdef __CUDA_ARCH__
    return static_cast<int>(blockIdx.x);
#else
    return 0;
#endif
  }

  INR_HOST_DEVICE int count() const
  {
#ifdef __CUDA_ARCH__
    return static_cast<int>(gridDim.x);
#else
    return 1;
#endif
  }

  INR_HOST_DEVICE unsigned char* shared() const
  {
#ifdef __CUDA_ARCH__
    extern __shared__ uint4 memory[];
    return reinterpret_cast<unsigned char*>(memory);
#else
    return nullptr;
#endif
  }

  template <class Function> INR_HOST_DEVICE void threads(const Function& function) const
  {
#ifdef __CUDA_ARCH__
    function(static_cast<int>(threadIdx.x));
    __syncthreads();
#else
    static_cast<void>(function);
#endif
  }

  template <class Function> INR_HOST_DEVICE void warps(const Function& function) const
  {
#ifdef __CUDA_ARCH__
    DeviceWarp warp;
    function(warp);
    __syncthreads();
#else
    static_cast<void>(function);
#endif
  }
};

#endif // __CUDACC__

} // namespace cuda
} // namespace inr

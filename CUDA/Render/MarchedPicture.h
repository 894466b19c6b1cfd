// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/DeviceLayers.h"
#include "CUDA/Render/DevicePicture.h"
#include "CUDA/Render/DeviceScene.h"
#include "CUDA/Render/Kernels/LayeredMarch.h"
#include "CUDA/Render/Kernels/MarchKernels.h"
#include "CUDA/Render/WindowedRays.h"
#include "Core/Render/CachedRenderer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/WorkLimit.h"
#include "Core/Timer.h"

#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

namespace inr {
namespace cuda {

/// A ray-marched picture on a machine: its scene, its rays and its pixels.
template <class Machine, class Cache> class MarchedPicture
{
public:
  /// `most`: rays that wait at once.
  MarchedPicture(Machine& machine, Cache& cache, std::int64_t most)
      : Where(machine), Bricks(cache), Pixels(machine),
        Scene(machine.template allocate<RenderScene>(1)), Most(most),
        Marched(std::in_place_type<RaysOf<MarchRays>>, machine, cache, most)
  {}

  /// A frame's scene. `steps`: its entries are on the machine, and outlive the picture.
  void setScene(const MarchJob& job, const DeviceColors<Machine>& colors, const StepLookup& steps)
  {
    if (job.settings.looksAtBothEnds()) {
      this->template marchBy<MarchBothEnds>();
    } else if (job.geometry.view().layers.any()) {
      this->template marchBy<MarchLayeredRays>();
    } else {
      this->template marchBy<MarchRays>();
    }
    this->Arrays.clear();
    RenderScene scene =
        SceneOn(this->Where, job, colors, this->Layers.of(this->Where, job.frame), this->Arrays);
    scene.steps = steps;
    this->Where.toMachine(this->Scene.data(), &scene, 1);
    this->Order = {job.frame.width, job.frame.height, nullptr, 0};
    this->Pixels.resize(std::int64_t{job.frame.width} * job.frame.height);
  }

  /// All rays once, with the bricks that are there.
  FrameStatistics marchOnce(OnMiss onMiss, const std::function<bool()>& keepGoing)
  {
    return this->counted(
        [&](const auto& kernel, auto& rays) {
          this->Bricks.beginFrame();
          rays.runOnce(kernel, this->Order, keepGoing);
        },
        onMiss);
  }

  /// From here on every ray goes on until it has come to its end with the bricks that it asks for.
  void begin()
  {
    std::visit([&](auto& rays) { rays.begin(this->Order); }, this->Marched);
  }
  /// As far as `limit`, since begin.
  FrameStatistics goOn(const WorkLimit& limit, int maximumRequests,
                       const std::function<bool()>& keepGoing)
  {
    return this->counted(
        [&](const auto& kernel, auto& rays) {
          rays.goOn(kernel, limit, maximumRequests, keepGoing,
                    [&] { return this->Pixels.statistics().samples > 0; });
        },
        OnMiss::Stop);
  }
  bool done() const
  {
    return std::visit([](const auto& rays) { return rays.done(); }, this->Marched);
  }

  /// Of a picture that is not gone on with.
  void clearLayers() { this->Layers.clear(); }

  void copyTo(const PassOutput& output) const
  {
    this->Pixels.copyTo(output.rgba.pixels.data(),
                        output.depth != nullptr ? output.depth->pixels.data() : nullptr,
                        output.samples != nullptr ? output.samples->pixels.data() : nullptr);
  }

private:
  /// Rays that a kernel marches.
  template <class MarchKernel>
  struct RaysOf : WindowedRays<Machine, Cache, typename MarchKernel::Progress>
  {
    using Kernel = MarchKernel;
    using WindowedRays<Machine, Cache, typename MarchKernel::Progress>::WindowedRays;
  };

  /// Gives the memory of others back.
  template <class Kernel> void marchBy()
  {
    if (!std::holds_alternative<RaysOf<Kernel>>(this->Marched)) {
      this->Marched.template emplace<RaysOf<Kernel>>(this->Where, this->Bricks, this->Most);
    }
  }

  template <class Kernel> Kernel kernelFor(OnMiss onMiss) const
  {
    Kernel kernel{};
    kernel.scene = this->Scene.data();
    kernel.onMiss = onMiss;
    kernel.picture = this->Pixels.view();
    kernel.counts = this->Pixels.counts();
    return kernel;
  }

  /// Runs march(kernel, its rays); what was counted meanwhile.
  template <class March> FrameStatistics counted(const March& march, OnMiss onMiss)
  {
    const Timer timer;
    this->Pixels.clearCounts();
    std::visit(
        [&](auto& rays) {
          using Kernel = typename std::decay_t<decltype(rays)>::Kernel;
          march(this->kernelFor<Kernel>(onMiss), rays);
        },
        this->Marched);
    FrameStatistics statistics = this->Pixels.statistics();
    statistics.marchSeconds = timer.seconds();
    return statistics;
  }

  Machine& Where;
  Cache& Bricks;
  DevicePicture<Machine> Pixels;
  typename Machine::template Array<RenderScene> Scene;
  Belongings<Machine> Arrays;   ///< of the scene
  DeviceLayers<Machine> Layers; ///< of the scene, too
  std::int64_t Most;
  std::variant<RaysOf<MarchRays>, RaysOf<MarchLayeredRays>, RaysOf<MarchBothEnds>> Marched;
  RayOrder Order{};
};

} // namespace cuda
} // namespace inr

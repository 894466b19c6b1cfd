// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/DeviceLayers.h"
#include "CUDA/Render/DevicePicture.h"
#include "CUDA/Render/DeviceScene.h"
#include "CUDA/Render/DeviceWave.h"
#include "CUDA/Render/Kernels/MarchWave.h"
#include "CUDA/Render/Kernels/PathWave.h"
#include "CUDA/Render/PathTiles.h"
#include "Core/Render/Acceleration/AcceleratedRenderer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Timer.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace inr {
namespace cuda {

/// How many rays go on together: enough points in a launch for any GPU.
struct WaveSizes
{
  std::int64_t rays = 1 << 16;  ///< 2^19 points; 78 MB, and 129 MB where they are lit
  std::int64_t paths = 1 << 17; ///< 2^17 points; 77 MB
};

/// Draws frames straight from the network by kernels on a machine; see AcceleratedRenderer. Time
/// limits make no difference, as they make none to the CPU's.
template <class Machine, class Inference> class NetworkRenderer : public AcceleratedRenderer
{
public:
  /// `where`: of the machine.
  template <class Where>
  NetworkRenderer(const Where& where, Inference inference, const WaveSizes& sizes = {})
      : Own(where), Network(std::move(inference)), Picture(this->Own),
        MarchedScene(this->Own.template allocate<RenderScene>(1)),
        TracedScene(this->Own.template allocate<PathScene>(1)),
        Marched(this->Own, this->Network, sizes.rays), Traced(this->Own, this->Network, sizes.paths)
  {}

  /// What is looked at at both ends of samples would take rounds of another kind.
  bool draws(const Frame& frame) const override
  {
    return TakesLayersOf(frame) && !frame.preIntegration &&
           frame.blending.mode != BlendMode::Isosurface;
  }

  void setColors(const Majorants& majorants, const ColorLookup& colors) override
  {
    this->Colors.set(this->Own, majorants, colors);
  }

  FrameStatistics march(const MarchJob& job, const DrawCall& call) override
  {
    const Timer timer;
    this->OfFrame.clear();
    const RenderScene scene =
        SceneOn(this->Own, job, this->Colors, this->Layers.of(this->Own, job.frame), this->OfFrame);
    this->Own.toMachine(this->MarchedScene.data(), &scene, 1);
    this->begin(job.frame.width, job.frame.height);
    this->Traced.release();
    this->Marched.run({this->MarchedScene.data(), this->Picture.view()},
                      {job.frame.width, job.frame.height, nullptr, 0}, scene.lit,
                      this->Picture.counts(), call.keepGoing);
    FrameStatistics statistics = this->Picture.statistics();
    statistics.work.networkSamples = statistics.samples;
    statistics.marchSeconds = timer.seconds();
    Image* const depth = call.output.depth;
    this->Picture.copyTo(call.output.rgba.pixels.data(),
                         depth != nullptr ? depth->pixels.data() : nullptr, nullptr);
    return statistics;
  }

  TracedTiles tracePaths(const PathRound& round, const WorkLimit& /*limit*/,
                         const std::function<bool()>& keepGoing) override
  {
    const Timer timer;
    this->OfFrame.clear();
    const PathScene scene =
        SceneOn(this->Own, round.tracer.scene(), this->Colors,
                this->Layers.of(this->Own, round.tracer.frame()), this->OfFrame);
    this->Own.toMachine(this->TracedScene.data(), &scene, 1);
    this->begin(scene.rays.width, scene.rays.height);
    const std::vector<std::uint32_t> pixels = PixelsOf(round);
    const auto listed = static_cast<std::int64_t>(pixels.size());
    this->Marched.release();
    this->Traced.run({this->TracedScene.data(), this->Picture.view()},
                     {scene.rays.width, scene.rays.height,
                      this->OfFrame.put(this->Own, pixels.data(), listed), listed},
                     false, this->Picture.counts(), keepGoing);
    TracedTiles traced;
    traced.seconds = timer.seconds();
    traced.tiles = TilesToHost(round, this->Picture);
    traced.tiles.front().work.networkSamples = traced.tiles.front().samples;
    return traced;
  }

  std::int64_t bytes() const override { return 0; }
  std::int64_t bricks() const override { return 0; }

private:
  void begin(int width, int height)
  {
    this->Picture.resize(std::int64_t{width} * height);
    this->Picture.clearCounts();
  }

  Machine Own;
  Inference Network;
  DeviceColors<Machine> Colors;
  DevicePicture<Machine> Picture;
  Belongings<Machine> OfFrame;
  DeviceLayers<Machine> Layers;
  typename Machine::template Array<RenderScene> MarchedScene;
  typename Machine::template Array<PathScene> TracedScene;
  DeviceWave<Machine, Inference, MarchStages> Marched;
  DeviceWave<Machine, Inference, PathStages> Traced;
};

} // namespace cuda
} // namespace inr

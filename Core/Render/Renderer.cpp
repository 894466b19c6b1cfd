// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Renderer.h"

#include "Core/Error.h"
#include "Core/Parallel.h"
#include "Core/Render/TileMarcher.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <utility>

namespace inr {

namespace {

/// Row-major tiles of a picture; those at the right and upper rim may be smaller.
struct Tiling
{
  explicit Tiling(const Frame& frame) : Width(frame.width), Height(frame.height) {}

  int columns() const { return (this->Width + TileMarcher::Edge - 1) / TileMarcher::Edge; }
  int rows() const { return (this->Height + TileMarcher::Edge - 1) / TileMarcher::Edge; }
  std::int64_t count() const { return static_cast<std::int64_t>(this->columns()) * this->rows(); }
  Tile tile(std::int64_t k) const
  {
    const int x = static_cast<int>(k % this->columns()) * TileMarcher::Edge;
    const int y = static_cast<int>(k / this->columns()) * TileMarcher::Edge;
    return {x, y, std::min(TileMarcher::Edge, this->Width - x),
            std::min(TileMarcher::Edge, this->Height - y)};
  }

private:
  int Width;
  int Height;
};

FrameStatistics Sum(const std::vector<FrameStatistics>& tiles)
{
  FrameStatistics sum;
  for (const FrameStatistics& tile : tiles) {
    sum.rays += tile.rays;
    sum.samples += tile.samples;
    sum.clamped += tile.clamped;
  }
  return sum;
}

} // namespace

struct Renderer::Implementation
{
  Implementation(std::shared_ptr<const Evaluator> field, VolumeInfo volume, const MacroCells& cells,
                 int threads)
      : Field(std::move(field)), Volume(std::move(volume)), Cells(cells), Threads(threads)
  {}

  std::shared_ptr<const Evaluator> Field;
  VolumeInfo Volume;
  Majorants Cells;
  Arena Threads;
  std::optional<TransferFunction> Function;
  std::optional<ColorTable> Colors;
  std::int64_t MajorantBuilds = 0;
};

Renderer::Renderer(const ModelPointer& model, const RendererOptions& options)
    : Renderer(MakeEvaluator(model, options.kernel), model->volume, model->macroCells, options)
{}

Renderer::Renderer(std::shared_ptr<const Evaluator> field, const VolumeInfo& volume,
                   const MacroCells& cells, const RendererOptions& options)
    : Self(std::make_unique<Implementation>(std::move(field), volume, cells, options.threads))
{}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::int64_t Renderer::majorantBuilds() const { return this->Self->MajorantBuilds; }

std::string Renderer::kernel() const { return this->Self->Field->kernel(); }

void Renderer::setTransferFunction(const TransferFunction& transferFunction)
{
  Implementation& self = *this->Self;
  if (self.Function == transferFunction) {
    return;
  }
  ColorTable colors(transferFunction, self.Volume); // before anything changes: it may throw
  self.Colors.emplace(std::move(colors));
  self.Function = transferFunction;
  self.Cells.update(*self.Colors, self.Threads);
  ++self.MajorantBuilds;
}

FrameStatistics Renderer::render(const Frame& frame, Image& rgba, Image* depth,
                                 const std::function<bool()>& keepGoing)
{
  const auto start = std::chrono::steady_clock::now();
  Implementation& self = *this->Self;
  if (!self.Colors) {
    throw Error(ErrorCode::InvalidArgument, "set a transfer function before rendering");
  }
  const RayGeometry geometry(frame, self.Volume.dims);
  MarchSettings settings;
  settings.dims = glm::dvec3(self.Volume.dims);
  settings.step = frame.sampleDistance;
  settings.unitsPerT = geometry.worldPerUnit() / frame.unitDistance;
  const MarchScene scene{frame, geometry, self.Cells, self.Colors->lookup(), *self.Field, settings};

  rgba = Image(frame.width, frame.height, 4);
  if (depth != nullptr) {
    *depth = Image(frame.width, frame.height, 1);
  }
  const Tiling tiling(frame);
  std::vector<FrameStatistics> tiles(static_cast<std::size_t>(tiling.count()));
  std::atomic<bool> stopped{false};
  self.Threads.forEachBlock(tiling.count(), 1, [&](std::int64_t k, std::int64_t) {
    if (stopped || (keepGoing && !keepGoing())) {
      stopped = true;
      return;
    }
    TileMarcher marcher(scene);
    tiles[static_cast<std::size_t>(k)] = marcher.march(tiling.tile(k), rgba, depth);
  });
  if (stopped) {
    throw Error(ErrorCode::Cancelled, "rendering stopped on request");
  }
  FrameStatistics statistics = Sum(tiles);
  statistics.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

} // namespace inr

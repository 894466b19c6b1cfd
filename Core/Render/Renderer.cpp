// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Renderer.h"

#include "Core/Error.h"
#include "Core/Parallel.h"
#include "Core/Render/AcceleratedFrames.h"
#include "Core/Render/CachedPaths.h"
#include "Core/Render/LevelChooser.h"
#include "Core/Render/TileLoop.h"
#include "Core/Render/TileMarcher.h"
#include "Core/Render/WorkLimit.h"

#include <optional>
#include <utility>

namespace inr {

namespace {

RendererOptions Consistent(RendererOptions options)
{
  options.cache.background = options.cache.background && !options.deterministic;
  return options;
}

/// Where there is a tolerance, what else would choose levels and distances of samples is off.
Frame WithoutOtherErrors(Frame frame)
{
  if (frame.errorTolerance) {
    frame.levelOfDetailScale = 0;
    frame.adaptiveSampling = false;
  }
  return frame;
}

FrameStatistics Sum(const std::vector<FrameStatistics>& tiles)
{
  FrameStatistics sum;
  for (const FrameStatistics& tile : tiles) {
    sum.add(tile);
  }
  return sum;
}

std::shared_ptr<const Evaluator> FieldOf(const ModelPointer& model, const RendererOptions& options)
{
  // What an accelerator gives is compared with this, and may be replaced by it.
  const bool alone = options.accelerator == nullptr;
  return MakeEvaluator(model, options.kernel,
                       alone ? options.inference : InferencePrecision::Float32);
}

} // namespace

struct Renderer::Implementation
{
  /// `model`: null for another field.
  Implementation(std::shared_ptr<const Evaluator> field, std::shared_ptr<const void> identity,
                 const ModelPointer& model, VolumeInfo volume, const MacroCells& cells,
                 RendererOptions options)
      : Field(std::move(field)), Identity(std::move(identity)), Volume(std::move(volume)),
        Options(Consistent(std::move(options))), Threads(this->Options.threads),
        Cells(this->Options.cached ? Majorants(cells, this->Volume.dims, this->Threads)
                                   : Majorants(cells))
  {
    if (!model) {
      this->Options.accelerator = nullptr;
    }
    this->Samples = this->Field;
    const std::shared_ptr<const Accelerator>& accelerator = this->Options.accelerator;
    if (accelerator) {
      this->Accelerated = accelerator->open(model);
    }
    if (this->Options.cached) { // at once, so that whom this one replaces can leave its bricks
      const BrickKernel& kernel = BrickKernelFor(ChooseInstructionSet(this->Options.kernel));
      this->Cached.emplace(this->Field, this->Identity, this->Volume.dims, this->Options.cache,
                           kernel, this->Threads, accelerator, model);
    } else if (accelerator) {
      this->Samples = MakeEvaluator(this->Accelerated, this->Field);
    }
    if (accelerator) {
      this->tryAccelerator();
    }
  }

  /// Whether the accelerator draws such a frame itself; it is then known to draw rightly.
  bool isDrawnElsewhere(const Frame& frame, const std::function<bool()>& keepGoing);
  /// A small one by both.
  void proveDrawing(const Frame& frame, const std::function<bool()>& keepGoing);

  /// Has it made what frames will ask for, so that it is known beforehand whether it can.
  void tryAccelerator();

  Projector projector() const
  {
    return ProjectorFor(this->Seen, this->Volume, this->Cells.bounds(), this->Surfaces);
  }
  void build();
  /// Finds what matters to pictures blended like this, unless that is known.
  void buildFor(const Blending& blending);
  FrameStatistics renderUncached(const Frame& frame, const RayGeometry& geometry,
                                 const MarchSettings& settings, const Shading* shading,
                                 const PassOutput& output,
                                 const std::function<bool()>& keepGoing) const;

  std::int64_t measuredPoints() const { return this->Levels ? this->Levels->measuredPoints() : 0; }
  /// Whether what comes from coarser levels can be chosen for such a frame.
  bool choosesLevels(const Frame& frame, const MarchSettings& settings) const;
  /// Puts the choice into `settings`; whether it is final.
  bool chooseLevels(const Frame& frame, const WorkLimit& limit,
                    const std::function<bool()>& keepGoing, MarchSettings& settings);

  MarchSettings settingsFor(const Frame& frame, const RayGeometry& geometry) const;
  FrameStatistics march(const Frame& frame, const PassOutput& output,
                        const std::function<bool()>& keepGoing);
  FrameStatistics marchCached(const Frame& frame, const RayGeometry& geometry,
                              MarchSettings& settings, const Shading* shading,
                              const WorkLimit& limit, const PassOutput& output,
                              const std::function<bool()>& keepGoing);
  TracedTiles traceRound(const PathRound& round, const WorkLimit& limit,
                         const std::function<bool()>& keepGoing);
  FrameStatistics tracePaths(const Frame& frame, const PassOutput& output,
                             const std::function<bool()>& keepGoing);

  std::shared_ptr<const Evaluator> Field; ///< by the CPU
  std::shared_ptr<const void>
      Identity; ///< of the field: renderers that have the same share a cache
  VolumeInfo Volume;
  RendererOptions Options;
  std::shared_ptr<AcceleratedField> Accelerated; ///< null where only the CPU computes
  std::shared_ptr<const Evaluator> Samples;      ///< of frames without a cache: the field
  Arena Threads;
  Majorants Cells;
  std::optional<TransferFunction> Function;
  std::optional<ColorTable> Colors;
  bool Built = false;                     ///< the majorants, for the colours and for `Seen`
  Blending Seen;                          ///< how pictures are blended that the majorants are for
  std::vector<float> Surfaces;            ///< of these pictures
  std::optional<CachedRenderer> Cached;   ///< where there is to be a cache
  std::optional<AcceleratedFrames> Drawn; ///< and an accelerator
  std::optional<PathPicture> Paths;       ///< while paths are traced
  std::optional<LevelChooser> Levels;     ///< once a frame had a tolerance
  std::int64_t MajorantBuilds = 0;
};

Renderer::Renderer(const ModelPointer& model, const RendererOptions& options)
    : Self(std::make_unique<Implementation>(FieldOf(model, options), model, model, model->volume,
                                            model->macroCells, options))
{}

Renderer::Renderer(const std::shared_ptr<const Evaluator>& field, const VolumeInfo& volume,
                   const MacroCells& cells, const RendererOptions& options)
    : Self(std::make_unique<Implementation>(field, field, nullptr, volume, cells, options))
{}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::int64_t Renderer::majorantBuilds() const { return this->Self->MajorantBuilds; }

std::int64_t Renderer::cacheBytes() const
{
  const std::optional<AcceleratedFrames>& drawn = this->Self->Drawn;
  const std::int64_t elsewhere = drawn ? drawn->bytes() : 0;
  return elsewhere + (this->Self->Cached ? this->Self->Cached->store().budget().bytes() : 0);
}

std::int64_t Renderer::cachedBricks() const
{
  const std::optional<AcceleratedFrames>& drawn = this->Self->Drawn;
  const std::int64_t elsewhere = drawn ? drawn->bricks() : 0;
  return elsewhere + (this->Self->Cached ? this->Self->Cached->store().mapped() : 0);
}

std::shared_ptr<const KeptBricks> Renderer::keepBricks() const
{
  const std::optional<CachedRenderer>& cached = this->Self->Cached;
  return cached ? std::make_shared<const KeptBricks>(cached->sharedStore()) : nullptr;
}

std::string Renderer::kernel() const { return this->Self->Field->kernel(); }

std::string Renderer::accelerator() const
{
  const std::shared_ptr<AcceleratedField>& field = this->Self->Accelerated;
  return field && !field->failure() ? field->name() : "";
}

std::optional<AcceleratedField::Failure> Renderer::acceleratorFailure() const
{
  const std::shared_ptr<AcceleratedField>& field = this->Self->Accelerated;
  return field ? field->failure() : std::nullopt;
}

int Renderer::threads() const { return this->Self->Threads.threads(); }

void Renderer::setTransferFunction(const TransferFunction& transferFunction)
{
  Implementation& self = *this->Self;
  if (self.Function == transferFunction) {
    return;
  }
  ColorTable colors(transferFunction, self.Volume); // before anything changes: it may throw
  self.Function.reset();                            // nor is anything known while it changes
  self.Paths.reset();
  self.Colors.emplace(std::move(colors));
  self.build();
  self.Function = transferFunction;
}

void Renderer::Implementation::tryAccelerator()
{
  if (this->Cached) {
    const Hierarchy& levels = this->Cached->store().cache().hierarchy();
    this->Accelerated->bricks(*MakeBrickSource(this->Field, levels));
    this->Drawn.emplace(this->Accelerated,
                        this->Accelerated->makeRenderer(this->Volume.dims, this->Options.cache));
  } else {
    this->Accelerated->evaluator(*this->Field);
  }
}

void Renderer::Implementation::build()
{
  this->Built = false; // until it is: memory may run out
  if (this->Cached) {
    this->Cached->forgetColors();
  }
  if (this->Levels) {
    this->Levels->forgetColors();
  }
  this->Surfaces = VisibleSurfaces(this->Seen.isosurfaces, this->Volume, this->Colors->lookup());
  this->Cells.update(VisibilityFor(this->projector(), *this->Colors), this->Threads);
  if (this->Drawn) {
    this->Drawn->setColors(this->Cells, this->Colors->lookup());
  }
  ++this->MajorantBuilds;
  this->Built = true;
}

void Renderer::Implementation::buildFor(const Blending& blending)
{
  if (!this->Built || this->Seen != blending) {
    this->Built = false;
    this->Seen = blending;
    this->build();
  }
}

FrameStatistics Renderer::Implementation::renderUncached(
    const Frame& frame, const RayGeometry& geometry, const MarchSettings& settings,
    const Shading* shading, const PassOutput& output, const std::function<bool()>& keepGoing) const
{
  const Timer timer;
  const MarchScene scene{frame,          geometry, this->Cells, this->Colors->lookup(),
                         *this->Samples, settings, shading};
  const int edge = EdgeFor(this->Samples->pointsAtOnce(), TileMarcher::SamplesPerRound);
  const Tiling tiling(frame.width, frame.height, edge);
  std::vector<FrameStatistics> tiles(static_cast<std::size_t>(tiling.count()));
  ForEachTile(this->Threads, tiling.count(), keepGoing, [&](std::int64_t k) {
    TileMarcher marcher(scene);
    tiles[static_cast<std::size_t>(k)] = marcher.march(tiling.tile(k), output.rgba, output.depth);
  });
  FrameStatistics statistics = Sum(tiles);
  statistics.marchSeconds = timer.seconds();
  return statistics;
}

bool Renderer::Implementation::choosesLevels(const Frame& frame,
                                             const MarchSettings& settings) const
{
  // Values that leave their cell's range are moved into that of all cells that are walked through
  // together, and these are others where there are fewer samples.
  return frame.errorTolerance.value_or(0) > 0 && this->Cells.rangesHold() &&
         frame.blending.mode == BlendMode::Composite && !frame.shading && !settings.crops &&
         settings.step <= LevelChooser::LongestStep;
}

bool Renderer::Implementation::chooseLevels(const Frame& frame, const WorkLimit& limit,
                                            const std::function<bool()>& keepGoing,
                                            MarchSettings& settings)
{
  if (!this->Levels) {
    this->Levels.emplace(this->Field, this->Volume.dims, this->Cells,
                         this->Cached->store().cache().hierarchy().levels(),
                         LineKernelFor(ChooseInstructionSet(this->Options.kernel)));
  }
  // As for all other pieces of the picture: samples would not fit together where they meet.
  Frame whole = frame;
  whole.piece.clear();
  const RayGeometry geometry(whole, this->Volume.dims);
  const LevelChooser::Wish wish{*frame.errorTolerance, settings.step,
                                settings.step * settings.unitsPerT};
  if (!this->Levels->choose(wish, {geometry, frame.width, frame.height}, this->Cells,
                            this->Colors->lookup(), this->Threads, limit, keepGoing)) {
    return false;
  }
  settings.cellSampling = this->Levels->sampling();
  return true;
}

MarchSettings Renderer::Implementation::settingsFor(const Frame& frame,
                                                    const RayGeometry& geometry) const
{
  MarchSettings settings;
  settings.dims = glm::dvec3(this->Volume.dims);
  settings.step = frame.sampleDistance;
  settings.adaptive = frame.adaptiveSampling && frame.blending.mode == BlendMode::Composite;
  settings.unitsPerT = geometry.worldPerUnit() / frame.unitDistance;
  settings.projector = this->projector();
  if (frame.cropping && !BoxOf(*frame.cropping).full) { // rays end where a box does
    settings.crops = true;
    settings.cropping = *frame.cropping;
  }
  return settings;
}

FrameStatistics
Renderer::Implementation::marchCached(const Frame& frame, const RayGeometry& geometry,
                                      MarchSettings& settings, const Shading* shading,
                                      const WorkLimit& limit, const PassOutput& output,
                                      const std::function<bool()>& keepGoing)
{
  const BrickStore::Call call = this->Cached->call();
  const std::int64_t measured = this->measuredPoints();
  const bool final = !this->choosesLevels(frame, settings) ||
                     this->chooseLevels(frame, limit, keepGoing, settings);
  Frame meanwhile = frame; // until all is measured, the picture is as by distance
  meanwhile.levelOfDetailScale = final ? frame.levelOfDetailScale : 1.0;
  FrameStatistics statistics = this->Cached->render(meanwhile, geometry, this->Cells, *this->Colors,
                                                    settings, shading, limit, output, keepGoing);
  statistics.complete = statistics.complete && final;
  statistics.work.bricks = call.done();
  statistics.work.networkSamples += this->measuredPoints() - measured;
  return statistics;
}

FrameStatistics Renderer::Implementation::march(const Frame& frame, const PassOutput& output,
                                                const std::function<bool()>& keepGoing)
{
  this->Paths.reset();
  const RayGeometry geometry(frame, this->Volume.dims);
  MarchSettings settings = this->settingsFor(frame, geometry);
  const std::optional<Shading> shading = ShadingOf(frame);
  const Shading* lit = shading ? &*shading : nullptr;
  if (!this->Cached) {
    return this->renderUncached(frame, geometry, settings, lit, output, keepGoing);
  }
  const WorkLimit limit(frame.timeLimit, this->Options.deterministic);
  if (!this->choosesLevels(frame, settings) && this->isDrawnElsewhere(frame, keepGoing)) {
    const std::optional<FrameStatistics> statistics = this->Drawn->march(
        frame, geometry, settings, this->Colors->lookup(), lit, limit, output, keepGoing);
    if (statistics) {
      return *statistics;
    }
  }
  return this->marchCached(frame, geometry, settings, lit, limit, output, keepGoing);
}

bool Renderer::Implementation::isDrawnElsewhere(const Frame& frame,
                                                const std::function<bool()>& keepGoing)
{
  if (this->Drawn && this->Drawn->draws(frame) && this->Drawn->needsProof()) {
    this->proveDrawing(frame, keepGoing);
  }
  return this->Drawn && this->Drawn->draws(frame);
}

void Renderer::Implementation::proveDrawing(const Frame& frame,
                                            const std::function<bool()>& keepGoing)
{
  constexpr int edge = 24; // pixels: little has to be decoded for them
  Frame small = frame;
  small.mode = RenderMode::RayMarching;
  small.width = small.height = edge;
  small.opaqueDepth = nullptr;
  small.timeLimit = 0;
  // Where pictures make do with what fits, that is nowhere the same, but for the coarsest level.
  small.levelOfDetailScale =
      this->Options.cache.onlyWhatFits ? 1e9 : std::max(frame.levelOfDetailScale, 1.0);
  small.errorTolerance.reset();
  const RayGeometry geometry(small, this->Volume.dims);
  MarchSettings settings = this->settingsFor(small, geometry);
  const std::optional<Shading> shading = ShadingOf(small);
  const Shading* lit = shading ? &*shading : nullptr;
  const WorkLimit limit(0, this->Options.deterministic);
  Image drawn(edge, edge, 4);
  if (this->Drawn->march(small, geometry, settings, this->Colors->lookup(), lit, limit,
                         {drawn, nullptr}, keepGoing)) {
    Image truth(edge, edge, 4);
    this->marchCached(small, geometry, settings, lit, limit, {truth, nullptr}, keepGoing);
    this->Drawn->prove(drawn, truth);
  }
}

TracedTiles Renderer::Implementation::traceRound(const PathRound& round, const WorkLimit& limit,
                                                 const std::function<bool()>& keepGoing)
{
  if (this->Drawn && this->Drawn->draws(round.tracer.frame())) {
    if (std::optional<TracedTiles> traced = this->Drawn->tracePaths(round, limit, keepGoing)) {
      return std::move(*traced);
    }
  }
  return this->Cached->tracePaths(round, limit, keepGoing);
}

FrameStatistics Renderer::Implementation::tracePaths(const Frame& frame, const PassOutput& output,
                                                     const std::function<bool()>& keepGoing)
{
  if (!this->Paths) {
    this->Paths.emplace();
  }
  PathMedium medium{this->Volume.dims, this->Cells, this->Colors->lookup()};
  const WorkLimit limit(frame.timeLimit, this->Options.deterministic);
  if (!this->Cached) {
    const TraceTiles trace = [&](const PathRound& round) {
      return TraceWithNetwork(round, *this->Samples, this->Volume.dims, this->Threads, keepGoing);
    };
    return this->Paths->advance(frame, medium, trace, limit, output);
  }
  this->isDrawnElsewhere(frame, keepGoing); // is found out beforehand
  const BrickStore::Call call = this->Cached->call();
  medium.levels = this->Cached->store().cache().hierarchy().levels();
  const TraceTiles trace = [&](const PathRound& round) {
    return this->traceRound(round, limit, keepGoing);
  };
  FrameStatistics statistics = this->Paths->advance(frame, medium, trace, limit, output);
  statistics.work.bricks = call.done();
  return statistics;
}

FrameStatistics Renderer::render(const Frame& wanted, Image& rgba, Image* depth,
                                 const std::function<bool()>& keepGoing, Image* samples)
{
  const Timer timer;
  Implementation& self = *this->Self;
  const Frame frame = self.Cached ? WithoutOtherErrors(wanted) : wanted;
  if (!self.Colors) {
    throw Error(ErrorCode::InvalidArgument, "set a transfer function before rendering");
  }
  RayGeometry(frame, self.Volume.dims); // throws for what is out of range
  self.buildFor(frame.blending);
  rgba = Image(frame.width, frame.height, 4);
  if (depth != nullptr) {
    *depth = Image(frame.width, frame.height, 1);
  }
  if (samples != nullptr) {
    const bool counts = frame.mode == RenderMode::RayMarching && self.Cached;
    *samples = counts ? Image(frame.width, frame.height, 2) : Image();
    samples = counts ? samples : nullptr;
  }
  const PassOutput output{rgba, depth, samples};
  FrameStatistics statistics = frame.mode == RenderMode::PathTracing
                                   ? self.tracePaths(frame, output, keepGoing)
                                   : self.march(frame, output, keepGoing);
  statistics.seconds = timer.seconds();
  return statistics;
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Renderer.h"

#include "Core/Error.h"
#include "Core/Render/RendererImplementation.h"
#include "Core/Render/Scene/DrawnFrame.h"
#include "Core/Render/Scene/FrameCheck.h"
#include "Core/Timer.h"

#include <optional>
#include <utility>

namespace inr {

namespace {

RendererOptions Consistent(RendererOptions options)
{
  options.cache.background = options.cache.background && !options.deterministic;
  return options;
}

InferencePrecision PrecisionOf(const NetworkDescription& network, const RendererOptions& options)
{
  // Float32 leaves out what ReLU made zero: of trained networks, split numbers make bricks of 64
  // neurons in 0.77 to 0.96 of its time, those of 32 and 48 in 0.94 to 1.04.
  constexpr int worthSplitting = 64;
  if (options.accelerator) { // what that gives is compared with this, and may be replaced by it
    return InferencePrecision::Float32;
  }
  const bool rounds = options.cached && options.cache.precision != CachePrecision::Float32;
  const bool splits = rounds && network.neurons >= worthSplitting;
  return options.inference.value_or(splits ? InferencePrecision::SplitBFloat16
                                           : InferencePrecision::Float32);
}

std::shared_ptr<const Evaluator> FieldOf(const ModelPointer& model, const RendererOptions& options)
{
  return MakeEvaluator(model, options.kernel, PrecisionOf(model->description.network, options));
}

const ModelPointer& Existing(const ModelPointer& model)
{
  Require(model != nullptr, "a renderer needs a model");
  return model;
}

const std::shared_ptr<const Evaluator>& Valid(const std::shared_ptr<const Evaluator>& field,
                                              const VolumeInfo& volume, const MacroCells& cells)
{
  Require(field != nullptr, "a renderer needs a field");
  RequireValidVolume(volume, ErrorCode::InvalidArgument);
  if (!cells.empty()) {
    RequireValidGeometry(cells, ErrorCode::InvalidArgument);
    // By division, as wrong dimensions may have a product beyond all numbers.
    const glm::i64vec3& dims = cells.dims;
    const auto ranges = static_cast<std::int64_t>(cells.ranges.size());
    Require(dims.x > 0 && dims.y > 0 && dims.z > 0 && ranges % dims.x == 0 &&
                ranges / dims.x % dims.y == 0 && ranges / dims.x / dims.y == dims.z,
            "macro-cells need a range each");
  }
  return field;
}

/// Null where their ranges may not hold.
std::shared_ptr<const MacroCells> SharedCells(const MacroCells& cells, const ModelPointer& model)
{
  if (cells.empty() || !cells.rangesHold()) {
    return nullptr;
  }
  return model && &cells == &model->macroCells
             ? std::shared_ptr<const MacroCells>(model, &cells) // they may be large
             : std::make_shared<MacroCells>(cells);
}

} // namespace

Renderer::Implementation::Implementation(std::shared_ptr<const Evaluator> field,
                                         std::shared_ptr<const void> identity,
                                         const ModelPointer& model, VolumeInfo volume,
                                         const MacroCells& cells, RendererOptions options)
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
    const CachedField field{this->Field,       this->Identity,
                            this->Volume.dims, SharedCells(cells, model),
                            accelerator,       model};
    this->Cached.emplace(field, this->Options.cache, kernel, this->Threads);
  } else if (accelerator) {
    this->Samples = MakeEvaluator(this->Accelerated, this->Field);
  }
  if (accelerator) {
    this->tryAccelerator();
  }
}

Renderer::Renderer(const ModelPointer& model, const RendererOptions& options)
    : Self(std::make_unique<Implementation>(FieldOf(Existing(model), options), model, model,
                                            model->volume, model->macroCells, options))
{}

Renderer::Renderer(const std::shared_ptr<const Evaluator>& field, const VolumeInfo& volume,
                   const MacroCells& cells, const RendererOptions& options)
    : Self(std::make_unique<Implementation>(Valid(field, volume, cells), field, nullptr, volume,
                                            cells, options))
{}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::int64_t Renderer::colorsVersion() const { return this->Self->ColorsVersion; }

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

void Renderer::forgetPaths(int view)
{
  Drawing::RequireNone(this->Self->IsDrawing);
  this->Self->Paths.forget(view);
}

int Renderer::threads() const { return this->Self->Threads.threads(); }

void Renderer::setTransferFunction(const TransferFunction& transferFunction)
{
  Implementation& self = *this->Self;
  Drawing::RequireNone(self.IsDrawing);
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
    this->Drawn.emplace(this->Accelerated, this->Accelerated->makeNetworkRenderer());
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
  this->PreIntegrated.reset();
  this->Surfaces = VisibleSurfaces(this->Seen.isosurfaces, this->Volume, this->Colors->lookup());
  this->Cells.update(VisibilityFor(this->projector(), *this->Colors), this->Threads);
  if (this->Drawn) {
    this->Drawn->setColors(this->Cells, this->Colors->lookup());
  }
  ++this->ColorsVersion;
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

bool Renderer::Implementation::choosesLevels(const Frame& frame) const
{
  return this->Cached && LevelChooser::choosesFor(frame, this->Cells.rangesHold());
}

LevelChoice Renderer::Implementation::chooseLevels(const Frame& frame, const DrawCall& call,
                                                   MarchSettings& settings)
{
  LevelChoice choice{frame};
  if (!this->choosesLevels(frame)) {
    return choice;
  }
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
  const std::int64_t before = this->Levels->measuredPoints();
  choice.final =
      this->Levels->choose(wish, {geometry, frame.width, frame.height}, this->Cells,
                           this->Colors->lookup(), this->Threads, call.limit, call.keepGoing);
  choice.points = this->Levels->measuredPoints() - before;
  if (choice.final) {
    settings.cellSampling = this->Levels->sampling();
  } else {
    choice.frame.levelOfDetailScale = 1.0; // what tells it from the one with chosen samples
  }
  return choice;
}

FrameStatistics Renderer::render(const Frame& wanted, Image& rgba, Image* depth,
                                 const std::function<bool()>& keepGoing, Image* samples)
{
  const Timer timer;
  Implementation& self = *this->Self;
  const Drawing drawing(self.IsDrawing);
  if (!self.Colors) {
    throw Error(ErrorCode::InvalidArgument, "set a transfer function before rendering");
  }
  RequireValid(wanted);
  const Frame frame = AsItIsDrawn(wanted, self.Cached.has_value());
  RayGeometry(frame, self.Volume.dims); // throws for matrices that are of no use
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
  const std::function<bool()> asks = keepGoing ? [&] {
    const BrickStore::Awaited fromHere;
    return keepGoing();
  } : std::function<bool()>();
  FrameStatistics statistics = frame.mode == RenderMode::PathTracing
                                   ? self.tracePaths(frame, output, asks)
                                   : self.march(frame, output, asks);
  statistics.seconds = timer.seconds();
  return statistics;
}

} // namespace inr

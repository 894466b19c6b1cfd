// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/FramePainter.h"

#include "Core/Error.h"
#include "Core/Render/PictureParts.h"
#include "Core/Render/Scene/DrawnFrame.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tolerance/StoragePrecision.h"
#include "Representations/Mapper/Pictures/FrameBuilder.h"
#include "Representations/Mapper/Scene/MapperInput.h"
#include "Representations/Mapper/Scene/SceneCheck.h"
#include "Representations/Mapper/Selection/PickedCells.h"
#include "Representations/Mapper/Selection/SelectionPass.h"
#include "Representations/Mapper/Window/ComposedLight.h"
#include "Representations/Mapper/Window/LayerExchange.h"
#include "Representations/Mapper/Window/OpaqueDepth.h"
#include "vtkINRDataArray.h"

#include <vtkHardwareSelector.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <thread>
#include <utility>

namespace inr {
namespace {

constexpr double Unlimited = std::numeric_limits<double>::infinity();

/// Asks clock and window between tiles whether to go on. The window's observers may touch the
/// application, so they are only called on the thread that called the mapper.
std::function<bool()> Unless(vtkRenderWindow* window, const Timer& deadline)
{
  return [window, deadline, caller = std::this_thread::get_id()] {
    return deadline.left() > 0 &&
           (std::this_thread::get_id() != caller || !window->CheckAbortStatus());
  };
}

/// Of pictures that somebody's eye follows; ParaView's of interactive ones.
constexpr double FollowedRate = 5;

/// At which a window wants pictures of each of so many volumes, if it wants them soon.
double RateOf(vtkRenderWindow* window, int volumes)
{
  return window->GetDesiredUpdateRate() * (IsInteractive(window) ? volumes : 1);
}

/// Steps between samples of a picture for a window, of those of a still one.
double StepFactor(vtkRenderWindow* window) { return IsInteractive(window) ? 2 : 1; }

/// Of a frame that is prepared for a window, the still one.
Frame AsStill(Frame frame, vtkRenderWindow* window)
{
  frame.sampleDistance /= StepFactor(window);
  return frame;
}

/// Whether it is captured in another size than it is shown in, or in tiles.
bool IsCapturedOtherwise(vtkRenderer* renderer, const ViewPicture& picture)
{
  vtkRenderWindow* window = renderer->GetRenderWindow();
  const Viewport viewport = GetViewport(renderer);
  const int* tiles = window->GetTileScale();
  return RefinementTimer::isCaptured(window) &&
         (tiles[0] > 1 || tiles[1] > 1 || !picture.hasSize(viewport.width, viewport.height));
}

/// Whether it can become no better.
bool IsFinal(const FrameStatistics& statistics)
{
  return statistics.complete && statistics.missed == 0;
}

} // namespace

FramePainter::FramePainter(std::function<bool()> mayRefine)
    : Stills(this->Pictures, std::move(mayRefine))
{}

std::string FramePainter::paint(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                                const PaintSettings& settings)
{
  const Timer timer;
  this->Group = settings.group;
  ViewPicture& picture = this->Pictures.of(renderer, volume);
  vtkRenderWindow* window = renderer->GetRenderWindow();
  picture.begin(IsInteractive(window) || IsCapturedOtherwise(renderer, picture));
  Frame frame;
  std::string problem;
  this->Group.together([&] { problem = this->prepare(mapper, renderer, volume, settings, frame); });
  if (!this->Group.all(problem.empty())) {
    this->Stills.followUp(picture, renderer->GetRenderWindow(), settings); // nothing goes on
    return problem;
  }
  // Processes that draw together do so where nothing is to be seen, too.
  if (this->Group.all(IsBehindCamera(renderer, volume->GetBounds()))) {
    picture.last().converged = true;
    this->Stills.followUp(picture, renderer->GetRenderWindow(), settings);
    return {};
  }
  const Frame still = AsItIsDrawn(AsStill(frame, window), settings.renderer.cached);
  frame = AsItIsDrawn(std::move(frame), settings.renderer.cached);
  frame.view = picture.frameView();
  if ((picture.requested || picture.goesOn) && !picture.passes()) {
    // Nobody waits for what follows the first look; the application's events do.
    constexpr double piece = 0.1;
    frame.timeLimit = std::min(frame.timeLimit, piece);
  }
  const DepictedScene stillScene = this->depicted(still, renderer, volume);
  const bool isChanged = !picture.wasOfSame(stillScene);
  picture.hurried =
      this->Group.all(settings.hurried && isChanged && !picture.passes() && frame.timeLimit > 0);
  // Of a group's processes, each would have to know whether nothing has changed in the others.
  const bool mayBeStill = IsInteractive(window) && this->Group.isAlone();
  if (!this->draw({frame, renderer, picture, mayBeStill ? &stillScene : nullptr})) {
    problem = "The picture cannot be drawn into this window; it needs OpenGL 3.2 with "
              "float textures.";
  }
  picture.depict(picture.passes() ? this->depicted(frame, renderer, volume) : stillScene);
  picture.last().seconds = timer.seconds();
  if (picture.passes() && !IsInteractive(window)) {
    this->Caster->forgetPaths(picture.frameView()); // of many pixels, which nobody comes back to
  }
  this->Stills.followUp(picture, window, settings);
  return problem;
}

const Image* FramePainter::shown(vtkRenderer* renderer, vtkVolume* volume) const
{
  const ViewPicture* picture = this->Pictures.findShown(renderer, volume);
  return picture ? &picture->last().rgba : nullptr;
}

std::string FramePainter::mark(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                               const PaintSettings& settings, const std::vector<const Image*>& over)
{
  if (!MayBeSelected(renderer)) {
    return {};
  }
  this->Group = settings.group;
  Frame scene;
  std::string problem = this->prepare(mapper, renderer, volume, settings, scene);
  if (!problem.empty()) {
    return problem;
  }
  const PaintedFrame& seen = this->look(scene, renderer, volume).last();
  if (!seen.rgba.pixels.empty()) {
    const Image rgba = WithoutWhatIsUnder(seen.rgba, over);
    const PickedCells cells(rgba, seen.depth, scene.clipToWorld, FindInput(mapper).grid,
                            scene.worldToIndex);
    MarkForSelection(renderer, rgba, cells, this->Blender);
  }
  return {};
}

const ViewPicture& FramePainter::look(const Frame& scene, vtkRenderer* renderer, vtkVolume* volume)
{
  const bool cached = this->Caster.options().cached;
  const Frame drawn = AsItIsDrawn(scene, cached);
  const ViewPicture* shown = this->Pictures.find(renderer, volume);
  // A group has no other picture; else what a selector does not draw hides nothing from it.
  const bool isUsable = !this->Group.isAlone() || !MayHideByWhatIsNotPicked(renderer);
  if (isUsable && shown && shown->depicts(this->depicted(drawn, renderer, volume))) {
    return *shown;
  }
  Frame rays = scene; // paths are long, and end where rays do
  rays.mode = RenderMode::RayMarching;
  rays.view = this->Selected.frameView(); // no view's: what these make goes on
  rays.shading.reset();
  rays = AsItIsDrawn(std::move(rays), cached);
  if (!this->Selected.depicts(this->depicted(rays, renderer, volume))) {
    this->Selected.begin();
    // In a group, not all may be asked; what was drawn has a part of each.
    if (this->Group.isAlone() && this->drawUnseen({rays, renderer, this->Selected})) {
      this->Selected.depict(this->depicted(rays, renderer, volume));
    }
  }
  return this->Selected;
}

bool FramePainter::drawUnseen(const Job& job)
{
  const Viewport viewport = GetViewport(job.renderer);
  const std::int64_t pixels = static_cast<std::int64_t>(viewport.width) * viewport.height;
  if (pixels <= 0) {
    return false;
  }
  vtkRenderWindow* window = job.renderer->GetRenderWindow();
  const Surroundings around = LookAround(job.renderer, viewport, this->Group, nullptr);
  int reduction = this->Rays.factor(window->GetDesiredUpdateRate(), pixels);
  while (this->render(job, this->reduced(around, viewport, reduction), reduction,
                      Unless(window, Timer(Unlimited)))) {
    if (!job.picture.last().statistics.blank || reduction >= ImageReduction::Largest) {
      return true;
    }
    reduction *= 2; // there is no other time for what is missing
  }
  return false;
}

DepictedScene FramePainter::depicted(const Frame& scene, vtkRenderer* renderer,
                                     vtkVolume* volume) const
{
  // A group's processes have to agree, and do not tell each other when something changed.
  return {scene, this->Caster->colorsVersion(),
          this->Group.isAlone() ? TimeOfChange(renderer, volume) : 0};
}

std::string FramePainter::prepare(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                                  const PaintSettings& settings, Frame& frame)
{
  const MapperInput input = FindInput(mapper);
  if (!input.array) {
    return input.problem;
  }
  vtkVolumeProperty* property = volume->GetProperty();
  std::string problem =
      WhyRefused(mapper, property, input.grid, settings.mode, !settings.group.isAlone());
  if (!problem.empty()) {
    return problem;
  }
  frame = MakeFrame(input.grid, mapper, renderer, volume, settings);
  const Model& model = *input.array->GetModel();
  const TransferFunction& colors =
      this->TransferFunctions.get(property, {model.volume.low, model.volume.high});
  RendererOptions options = settings.renderer;
  if (!options.cached) {
    options.cache = {}; // nor is there another renderer for another one
  } else if (frame.errorTolerance) {
    options.cache.precision =
        PrecisionWithin(frame, colors, model.volume, model.macroCells.rangesHold());
  }
  this->makeRenderer(*input.array, options);
  this->Caster->setTransferFunction(colors);
  this->CountSamples = settings.countSamples;
  frame.sampleDistance *= StepFactor(renderer->GetRenderWindow());
  frame.timeLimit = TimeLimit(renderer, settings);
  frame.sharedBy = settings.volumes;
  return {};
}

void FramePainter::makeRenderer(const vtkINRDataArray& array, const RendererOptions& options)
{
  const bool measured = !this->Caster.options().deterministic;
  if (!this->Caster.update(array, options)) {
    return;
  }
  this->Pictures.outdate();
  this->Selected.outdate();
  const bool measures = !options.deterministic;
  if (measures != measured) {
    this->Rays = ImageReduction(measures);
    this->Paths = measures ? ImageReduction(true, ImageReduction::UnmeasuredPaths) : this->Rays;
  }
}

bool FramePainter::draw(const Job& job)
{
  vtkRenderer* renderer = job.renderer;
  const Viewport viewport = GetViewport(renderer);
  const std::int64_t pixels = static_cast<std::int64_t>(viewport.width) * viewport.height;
  if (!this->Group.agree(viewport.width) || !this->Group.agree(viewport.height)) {
    throw Error(ErrorCode::InvalidArgument, "the processes' windows are not of the same size");
  }
  if (pixels <= 0) {
    return true;
  }
  TranslucentPeeler* const peeler = job.scene.blending.projects() ? nullptr : &this->Peeler;
  const Surroundings around = LookAround(renderer, viewport, this->Group, peeler);
  job.picture.last().depthRead = around.depthRead;
  if (job.still && job.picture.showStill(*job.still, viewport.width, viewport.height)) {
    return this->blend(job, around);
  }
  const double rate = RateOf(renderer->GetRenderWindow(), job.scene.sharedBy);
  // Nobody makes a hurried one again that does not keep to that: it is a still one otherwise.
  const double wanted = job.picture.hurried ? FollowedRate * job.scene.sharedBy : rate;
  const int reduction =
      this->Group.largest(this->resolution(job.scene.mode).factor(wanted, pixels));
  const bool isCoarser = job.picture.hurried && reduction > 1;
  std::optional<Surroundings> here = isCoarser
                                         ? this->drawCoarser(job, around, viewport, reduction)
                                         : this->drawInTime(job, around, viewport, rate, reduction);
  if (here && !isCoarser && !this->Group.all(!job.picture.last().statistics.blank)) {
    here = this->drawCoarser(job, around, viewport, this->coarserReduction(job));
  }
  if (!here) {
    return true; // aborted
  }
  if (!this->blend(job, *here)) {
    return false;
  }
  PaintedFrame& last = job.picture.last();
  last.converged = this->Group.all(last.statistics.complete);
  return true;
}

std::optional<Surroundings> FramePainter::drawInTime(const Job& job, const Surroundings& around,
                                                     const Viewport& viewport, double rate,
                                                     int reduction)
{
  Timer deadline = this->deadline(rate, reduction);
  Surroundings here = this->reduced(around, viewport, reduction);
  while (!this->renderTogether(job, here, reduction, deadline)) {
    if (this->Group.all(deadline.left() > 0)) {
      return std::nullopt;
    }
    reduction = std::min(4 * reduction, ImageReduction::Largest);
    here = this->reduced(around, viewport, reduction);
    deadline = this->deadline(rate, reduction);
  }
  return here;
}

/// What is around as a picture with 1/reduction of the viewport's width and height meets it,
/// wherever in the group it was seen.
Surroundings FramePainter::reduced(const Surroundings& around, const Viewport& viewport,
                                   int reduction) const
{
  const int width = (viewport.width + reduction - 1) / reduction;
  const int height = (viewport.height + reduction - 1) / reduction;
  Surroundings here;
  this->Group.together([&] { here = around.in(viewport, width, height); });
  here.layers = ShareLayers(this->Group, here.layers, static_cast<std::size_t>(width) * height);
  return here;
}

bool FramePainter::renderTogether(const Job& job, const Surroundings& around, int reduction,
                                  const Timer& deadline)
{
  const auto keepGoing = Unless(job.renderer->GetRenderWindow(), deadline);
  bool done = false;
  this->Group.together([&] { done = this->render(job, around, reduction, keepGoing); });
  return this->Group.all(done);
}

int FramePainter::coarserReduction(const Job& job)
{
  const double patience = 0.25 / job.scene.sharedBy; // seconds, beyond what the finer one took
  // By what is known of this picture: what others took is another matter.
  const PaintedFrame& fine = job.picture.last();
  const auto seconds = [&](int divided) {
    const double ratio = static_cast<double>(divided) / fine.reduction;
    return fine.statistics.marchSeconds / (ratio * ratio);
  };
  int reduction = std::min(2 * fine.reduction, ImageReduction::Largest);
  while (reduction < ImageReduction::Largest && seconds(reduction) > patience) {
    reduction *= 2;
  }
  return this->Group.largest(reduction);
}

std::optional<Surroundings> FramePainter::drawCoarser(const Job& job, const Surroundings& around,
                                                      const Viewport& viewport, int reduction)
{
  constexpr double once = 0.01; // of rays: with what there is
  PaintedFrame& fine = job.picture.last();
  ViewPicture& picture = job.picture.coarser();
  const PaintedFrame& coarse = picture.last();
  Frame scene = job.scene;
  scene.view = picture.frameView();
  if (scene.mode == RenderMode::RayMarching) {
    scene.timeLimit = std::min(scene.timeLimit, once);
  }
  // What is around, the picture itself is told by.
  const DepictedScene depicted{scene, this->Caster->colorsVersion(), 0};
  if (this->Group.all(picture.depicts(depicted) && !coarse.statistics.blank)) {
    reduction = coarse.reduction; // others would come and go
  }
  Surroundings here;
  for (bool blank = true; blank; reduction = std::min(4 * reduction, ImageReduction::Largest)) {
    here = this->reduced(around, viewport, reduction);
    picture.begin();
    if (!this->renderTogether({scene, job.renderer, picture, nullptr, true}, here, reduction,
                              Timer(Unlimited))) {
      const bool depthRead = fine.depthRead;
      fine = {}; // nobody has seen it
      fine.depthRead = depthRead;
      return std::nullopt;
    }
    blank = reduction < ImageReduction::Largest && !this->Group.all(!coarse.statistics.blank);
  }
  picture.depict(depicted);
  job.picture.showCoarser();
  return here;
}

bool FramePainter::blend(const Job& job, const Surroundings& around)
{
  vtkRenderer* renderer = job.renderer;
  const Viewport viewport = GetViewport(renderer);
  const Image& rgba = job.picture.last().rgba;
  if (this->Group.isAlone()) {
    return this->Blender.blend(renderer, viewport, rgba);
  }
  Image picture = this->Group.whole(rgba);
  LimitLight(picture, around, this->Group, renderer, viewport);
  const bool done = !this->Group.draws() || this->Blender.blend(renderer, viewport, picture);
  return this->Group.all(done);
}

/// When a picture is given up for one with fewer pixels, so that the window stays alive whatever a
/// picture costs.
Timer FramePainter::deadline(double rate, int reduction) const
{
  const bool waits = rate < ImageReduction::StillRate || this->Caster.options().deterministic ||
                     reduction >= ImageReduction::Largest;
  return Timer(waits ? Unlimited : 1 / rate);
}

/// Renders among what is `around` the picture's pixels; false, and there is no picture, when it was
/// stopped.
bool FramePainter::render(const Job& job, const Surroundings& around, int reduction,
                          const std::function<bool()>& keepGoing)
{
  Frame frame = job.scene;
  frame.width = around.width;
  frame.height = around.height;
  std::vector<float> ownDepth;
  if (!this->Group.isAlone()) {
    ownDepth = around.depth;
    const PixelBox seen = PixelsOf(frame, this->Caster.model().volume.dims);
    KeepOnly(PartOf(seen, this->Group.process(), this->Group.processes()),
             {frame.width, frame.height}, ownDepth);
  }
  const std::vector<float>& depth = ownDepth.empty() ? around.depth : ownDepth;
  frame.opaqueDepth = depth.empty() ? nullptr : depth.data();
  frame.layers = around.layers;
  if (job.picture.showAgain(frame, this->CountSamples, this->Caster->colorsVersion())) {
    return true;
  }
  PaintedFrame& last = job.picture.last();
  const bool depthRead = last.depthRead;
  try {
    last.statistics = this->Caster->render(frame, last.rgba, &last.depth, keepGoing,
                                           this->CountSamples ? &last.samples : nullptr);
  } catch (const Error& error) {
    last = {}; // half a picture must not be written out later
    if (error.code() == ErrorCode::Cancelled) {
      last.depthRead = depthRead;
      return false;
    }
    throw;
  } catch (...) { // no memory
    last = {};
    throw;
  }
  last.backend = this->Caster.backendOf(last.statistics);
  this->Caster.noteFailure();
  last.reduction = reduction;
  this->resolution(frame.mode)
      .record(last.statistics.marchSeconds, std::int64_t{frame.width} * frame.height);
  if (IsFinal(last.statistics) || (job.standsIn && !last.statistics.blank)) {
    job.picture.finish(frame, this->CountSamples, this->Caster->colorsVersion());
  }
  return true;
}

} // namespace inr

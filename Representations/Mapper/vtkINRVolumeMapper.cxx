// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRVolumeMapper.h"

#include "CUDA/CudaAccelerator.h"
#include "Core/Error.h"
#include "Core/Image/Exr.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Readers/Common/Processes.h"
#include "Representations/Mapper/Pictures/FramePainter.h"
#include "Representations/Mapper/Pictures/PaintSettings.h"
#include "Representations/Mapper/Window/DeferredDrawing.h"
#include "Representations/Mapper/Window/DrawingOrder.h"

#include <vtkHardwareSelector.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTimeStamp.h>
#include <vtkVolume.h>
#include <vtkWeakPointer.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>

vtkStandardNewMacro(vtkINRVolumeMapper);

namespace {

/** What `call` returns or throws: nothing may cross VTK. Empty where nothing goes wrong. */
template <class Call> std::string ProblemOf(const Call& call)
{
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return "There is not enough memory to draw the volume; make the picture or CacheSize smaller.";
  } catch (const std::exception& exception) {
    return exception.what();
  }
}

} // namespace

struct vtkINRVolumeMapper::Internals
{
  explicit Internals(vtkINRVolumeMapper* mapper)
      : Painter([mapper] {
          const vtkSmartPointer<vtkINRVolumeMapper> kept = mapper; // whatever observers delete
          bool mayRefine = true;
          mapper->InvokeEvent(RefineEvent, &mayRefine);
          return mayRefine;
        }),
        AfterPeeling([mapper](vtkRenderer* renderer, vtkVolume* volume) {
          mapper->Render(renderer, volume);
        })
  {}

  inr::FramePainter Painter;
  inr::DeferredDrawing AfterPeeling;
  inr::DrawingOrder Order;
  bool IsAhead = false; ///< drawn because of another volume, which is in front
  std::string LastError;
  vtkTimeStamp Drawn; ///< the last frame

  bool Searched = false; ///< for an accelerator, which may be null
  std::shared_ptr<const inr::Accelerator> Accelerator;
  std::string WhyNone;
  bool BackendReported = false; ///< since it was set

  vtkWeakPointer<vtkMultiProcessController> Controller;
};

vtkINRVolumeMapper::vtkINRVolumeMapper() : Self(std::make_unique<Internals>(this)) {}
vtkINRVolumeMapper::~vtkINRVolumeMapper() = default;

void vtkINRVolumeMapper::SetBackend(int backend)
{
  if (backend < AUTO || backend > CUDA) {
    vtkErrorMacro("There is no Backend " << backend << "; it is 0 (auto), 1 (CPU) or 2 (CUDA).");
    return;
  }
  if (backend != this->Backend || this->Self->BackendReported) {
    this->Modified();
  }
  this->Backend = backend;
  this->Self->Searched = false; // what has failed is tried again
  this->Self->BackendReported = false;
}

void vtkINRVolumeMapper::SetLocalRank(int rank)
{
  rank = std::max(rank, 0);
  if (rank != this->LocalRank) {
    this->LocalRank = rank;
    this->Self->Searched = false;
    this->Modified();
  }
}

void vtkINRVolumeMapper::SetController(vtkMultiProcessController* controller)
{
  if (controller != this->Self->Controller) {
    this->Self->Controller = controller;
    this->Modified();
  }
}

bool vtkINRVolumeMapper::GetDrawsTogether()
{
  const int blend = this->GetBlendMode();
  const bool hasPieces = blend == COMPOSITE_BLEND && this->RenderMode == RAY_MARCHING;
  vtkMultiProcessController* controller = this->Self->Controller;
  return (!hasPieces || this->AlwaysTogether) && AreSeveral(controller);
}

std::shared_ptr<const inr::Accelerator> vtkINRVolumeMapper::FindAccelerator(std::string& reason)
{
  inr::cuda::FoundAccelerator found = inr::cuda::FindAccelerator(this->LocalRank);
  reason = found.reason;
  return found.accelerator;
}

std::shared_ptr<const inr::Accelerator> vtkINRVolumeMapper::WantedAccelerator()
{
  Internals& self = *this->Self;
  if (this->Backend == CPU) {
    return nullptr;
  }
  if (!self.Searched) {
    self.Accelerator = this->FindAccelerator(self.WhyNone);
    self.Searched = true;
  }
  return self.Accelerator;
}

/** Empty where there is nothing to say. */
std::string vtkINRVolumeMapper::WhyNotAccelerated() const
{
  const Internals& self = *this->Self;
  const bool asked = this->Backend == CUDA;
  if (asked && self.Searched && !self.Accelerator) {
    return "There is no GPU for Backend CUDA (" + self.WhyNone +
           "). The CPU draws instead; with Backend Auto or CPU it does so without a word.";
  }
  const auto failure = self.Painter.acceleratorFailure();
  if (failure && failure->atWork) {
    return "The GPU has failed and is not used any more: " + failure->reason +
           ". The CPU goes on with the picture; set Backend to try the GPU again.";
  }
  if (failure && asked) {
    return "The GPU cannot be used for this volume: " + failure->reason +
           ". The CPU draws instead; set Backend to try the GPU again.";
  }
  return "";
}

void vtkINRVolumeMapper::ReportBackend()
{
  if (this->Self->BackendReported) {
    return;
  }
  const std::string reason = this->WhyNotAccelerated();
  if (!reason.empty()) {
    this->Self->BackendReported = true;
    vtkWarningMacro(<< reason);
  }
}

double vtkINRVolumeMapper::GetFrameTime() const { return this->Self->Painter.last().seconds; }

vtkIdType vtkINRVolumeMapper::GetNumberOfSamples() const
{
  return this->Self->Painter.last().statistics.samples;
}

vtkIdType vtkINRVolumeMapper::GetNumberOfClampedSamples() const
{
  return this->Self->Painter.last().statistics.clamped;
}

vtkIdType vtkINRVolumeMapper::GetNumberOfNetworkSamples() const
{
  return this->Self->Painter.last().statistics.work.networkSamples;
}

vtkIdType vtkINRVolumeMapper::GetNumberOfDecodedBricks() const
{
  return this->Self->Painter.last().statistics.work.bricks.bricks;
}

vtkIdType vtkINRVolumeMapper::GetNumberOfVisitedCells() const
{
  return this->Self->Painter.last().statistics.work.cells;
}

int vtkINRVolumeMapper::GetImageReduction() const { return this->Self->Painter.last().reduction; }

bool vtkINRVolumeMapper::GetConverged() const { return this->Self->Painter.last().converged; }

double vtkINRVolumeMapper::GetCacheHitRate() const
{
  const inr::PaintedFrame& last = this->Self->Painter.last();
  if (last.rgba.pixels.empty() && !last.converged) {
    return 0;
  }
  return last.statistics.hitRate();
}

double vtkINRVolumeMapper::GetCacheUsed() const
{
  return static_cast<double>(this->Self->Painter.cacheBytes()) / (1 << 20);
}

int vtkINRVolumeMapper::GetFinestLevel() const
{
  const inr::LevelSpan& levels = this->Self->Painter.last().statistics.levels;
  return levels.empty() ? -1 : levels.finest;
}

int vtkINRVolumeMapper::GetCoarsestLevel() const
{
  return this->Self->Painter.last().statistics.levels.coarsest;
}

vtkIdType vtkINRVolumeMapper::GetNumberOfPaths() const
{
  return this->Self->Painter.last().statistics.paths;
}

const char* vtkINRVolumeMapper::GetBackendInUse() const
{
  return this->Self->Painter.last().backend.c_str();
}

double vtkINRVolumeMapper::TakeRefinementPause()
{
  return this->Self->Painter.stills().takePause();
}

bool vtkINRVolumeMapper::MayRefine(vtkRenderWindow* window)
{
  return inr::RefinementTimer::canRefine(window);
}

void vtkINRVolumeMapper::RefineLater(vtkRenderWindow* window, double pause)
{
  this->Self->Painter.stills().request(window, pause);
}

void vtkINRVolumeMapper::GetFrameSize(int size[2]) const
{
  const inr::Image& picture = this->Self->Painter.last().rgba;
  size[0] = picture.width;
  size[1] = picture.height;
}

vtkMTimeType vtkINRVolumeMapper::GetFrameMTime() const { return this->Self->Drawn.GetMTime(); }

const char* vtkINRVolumeMapper::GetWhyNotDrawn() const { return this->Self->LastError.c_str(); }

bool vtkINRVolumeMapper::GetOpaqueDepthRead() const { return this->Self->Painter.last().depthRead; }

inr::PaintSettings vtkINRVolumeMapper::PresentSettings(vtkRenderer* renderer, vtkVolume* volume)
{
  inr::PaintSettings settings = this->Settings();
  settings.volumes = inr::VolumesWith(renderer, volume);
  settings.renderer.accelerator = this->WantedAccelerator();
  if (this->GetDrawsTogether() && !this->ProcessOrder.empty()) {
    settings.group = inr::PictureGroup(this->Self->Controller, this->ProcessOrder);
  }
  return settings;
}

void vtkINRVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  if (renderer->GetSelector()) {
    this->RenderForSelection(renderer, volume);
    return;
  }
  if (inr::DeferredDrawing::isDue(volume)) {
    this->Self->AfterPeeling.request(renderer, volume);
    return;
  }
  if (!this->Self->Order.begin(renderer, volume, this->Self->IsAhead)) {
    return;
  }
  this->DrawVolumesBehind(renderer, volume);
  const std::string problem = ProblemOf([&] {
    return this->Self->Painter.paint(this, renderer, volume,
                                     this->PresentSettings(renderer, volume));
  });
  this->TimeToDraw = this->Self->Painter.last().seconds;
  if (!this->Self->Painter.last().rgba.pixels.empty()) {
    this->Self->Drawn.Modified();
  }
  this->ReportOnce(problem);
  this->ReportBackend();
}

void vtkINRVolumeMapper::RenderForSelection(vtkRenderer* renderer, vtkVolume* volume)
{
  vtkHardwareSelector* selector = renderer->GetSelector();
  std::vector<const inr::Image*> over; // or the one that comes last would be selected
  for (vtkVolume* other : inr::VolumesBefore(renderer, volume)) {
    const auto* mapper = static_cast<vtkINRVolumeMapper*>(other->GetMapper());
    const inr::Image* shown = mapper->Self->Painter.shown(renderer, other);
    if (shown && other->GetPickable()) {
      over.push_back(shown);
    }
  }
  selector->BeginRenderProp();
  const std::string problem = ProblemOf([&] {
    return this->Self->Painter.mark(this, renderer, volume, this->PresentSettings(renderer, volume),
                                    over);
  });
  selector->EndRenderProp();
  if (!problem.empty()) { // else what was reported of the frame stays reported
    this->ReportOnce(problem);
  }
}

void vtkINRVolumeMapper::DrawVolumesBehind(vtkRenderer* renderer, vtkVolume* volume)
{
  for (vtkVolume* other : inr::VolumesBehind(renderer, volume)) {
    Internals& mapper = *static_cast<vtkINRVolumeMapper*>(other->GetMapper())->Self;
    mapper.IsAhead = true;
    other->RenderVolumetricGeometry(renderer);
    mapper.IsAhead = false;
  }
}

void vtkINRVolumeMapper::ReportOnce(const std::string& problem)
{
  if (!problem.empty() && problem != this->Self->LastError) {
    vtkErrorMacro(<< problem);
  }
  this->Self->LastError = problem;
}

bool vtkINRVolumeMapper::WriteEXR(const char* fileName)
{
  const inr::PaintedFrame& frame = this->Self->Painter.last();
  if (!fileName || frame.rgba.pixels.empty()) {
    vtkErrorMacro("There is no " << (fileName ? "frame" : "file name")
                                 << " to write; render first, then name a file.");
    return false;
  }
  try {
    inr::WriteExr(fileName, frame.rgba, frame.depth, frame.samples);
  } catch (const std::exception& problem) {
    vtkErrorMacro(<< problem.what());
    return false;
  }
  if (this->SampleChannels && frame.samples.pixels.empty()) {
    vtkWarningMacro("'" << fileName << "' has no samples and levels: they are known of frames that "
                        << "were marched through the cache with SampleChannels on.");
  }
  return true;
}

void vtkINRVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Self->Painter.release(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

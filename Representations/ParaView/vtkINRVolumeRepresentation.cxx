// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRVolumeRepresentation.h"

#include "ClientWatch.h"
#include "MachineShare.h"
#include "ModelDelivery.h"
#include "SharedDrawing.h"
#include "VolumePlacement.h"
#include "WhyBlank.h"
#include "vtkAlgorithmOutput.h"
#include "vtkCommunicator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkINRLODVolume.h"
#include "vtkINRStatusActor.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkOutlineSource.h"
#include "vtkPVDataDeliveryManager.h"
#include "vtkPVRenderView.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProcessModule.h"
#include "vtkRenderer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <exception>
#include <utility>

vtkStandardNewMacro(vtkINRVolumeRepresentation);

namespace {

/// Whether several processes of a script have a piece of the data each and nobody else can draw it.
bool HasPieces()
{
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  return vtkProcessModule::GetProcessType() == vtkProcessModule::PROCESS_BATCH && processes &&
         processes->GetNumberOfProcesses() > 1;
}

/// Whether the view is drawn for a selection, which it tells subclasses only.
bool IsSelecting(vtkView* view)
{
  struct Subclass : vtkPVRenderView
  {
    static bool isSelecting(vtkPVRenderView* view)
    {
      return (view->*&Subclass::GetMakingSelection)();
    }
  };
  return Subclass::isSelecting(vtkPVRenderView::SafeDownCast(view));
}

/// Whether another process may have to draw what this one has; of several that have all the model,
/// one sends it.
bool MaySend()
{
  const int type = vtkProcessModule::GetProcessType();
  const bool serves =
      type == vtkProcessModule::PROCESS_SERVER || type == vtkProcessModule::PROCESS_DATA_SERVER;
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  return serves && (!processes || processes->GetLocalProcessId() == 0);
}

} // namespace

vtkINRVolumeRepresentation::vtkINRVolumeRepresentation()
    : Client(std::make_unique<inr::ClientWatch>()), Model(std::make_unique<inr::ModelDelivery>()),
      Placement(std::make_unique<inr::VolumePlacement>())
{
  this->VolumeMapper.TakeReference(vtkINRVolumeMapper::New());
  this->Actor.TakeReference(vtkINRLODVolume::New());
  this->Actor->SetProperty(this->Property);
  this->Actor->SetLODMapper(this->OutlineMapper);
  this->VolumeMapper->AddObserver(vtkINRVolumeMapper::RefineEvent, this,
                                  &vtkINRVolumeRepresentation::OnRefine);
  this->Status->SetVolumeMapper(this->GetMapper());
  this->Status->VisibilityOff();
}

vtkINRVolumeRepresentation::~vtkINRVolumeRepresentation() = default;

int vtkINRVolumeRepresentation::ProcessViewRequest(vtkInformationRequestKey* request,
                                                   vtkInformation* in, vtkInformation* out)
{
  if (request == vtkPVView::REQUEST_UPDATE()) {
    this->ForgetOutlines();
  }
  // Not the direct superclass: it would deliver the volume to the process that draws, and a virtual
  // image has no end of values.
  // NOLINTNEXTLINE(bugprone-parent-virtual-call)
  if (!this->vtkVolumeRepresentation::ProcessViewRequest(request, in, out)) {
    return 0;
  }
  if (request == vtkPVView::REQUEST_UPDATE()) {
    if (!this->Share) { // in all processes alike: they share the machine out together
      this->Share = std::make_unique<inr::MachineShare>(
          inr::ShareMachine(vtkMultiProcessController::GetGlobalController()));
      this->GetMapper()->SetLocalRank(this->Share->rank);
    }
    this->FindOthers();
    this->Deliver(in, out);
  } else if (request == vtkPVView::REQUEST_UPDATE_LOD()) {
    if (HasPieces()) {
      vtkPVRenderView::SetRequiresDistributedRenderingLOD(in, this, true);
    }
  } else if (request == vtkPVView::REQUEST_RENDER()) {
    const bool isSelecting = IsSelecting(this->GetView());
    this->Refines = this->Refines && isSelecting;
    this->GetMapper()->SetForSelection(isSelecting);
    this->Client->update();
    this->TakeDelivery(in);
    static_cast<vtkINRLODVolume*>(this->Actor.Get())->Show(this->DrawsHere());
    this->UpdateMapper();
    this->ReportColouring();
    this->UpdateStatus();
    this->DrawTogether();
    this->ReportOpacityArray();
    this->OutlineMapper->SetInputConnection(
        vtkPVRenderView::GetPieceProducer(in, this, this->OutlinePort));
  }
  return 1;
}

/** Whatever has to be known of other processes before any of them draws. */
void vtkINRVolumeRepresentation::DrawTogether()
{
  vtkRenderer* renderer = vtkPVRenderView::SafeDownCast(this->GetView())->GetRenderer();
  const bool isTurned = inr::IsTurned(
      vtkImageData::SafeDownCast(this->VolumeMapper->GetDataSetInput()), this->Actor->GetMatrix());
  this->GetMapper()->SetAlwaysTogether(inr::ComposesOnePicture(renderer) ||
                                       inr::ShownVolumes(renderer).size() > 1 || isTurned ||
                                       inr::MayOutshineWhite(this->Property, renderer));
  this->Status->SetProcesses(this->Others, renderer->GetRenderWindow());
  const bool sharesStatus = this->Others && this->Status->GetVisibility();
  if (sharesStatus || this->GetMapper()->GetDrawsTogether()) {
    inr::DrawEverywhere(renderer);
  }
}

void vtkINRVolumeRepresentation::FindOthers()
{
  if (this->GetNumberOfInputConnections(0) == 0) {
    return; // one process draws it all
  }
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  vtkDataSet* data = this->VolumeMapper->GetDataSetInput();
  const bool hasSome = data && data->GetNumberOfPoints() > 0;
  const bool haveAll = inr::AllHave(controller, hasSome);
  const bool several = controller && controller->GetNumberOfProcesses() > 1;
  this->Others = haveAll && several ? controller : nullptr;
  this->GetMapper()->SetController(this->Others);
}

void vtkINRVolumeRepresentation::ForgetOutlines()
{
  // A view that keeps the geometry of an animation would not ask for the volume of a time again
  // that it has the outline of.
  auto* view = vtkPVView::SafeDownCast(this->GetView());
  if (view && this->GetNeedsUpdate()) {
    view->GetDeliveryManager()->ClearCache(this);
  }
}

int vtkINRVolumeRepresentation::RequestData(vtkInformation* request, vtkInformationVector** inputs,
                                            vtkInformationVector* outputs)
{
  const int status = this->Superclass::RequestData(request, inputs, outputs);
  this->Carrier->Initialize();
  if (MaySend()) {
    try {
      this->Model->send(vtkImageData::SafeDownCast(this->Cache), this->Carrier);
    } catch (const std::exception& problem) {
      vtkErrorMacro(<< problem.what());
    }
  }
  return status;
}

void vtkINRVolumeRepresentation::Deliver(vtkInformation* in, vtkInformation* out)
{
  vtkPVRenderView::SetPiece(in, this, this->Carrier, 0, 0);
  if (HasPieces()) { // false would forbid it
    vtkPVRenderView::SetRequiresDistributedRendering(in, this, true);
  }
  // The view sorts the processes' pieces, and shares surfaces out among them, by bounds that it
  // takes for the world's whatever the matrix, and looks at anew with new data only, or with those
  // of another port. Of several volumes it would take both pieces' box, which meets other ones.
  const auto shown =
      inr::ShownVolumes(vtkPVRenderView::SafeDownCast(this->GetView())->GetRenderer());
  // Of a solid colour before, ParaView still hides it; it is to be drawn again in this picture.
  const bool leads = shown.empty() ? inr::HasSize(this->Actor) : shown.front() == this->Actor.Get();
  double piece[6];
  std::copy_n(this->DataBounds, 6, piece);
  this->GetMapper()->GetPieceBounds(piece);
  if (this->Placement->update(*this->GetMapper(), piece, *this->Actor->GetMatrix())) {
    std::swap(this->OutlinePort, this->BoundsPort);
  }
  double* const bounds = this->Placement->bounds();
  vtkPVRenderView::SetGeometryBounds(in, this, bounds);
  for (const int port : {this->OutlinePort, this->BoundsPort}) {
    const int use =
        leads && port == this->BoundsPort ? int{vtkPVRenderView::USE_BOUNDS_FOR_REDISTRIBUTION} : 0;
    vtkPVRenderView::SetPiece(in, this, this->OutlineSource->GetOutputDataObject(0), 0, port);
    vtkPVRenderView::SetGeometryBounds(in, this, bounds, nullptr, port);
    vtkPVRenderView::SetOrderedCompositingConfiguration(in, this, use, nullptr, port);
  }
  out->Set(vtkPVRenderView::NEED_ORDERED_COMPOSITING(), 1);
}

void vtkINRVolumeRepresentation::TakeDelivery(vtkInformation* in)
{
  if (this->GetNumberOfInputConnections(0) > 0) {
    return; // the data are here
  }
  vtkAlgorithmOutput* producer = vtkPVRenderView::GetPieceProducer(in, this, 0);
  vtkDataObject* carrier =
      producer ? producer->GetProducer()->GetOutputDataObject(producer->GetIndex()) : nullptr;
  try {
    vtkImageData* image = this->Model->receive(vtkPolyData::SafeDownCast(carrier));
    this->VolumeMapper->SetInputDataObject(image);
    this->Actor->SetEnableLOD(image ? 0 : 1); // the outline
    this->ReportShared(image != nullptr);
  } catch (const std::exception& problem) {
    vtkErrorMacro(<< problem.what());
  }
}

void vtkINRVolumeRepresentation::ReportShared(bool drawsAll)
{
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  const bool others = processes && processes->GetNumberOfProcesses() > 1;
  if (drawsAll && others && !this->SharedReported) {
    this->SharedReported = true;
    vtkWarningMacro(
        "Of this render server's processes, one draws all of the volume, and surfaces "
        "that others draw may come out on its wrong side. Let the client draw (raise "
        "the Remote Render Threshold), or use a pvserver or one render server process.");
  }
}

bool vtkINRVolumeRepresentation::DrawsHere()
{
  return this->VolumeMapper->GetDataObjectInput() != nullptr;
}

void vtkINRVolumeRepresentation::UpdateMapper()
{
  const inr::MachineShare share = this->Share ? *this->Share : inr::MachineShare();
  this->GetMapper()->SetNumberOfThreads(this->NumberOfThreads > 0 ? this->NumberOfThreads
                                                                  : share.threads);
  this->GetMapper()->SetCacheSize(this->CacheSize > 0 ? this->CacheSize : share.cacheSize);
  // Cropping refers to the bounds of the data. Those that this process has are a piece's, or none
  // where the model was sent to.
  double own[6];
  std::copy_n(this->DataBounds, 6, own);
  this->GetMapper()->GetWholeBounds(this->DataBounds);
  this->UpdateMapperParameters();
  std::copy_n(own, 6, this->DataBounds);
}

bool vtkINRVolumeRepresentation::IsShown()
{
  return this->GetVisibility() && this->LastProblem.empty();
}

bool vtkINRVolumeRepresentation::IsGroup()
{
  return this->GetNumberOfInputConnections(0) > 0 &&
         vtkCompositeDataSet::SafeDownCast(this->GetInputDataObject(0, 0)) != nullptr;
}

void vtkINRVolumeRepresentation::ReportColouring()
{
  const std::string problem =
      this->IsGroup()
          ? "A group of data sets cannot be drawn as an INR volume; show the reader itself, or "
            "the group as \"Volume\""
          : inr::WhyBlank(this->Actor, this->VolumeMapper);
  if (!problem.empty() && problem != this->LastProblem) {
    vtkErrorMacro(<< problem);
  }
  this->LastProblem = problem;
}

void vtkINRVolumeRepresentation::ReportOpacityArray()
{
  if (this->WantsOpacityArray) {
    vtkWarningMacro("A separate opacity array has no effect on an INR volume, as a model holds one "
                    "array; turn \"Use Separate Opacity Array\" off, or show real voxels "
                    "(INRDecode) as \"Volume\".");
  }
  this->WantsOpacityArray = false; // said once
}

void vtkINRVolumeRepresentation::OnRefine(vtkObject*, unsigned long, void* mayRefine)
{
  if (this->Client->isBusy()) {
    *static_cast<bool*>(mayRefine) = false;
  }
}

bool vtkINRVolumeRepresentation::AddToView(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (!this->Superclass::AddToView(view)) {
    return false;
  }
  renderView->GetRenderer()->AddActor(this->Status);
  return true;
}

bool vtkINRVolumeRepresentation::RemoveFromView(vtkView* view)
{
  if (auto* renderView = vtkPVRenderView::SafeDownCast(view)) {
    renderView->GetRenderer()->RemoveActor(this->Status);
  }
  return this->Superclass::RemoveFromView(view);
}

void vtkINRVolumeRepresentation::SetShowStatus(bool on)
{
  this->ShowStatus = on;
  this->UpdateStatus();
}

void vtkINRVolumeRepresentation::SetVisibility(bool on)
{
  this->Superclass::SetVisibility(on);
  this->UpdateStatus();
}

void vtkINRVolumeRepresentation::UpdateStatus()
{
  this->Status->SetVisibility(this->ShowStatus && this->IsShown());
}

vtkINRVolumeMapper* vtkINRVolumeRepresentation::GetMapper()
{
  return static_cast<vtkINRVolumeMapper*>(this->VolumeMapper.Get());
}

void vtkINRVolumeRepresentation::SetRenderMode(int mode) { this->GetMapper()->SetRenderMode(mode); }

void vtkINRVolumeRepresentation::SetSamplesPerPixel(int paths)
{
  this->GetMapper()->SetSamplesPerPixel(paths);
}

void vtkINRVolumeRepresentation::SetScatteringAlbedo(double albedo)
{
  this->GetMapper()->SetScatteringAlbedo(albedo);
}

void vtkINRVolumeRepresentation::SetAnisotropy(double meanCosine)
{
  this->GetMapper()->SetAnisotropy(meanCosine);
}

void vtkINRVolumeRepresentation::SetMaximumBounces(int bounces)
{
  this->GetMapper()->SetMaximumBounces(bounces);
}

void vtkINRVolumeRepresentation::SetScalarOpacityUnitDistance(double distance)
{
  if (!(distance < 0)) {
    this->Superclass::SetScalarOpacityUnitDistance(distance);
  }
}

void vtkINRVolumeRepresentation::SetAmbientLight(double red, double green, double blue)
{
  this->GetMapper()->SetAmbientLight(red, green, blue);
}

void vtkINRVolumeRepresentation::SetSampleDistance(double voxels)
{
  this->GetMapper()->SetSampleDistance(voxels);
}

void vtkINRVolumeRepresentation::SetAdaptiveSampling(bool on)
{
  this->GetMapper()->SetAdaptiveSampling(on);
}

void vtkINRVolumeRepresentation::SetPreIntegration(bool on)
{
  this->GetMapper()->SetPreIntegration(on);
}

void vtkINRVolumeRepresentation::SetLevelOfDetailScale(double scale)
{
  this->GetMapper()->SetLevelOfDetailScale(scale);
}

void vtkINRVolumeRepresentation::SetErrorTolerance(double tolerance)
{
  this->GetMapper()->SetErrorTolerance(tolerance);
}

void vtkINRVolumeRepresentation::SetBackend(int backend) { this->GetMapper()->SetBackend(backend); }

void vtkINRVolumeRepresentation::SetCacheMode(int mode) { this->GetMapper()->SetCacheMode(mode); }

void vtkINRVolumeRepresentation::SetCacheSize(int mebibytes) { this->CacheSize = mebibytes; }

void vtkINRVolumeRepresentation::SetInferencePrecision(int precision)
{
  this->GetMapper()->SetInferencePrecision(precision);
}

void vtkINRVolumeRepresentation::SetCachePrecision(int precision)
{
  this->GetMapper()->SetCachePrecision(precision);
}

void vtkINRVolumeRepresentation::SetBrickSize(int voxels)
{
  this->GetMapper()->SetBrickSize(voxels);
}

void vtkINRVolumeRepresentation::SetMaximumRequests(int bricks)
{
  this->GetMapper()->SetMaximumRequests(bricks);
}

void vtkINRVolumeRepresentation::SetPriorityRanking(bool on)
{
  this->GetMapper()->SetPriorityRanking(on);
}

void vtkINRVolumeRepresentation::SetPreloading(bool on) { this->GetMapper()->SetPreloading(on); }

void vtkINRVolumeRepresentation::SetStillTimeLimit(double seconds)
{
  this->GetMapper()->SetStillTimeLimit(seconds);
}

void vtkINRVolumeRepresentation::SetNumberOfThreads(int threads)
{
  this->NumberOfThreads = threads;
}

void vtkINRVolumeRepresentation::SetSeed(int seed) { this->GetMapper()->SetSeed(seed); }

void vtkINRVolumeRepresentation::SetDeterministic(bool on)
{
  this->GetMapper()->SetDeterministic(on);
}

void vtkINRVolumeRepresentation::SetSampleChannels(bool on)
{
  this->GetMapper()->SetSampleChannels(on);
}

bool vtkINRVolumeRepresentation::GetConverged()
{
  return this->IsShown() && this->GetMapper()->GetConverged() && !this->Refines;
}

void vtkINRVolumeRepresentation::SetShownElsewhere(bool on)
{
  this->GetMapper()->SetShownElsewhere(on);
}

double vtkINRVolumeRepresentation::GetRefinementPause()
{
  const double own = this->GetMapper()->TakeRefinementPause();
  double longest = own;
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  if (processes && processes->GetNumberOfProcesses() > 1) {
    processes->AllReduce(&own, &longest, 1, vtkCommunicator::MAX_OP);
  }
  this->Refines = longest > 0;
  return longest;
}

bool vtkINRVolumeRepresentation::MayRefine()
{
  auto* view = vtkPVRenderView::SafeDownCast(this->GetView());
  return view && vtkINRVolumeMapper::MayRefine(view->GetRenderWindow());
}

void vtkINRVolumeRepresentation::RefineLater(double pause)
{
  auto* view = vtkPVRenderView::SafeDownCast(this->GetView());
  if (view) {
    this->Client->update();
    this->GetMapper()->RefineLater(view->GetRenderWindow(), pause);
  }
}

double vtkINRVolumeRepresentation::GetCacheHitRate()
{
  return this->IsShown() ? this->GetMapper()->GetCacheHitRate() : 0.0;
}

double vtkINRVolumeRepresentation::GetCacheUsed() { return this->GetMapper()->GetCacheUsed(); }

double vtkINRVolumeRepresentation::GetFrameTime()
{
  return this->IsShown() ? this->GetMapper()->GetFrameTime() : 0.0;
}

const char* vtkINRVolumeRepresentation::GetBackendInUse()
{
  return this->GetMapper()->GetBackendInUse();
}

void vtkINRVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ShowStatus: " << this->ShowStatus << "\n";
  os << indent << "FrameTime: " << this->GetFrameTime() << "\n";
}

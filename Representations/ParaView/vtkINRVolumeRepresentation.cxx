// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRVolumeRepresentation.h"

#include "MachineShare.h"
#include "ModelDelivery.h"
#include "PictureRefinement.h"
#include "Readers/Common/Processes.h"
#include "SharedDrawing.h"
#include "VolumePlacement.h"
#include "WhyBlank.h"
#include "vtkAlgorithmOutput.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkINRDataArray.h"
#include "vtkINRLODVolume.h"
#include "vtkINRStatusActor.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkOutlineSource.h"
#include "vtkPVDataDeliveryManager.h"
#include "vtkPVRenderView.h"
#include "vtkPointData.h"
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
  return vtkProcessModule::GetProcessType() == vtkProcessModule::PROCESS_BATCH &&
         AreSeveral(processes);
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
    : Model(std::make_unique<inr::ModelDelivery>()),
      Placement(std::make_unique<inr::VolumePlacement>())
{
  this->VolumeMapper.TakeReference(vtkINRVolumeMapper::New());
  this->Actor.TakeReference(vtkINRLODVolume::New());
  this->Actor->SetProperty(this->Property);
  this->Actor->SetLODMapper(this->OutlineMapper);
  this->Refinement = std::make_unique<inr::PictureRefinement>(*this->GetMapper());
  this->Status->SetVolume(this->GetVolume(), this->GetMapper());
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
    this->Refinement->begin(*vtkPVRenderView::SafeDownCast(this->GetView()));
    this->TakeDelivery(in);
    this->GetVolume()->Show(this->DrawsHere());
    this->UpdateMapper();
    this->ReportProblem();
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
  this->Differ = !inr::HaveSameModel(controller, data, this->GetColorArrayName());
  const bool share = haveAll && AreSeveral(controller) && !this->Differ;
  this->Others = share ? controller : nullptr;
  this->GetMapper()->SetController(this->Others);
  this->GetVolume()->Withhold(this->Differ);
  if (this->Differ) { // said at once: nothing may be drawn here
    this->ReportProblem();
  }
}

const char* vtkINRVolumeRepresentation::GetColorArrayName()
{
  vtkInformation* colors = this->GetInputArrayInformation(0);
  return colors && colors->Has(vtkDataObject::FIELD_NAME())
             ? colors->Get(vtkDataObject::FIELD_NAME())
             : nullptr;
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
      this->Model->send(inputs[0]->GetNumberOfInformationObjects() == 1
                            ? vtkDataObject::GetData(inputs[0], 0)
                            : nullptr,
                        this->Carrier);
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
  const bool mayLead =
      shown.empty() ? inr::HasSize(this->Actor) : shown.front() == this->Actor.Get();
  const bool leads = mayLead && !this->Differ; // or its boxes do not fill space
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
    const bool others = AreSeveral(vtkMultiProcessController::GetGlobalController());
    this->Actor->SetEnableLOD(image || others ? 0
                                              : 1); // the outline; of several, each has part of it
    this->ReportShared(image && vtkINRDataArray::FindIn(image->GetPointData()));
  } catch (const std::exception& problem) {
    vtkErrorMacro(<< problem.what());
  }
}

void vtkINRVolumeRepresentation::ReportShared(bool drawsAll)
{
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  const bool others = AreSeveral(processes);
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
  return this->VolumeMapper->GetDataObjectInput() != nullptr && !this->Differ;
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
  return this->GetNumberOfInputConnections(0) > 0
             ? vtkCompositeDataSet::SafeDownCast(this->GetInputDataObject(0, 0)) != nullptr
             : this->Model->isOfGroup();
}

std::string vtkINRVolumeRepresentation::WhyNothingIsDrawn()
{
  if (this->IsGroup()) {
    return "A group of data sets cannot be drawn as an INR volume; show the reader itself, or the "
           "group as \"Volume\"";
  }
  if (this->Differ) {
    return "The processes have different models, or some of them have none, so that they do not "
           "draw this volume; give all of them the same file and reload it";
  }
  return inr::WhyBlank(this->Actor, this->VolumeMapper);
}

void vtkINRVolumeRepresentation::ReportProblem()
{
  const std::string problem = this->WhyNothingIsDrawn();
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

vtkINRLODVolume* vtkINRVolumeRepresentation::GetVolume()
{
  return static_cast<vtkINRLODVolume*>(this->Actor.Get());
}

vtkINRVolumeMapper* vtkINRVolumeRepresentation::GetMapper()
{
  return static_cast<vtkINRVolumeMapper*>(this->VolumeMapper.Get());
}

double vtkINRVolumeRepresentation::GetRefinementPause() { return this->Refinement->pauseOfAll(); }

bool vtkINRVolumeRepresentation::MayRefine()
{
  return inr::PictureRefinement::isPossible(vtkPVRenderView::SafeDownCast(this->GetView()));
}

void vtkINRVolumeRepresentation::RefineLater(double pause)
{
  this->Refinement->later(vtkPVRenderView::SafeDownCast(this->GetView()), pause);
}

void vtkINRVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ShowStatus: " << this->ShowStatus << "\n";
  os << indent << "FrameTime: " << this->GetFrameTime() << "\n";
}

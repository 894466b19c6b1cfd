// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMINRRepresentationProxy.h"

#include "QtApplication.h"
#include "vtkCallbackCommand.h"
#include "vtkClientServerStream.h"
#include "vtkCommand.h"
#include "vtkINRVolumeRepresentation.h"
#include "vtkObjectFactory.h"
#include "vtkPVSession.h"
#include "vtkSMSession.h"

vtkStandardNewMacro(vtkSMINRRepresentationProxy);

vtkSMINRRepresentationProxy::vtkSMINRRepresentationProxy()
{
  this->RenderCommand->SetClientData(this);
  this->RenderCommand->SetCallback(&vtkSMINRRepresentationProxy::OnRender);
}

vtkSMINRRepresentationProxy::~vtkSMINRRepresentationProxy() { this->Forget(); }

void vtkSMINRRepresentationProxy::UpdatePropertyInformationInternal(vtkSMProperty* property)
{
  // A session without a server answers itself wherever it is told to ask.
  const vtkTypeUInt32 everywhere = this->Location;
  vtkINRVolumeRepresentation* here = this->Here();
  const vtkTypeUInt32 drawing = vtkPVSession::RENDER_SERVER | vtkPVSession::RENDER_SERVER_ROOT;
  this->Location =
      here && here->DrawsHere() ? vtkTypeUInt32{vtkPVSession::CLIENT} : everywhere & drawing;
  this->Superclass::UpdatePropertyInformationInternal(property);
  this->Location = everywhere;
}

void vtkSMINRRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  if (view == this->View) {
    return;
  }
  this->Forget();
  this->View = view;
  view->AddObserver(vtkCommand::StartEvent, this->RenderCommand);
  view->AddObserver(vtkCommand::EndEvent, this->RenderCommand);
  if (this->IsDrawnElsewhere()) { // the view's first picture has begun already
    this->Announce();
  }
}

void vtkSMINRRepresentationProxy::Forget()
{
  if (this->View) {
    this->View->RemoveObserver(this->RenderCommand);
  }
}

vtkINRVolumeRepresentation* vtkSMINRRepresentationProxy::Here()
{
  return vtkINRVolumeRepresentation::SafeDownCast(this->GetClientSideObject());
}

bool vtkSMINRRepresentationProxy::IsDrawnElsewhere()
{
  vtkSMSession* session = this->GetSession();
  const bool hasServer = session && (session->GetProcessRoles() & vtkPVSession::RENDER_SERVER) == 0;
  return hasServer && !session->IsMultiClients() && this->Here() && !this->Here()->DrawsHere();
}

void vtkSMINRRepresentationProxy::OnRender(vtkObject*, unsigned long event, void* self,
                                           void* isInteractive)
{
  auto* proxy = static_cast<vtkSMINRRepresentationProxy*>(self);
  if (*static_cast<int*>(isInteractive) != 0 || !proxy->Here()) {
    return;
  }
  const bool isStart = event == vtkCommand::StartEvent;
  if (isStart) {
    proxy->Here()->SetHurried(inr::IsMouseButtonDown());
  }
  if (proxy->IsDrawnElsewhere()) {
    isStart ? proxy->Announce() : proxy->GoOn();
  }
}

/** Before a still picture: whether it is one that goes on, and whether it has to be short. */
void vtkSMINRRepresentationProxy::Announce()
{
  vtkINRVolumeRepresentation* here = this->Here();
  // One of another type, which all images have beside this one, draws nothing.
  const bool refines = here->MayRefine() && here->GetVisibility();
  const bool hurried = refines && inr::IsMouseButtonDown();
  if (refines == this->Announced && hurried == this->Hurried) {
    return;
  }
  vtkClientServerStream stream; // which does not understand a bool
  stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "SetShownElsewhere"
         << static_cast<int>(refines) << vtkClientServerStream::End;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "SetHurried"
         << static_cast<int>(hurried) << vtkClientServerStream::End;
  this->ExecuteStream(stream, false, vtkPVSession::RENDER_SERVER);
  this->Announced = refines;
  this->Hurried = hurried;
}

/** After one. */
void vtkSMINRRepresentationProxy::GoOn()
{
  vtkINRVolumeRepresentation* here = this->Here();
  if (!here->GetVisibility()) {
    here->RefineLater(0);
  } else if (this->Announced) { // else a screenshot: what is on the screen goes on afterwards
    here->RefineLater(this->AskForPause());
  }
}

double vtkSMINRRepresentationProxy::AskForPause()
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "GetRefinementPause"
         << vtkClientServerStream::End;
  this->ExecuteStream(stream, false, vtkPVSession::RENDER_SERVER);
  double pause = 0;
  this->GetLastResult(vtkPVSession::RENDER_SERVER_ROOT).GetArgument(0, 0, &pause);
  return pause;
}

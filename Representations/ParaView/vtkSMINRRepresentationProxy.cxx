// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMINRRepresentationProxy.h"

#include "vtkINRVolumeRepresentation.h"
#include "vtkObjectFactory.h"
#include "vtkPVSession.h"

vtkStandardNewMacro(vtkSMINRRepresentationProxy);

void vtkSMINRRepresentationProxy::UpdatePropertyInformationInternal(vtkSMProperty* property)
{
  // A session without a server answers itself wherever it is told to ask.
  const vtkTypeUInt32 everywhere = this->Location;
  auto* here = vtkINRVolumeRepresentation::SafeDownCast(this->GetClientSideObject());
  const vtkTypeUInt32 drawing = vtkPVSession::RENDER_SERVER | vtkPVSession::RENDER_SERVER_ROOT;
  this->Location =
      here && here->DrawsHere() ? vtkTypeUInt32{vtkPVSession::CLIENT} : everywhere & drawing;
  this->Superclass::UpdatePropertyInformationInternal(property);
  this->Location = everywhere;
}

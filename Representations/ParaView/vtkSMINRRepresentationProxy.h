// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSMINRRepresentationProxy
 * @brief proxy of vtkINRVolumeRepresentation whose read-only properties are those of who draws
 *
 * A representation lives in the client and in the servers, and ParaView asks the client's for
 * values. Connected to a server, it is the server that draws: its first process is asked here.
 */
#ifndef vtkSMINRRepresentationProxy_h
#define vtkSMINRRepresentationProxy_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkSMRepresentationProxy.h"

class VTKINRREPRESENTATIONS_EXPORT vtkSMINRRepresentationProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMINRRepresentationProxy* New();
  vtkTypeMacro(vtkSMINRRepresentationProxy, vtkSMRepresentationProxy);

protected:
  vtkSMINRRepresentationProxy() = default;
  ~vtkSMINRRepresentationProxy() override = default;

  void UpdatePropertyInformationInternal(vtkSMProperty* property = nullptr) override;

private:
  vtkSMINRRepresentationProxy(const vtkSMINRRepresentationProxy&) = delete;
  void operator=(const vtkSMINRRepresentationProxy&) = delete;
};

#endif

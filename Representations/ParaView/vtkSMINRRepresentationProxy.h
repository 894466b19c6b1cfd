// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSMINRRepresentationProxy
 * @brief what ParaView's client knows of a vtkINRVolumeRepresentation that a server draws
 *
 * A representation lives in the client and in the servers. Connected to a render server, it is the
 * server that draws, and the client that has the window: read-only properties are asked of the
 * server's first process, and pictures that are not complete are asked for again when the window is
 * idle, as those that the client draws itself.
 */
#ifndef vtkSMINRRepresentationProxy_h
#define vtkSMINRRepresentationProxy_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkNew.h"                      // for OnRender
#include "vtkSMRepresentationProxy.h"
#include "vtkWeakPointer.h" // for View

class vtkCallbackCommand;
class vtkINRVolumeRepresentation;

class VTKINRREPRESENTATIONS_EXPORT vtkSMINRRepresentationProxy : public vtkSMRepresentationProxy
{
public:
  static vtkSMINRRepresentationProxy* New();
  vtkTypeMacro(vtkSMINRRepresentationProxy, vtkSMRepresentationProxy);

  void ViewUpdated(vtkSMProxy* view) override;

protected:
  vtkSMINRRepresentationProxy();
  ~vtkSMINRRepresentationProxy() override;

  void UpdatePropertyInformationInternal(vtkSMProperty* property = nullptr) override;

private:
  vtkSMINRRepresentationProxy(const vtkSMINRRepresentationProxy&) = delete;
  void operator=(const vtkSMINRRepresentationProxy&) = delete;

  vtkINRVolumeRepresentation* Here();
  /// By a server that no other client asks for pictures, too, which may be complete ones: the
  /// latest picture, or the first, which may turn out to be drawn here.
  bool IsDrawnElsewhere();
  void Forget();
  static void OnRender(vtkObject* view, unsigned long event, void* self, void* isInteractive);
  void Announce();
  void GoOn();
  double AskForPause();

  vtkWeakPointer<vtkSMProxy> View;
  vtkNew<vtkCallbackCommand> RenderCommand;
  bool Announced = false; ///< to the server: that its pictures are made again
  bool Hurried = false;   ///< and that they are short
};

#endif

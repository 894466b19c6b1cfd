// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkWeakPointer.h"

#include <vector>

class vtkObject;

namespace inr {

/// Knows when ParaView's client has something else to do than to refine a picture.
class ClientWatch
{
public:
  ClientWatch();
  ~ClientWatch();
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;

  /// Finds the client's animations, of which more may come; cheap. There are none in a server.
  void update();
  /// Whether an animation plays or a modal dialog is open.
  bool isBusy() const;

private:
  void watch(vtkObject* scene);
  static void OnPlay(vtkObject* scene, unsigned long event, void* self, void* unused);

  std::vector<vtkWeakPointer<vtkObject>> Scenes;
  vtkWeakPointer<vtkObject> Playing;
  vtkNew<vtkCallbackCommand> Command;
};

} // namespace inr

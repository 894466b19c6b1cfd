// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkWeakPointer.h>

#include <functional>
#include <utility>
#include <vector>

namespace inr {

/// Draws a volume when its renderer is done with everything else.
///
/// A renderer that peels volumes, too, calls their mapper once per peel, with buffers of its own
/// that a finished picture has no place in.
class DeferredDrawing
{
public:
  using Draw = std::function<void(vtkRenderer* renderer, vtkVolume* volume)>;

  explicit DeferredDrawing(Draw draw);
  ~DeferredDrawing() { this->cancel(); }
  DeferredDrawing(const DeferredDrawing&) = delete;
  DeferredDrawing& operator=(const DeferredDrawing&) = delete;

  /// Whether `volume` is being drawn as part of a pass like that.
  static bool isDue(vtkVolume* volume);
  /// Has the volume drawn, once, at the end of the renderer's present frame; so for several. What
  /// lies over the scene is drawn again on top.
  void request(vtkRenderer* renderer, vtkVolume* volume);

private:
  void cancel();
  void draw(vtkRenderer* renderer);
  static void OnEnd(vtkObject* renderer, unsigned long event, void* self, void* unused);

  Draw DrawVolume;
  struct Waiting
  {
    vtkWeakPointer<vtkRenderer> renderer;
    vtkWeakPointer<vtkVolume> volume;
  };
  std::vector<Waiting> Requested;
  vtkNew<vtkCallbackCommand> Command;
};

} // namespace inr

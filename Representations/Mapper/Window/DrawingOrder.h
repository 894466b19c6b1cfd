// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkWeakPointer.h>

#include <vector>

class vtkVolume;

namespace inr {

/// The visible volumes of a renderer that are drawn by a vtkINRVolumeMapper and lie behind
/// `volume`: on the other side of a plane along two of the world's axes that separates their
/// bounds, or, if there is none, with their middle further from the camera.
std::vector<vtkVolume*> VolumesBehind(vtkRenderer* renderer, vtkVolume* volume);
/// Those that it lies behind.
std::vector<vtkVolume*> VolumesBefore(vtkRenderer* renderer, vtkVolume* volume);
/// How many it is drawn with, itself included.
int VolumesWith(vtkRenderer* renderer, vtkVolume* volume);

/// Remembers which volumes a mapper has drawn in the present frame: those behind another one are
/// drawn before it, ahead of their turn.
class DrawingOrder
{
public:
  DrawingOrder();
  ~DrawingOrder() { this->forget(); }
  DrawingOrder(const DrawingOrder&) = delete;
  DrawingOrder& operator=(const DrawingOrder&) = delete;

  /// Whether to draw a volume now. `isAhead`: before one that it is behind of, and not if it has
  /// been drawn in the present frame. Else in its turn, and not if it has been drawn ahead of it.
  bool begin(vtkRenderer* renderer, vtkVolume* volume, bool isAhead);

private:
  void forget();
  static void OnStart(vtkObject* renderer, unsigned long event, void* self, void* unused);

  vtkWeakPointer<vtkRenderer> Renderer;
  std::vector<const vtkVolume*> Drawn; ///< in this frame; only compared
  std::vector<const vtkVolume*> Ahead; ///< of these, those whose turn is yet to come
  vtkNew<vtkCallbackCommand> Command;
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/TranslucentLayers.h"
#include "Representations/Mapper/Scene/Viewport.h"
#include "Representations/Mapper/Window/PictureGroup.h"
#include "Representations/Mapper/Window/TranslucentPeeler.h"

#include <vtkType.h>

#include <memory>
#include <vector>

class vtkRenderer;
class vtkVolume;

namespace inr {

/// The scene's other things, as the pixels of a picture of `width` x `height` have them.
struct Surroundings
{
  int width = 0;
  int height = 0;
  std::vector<float> depth;                        ///< of what is opaque; empty when nothing is
  std::shared_ptr<const TranslucentLayers> layers; ///< null when there are none
  bool depthRead = false;                          ///< from this process' window

  /// The same for a picture of other size over the viewport that these are of.
  Surroundings in(const Viewport& viewport, int width, int height) const;
};

/// What lies before and among the volume: of all that the windows of `group` show, what is opaque
/// and nearest; and what is translucent in this one, which only `peeler` looks for.
Surroundings LookAround(vtkRenderer* renderer, const Viewport& viewport, const PictureGroup& group,
                        TranslucentPeeler* peeler);

/// When anything of the scene but `volume` changed last. The same at two times: nothing has between
/// them.
vtkMTimeType TimeOfChange(vtkRenderer* renderer, vtkVolume* volume);

} // namespace inr

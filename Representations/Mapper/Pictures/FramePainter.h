// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Timer.h"
#include "Representations/Mapper/Pictures/CurrentRenderer.h"
#include "Representations/Mapper/Pictures/ImageReduction.h"
#include "Representations/Mapper/Pictures/PaintSettings.h"
#include "Representations/Mapper/Pictures/PictureStore.h"
#include "Representations/Mapper/Pictures/StillPictures.h"
#include "Representations/Mapper/Scene/TransferFunctionBuilder.h"
#include "Representations/Mapper/Scene/Viewport.h"
#include "Representations/Mapper/Window/ImageBlender.h"
#include "Representations/Mapper/Window/PictureGroup.h"
#include "Representations/Mapper/Window/Surroundings.h"
#include "Representations/Mapper/Window/TranslucentPeeler.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

class vtkINRDataArray;
class vtkRenderWindow;
class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;
class vtkWindow;

namespace inr {

/// Turns VTK's scene into a Frame, has it rendered and blends the picture into the window.
class FramePainter
{
public:
  /// `mayRefine`: see RefinementTimer.
  explicit FramePainter(std::function<bool()> mayRefine);
  /// Draws one frame and returns an empty text, or draws nothing and returns why. A frame aborted
  /// by the render window is not drawn and not an error. Throws what Renderer throws. Of a group,
  /// each process keeps its own part and what that took.
  std::string paint(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                    const PaintSettings& settings);
  /// Marks where the volume is seen, and which cells, in a selection buffer: in the picture that
  /// the view shows or, where that is not of the present scene, in another one, which nobody sees.
  /// A group's processes each mark their part. Not where one of `over` shows anything, pictures of
  /// other volumes in the same viewport. Returns and throws as above.
  std::string mark(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                   const PaintSettings& settings, const std::vector<const Image*>& over);
  /// The latest picture of a volume in that view; null where there is none.
  const Image* shown(vtkRenderer* renderer, vtkVolume* volume) const;
  const PaintedFrame& last() const { return this->Pictures.latest().last(); }
  /// Those that are not complete.
  StillPictures& stills() { return this->Stills; }
  /// See Renderer.
  std::int64_t cacheBytes() const { return this->Caster.cacheBytes(); }
  std::optional<AcceleratedField::Failure> acceleratorFailure() const
  {
    return this->Caster.acceleratorFailure();
  }
  void release(vtkWindow* window)
  {
    this->Stills.cancel();
    this->Blender.release(window);
    this->Peeler.release(window);
  }

private:
  /// A picture to make, and where it is shown.
  struct Job
  {
    const Frame& scene;
    vtkRenderer* renderer;
    ViewPicture& picture;
    /// What a still picture of the same would be of, to be shown instead where there is one; null:
    /// none.
    const DepictedScene* still = nullptr;
    /// Shown until there is a better one: it is not made again though it is not complete.
    bool standsIn = false;
  };

  /// What to draw, or why nothing is.
  std::string prepare(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                      const PaintSettings& settings, Frame& frame);
  void makeRenderer(const vtkINRDataArray& array, const RendererOptions& options);

  bool draw(const Job& job);
  ImageReduction& resolution(RenderMode mode)
  {
    return mode == RenderMode::PathTracing ? this->Paths : this->Rays;
  }
  Timer deadline(double rate, int reduction) const;
  Surroundings reduced(const Surroundings& around, const Viewport& viewport, int reduction) const;
  bool render(const Job& job, const Surroundings& around, int reduction,
              const std::function<bool()>& keepGoing);
  /// The same of all processes, each with its part.
  bool renderTogether(const Job& job, const Surroundings& around, int reduction,
                      const Timer& deadline);
  /// A picture with 1/reduction of the viewport's width and height, or less where that does not
  /// keep to the rate; what is around its pixels. Nothing where it was stopped.
  std::optional<Surroundings> drawInTime(const Job& job, const Surroundings& around,
                                         const Viewport& viewport, double rate, int reduction);
  /// With which there is time for a picture in place of one that shows nothing in some pixels yet.
  int coarserReduction(const Job& job);
  /// Such a picture; the rest is as above.
  std::optional<Surroundings> drawCoarser(const Job& job, const Surroundings& around,
                                          const Viewport& viewport, int reduction);
  bool blend(const Job& job, const Surroundings& around);
  /// The picture for a selection.
  const ViewPicture& look(const Frame& scene, vtkRenderer* renderer, vtkVolume* volume);
  /// A picture that is not shown; whether it was made.
  bool drawUnseen(const Job& job);
  DepictedScene depicted(const Frame& scene, vtkRenderer* renderer, vtkVolume* volume) const;

  CurrentRenderer Caster;
  bool CountSamples = false;
  PictureGroup Group;
  TransferFunctionCache TransferFunctions;
  ImageReduction Rays;
  /// Nobody knows what paths cost before some are traced: a thousand samples, or ten.
  ImageReduction Paths{true, ImageReduction::UnmeasuredPaths};
  ImageBlender Blender;
  TranslucentPeeler Peeler;
  PictureStore Pictures;
  StillPictures Stills; ///< of these
  /// For the latest selection, where no view shows what it is of.
  ViewPicture Selected{NobodysPicture};
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/Frame.h"
#include "FrameBuilder.h"
#include "ImageBlender.h"
#include "ImageReduction.h"
#include "PaintSettings.h"
#include "PictureGroup.h"
#include "PictureKey.h"
#include "RefinementTimer.h"
#include "Surroundings.h"
#include "TransferFunctionBuilder.h"
#include "TranslucentPeeler.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

class vtkINRDataArray;
class vtkRenderWindow;
class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;
class vtkWindow;

namespace inr {

/// The last picture made and what it took; without pixels when nothing was drawn.
struct PaintedFrame
{
  Image rgba;
  Image depth;
  Image samples; ///< empty unless asked for and known
  FrameStatistics statistics;
  std::string backend; ///< see vtkINRVolumeMapper::GetBackendInUse
  double seconds = 0;  ///< from the mapper's call to the blended picture
  int reduction = 0;   ///< viewport size / image size
  bool depthRead = false;
  bool converged = false; ///< shown, and complete
};

/// Turns VTK's scene into a Frame, has it rendered and blends the picture into the window. A
/// picture that is complete is not rendered again while everything stays as it is: windows are
/// drawn anew for many reasons.
class FramePainter
{
public:
  /// `mayRefine`: see RefinementTimer.
  explicit FramePainter(std::function<bool()> mayRefine) : Refine(std::move(mayRefine)) {}
  /// Draws one frame and returns an empty text, or draws nothing and returns why. A frame aborted
  /// by the render window is not drawn and not an error. Throws what Renderer throws. Of a group,
  /// each process keeps its own part and what that took.
  std::string paint(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                    const PaintSettings& settings);
  /// Marks what the last picture shows of the volume, and which cells, in a selection buffer. A
  /// group's processes each mark their part.
  void mark(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume);
  const PaintedFrame& last() const { return this->Last; }
  /// See Renderer.
  std::int64_t cacheBytes() const { return this->Caster ? this->Caster->cacheBytes() : 0; }
  std::optional<AcceleratedField::Failure> acceleratorFailure() const
  {
    return this->Caster ? this->Caster->acceleratorFailure() : std::nullopt;
  }
  void release(vtkWindow* window)
  {
    this->Refine.cancel();
    this->Blender.release(window);
    this->Peeler.release(window);
  }

private:
  /// What to draw, or why nothing is.
  std::string prepare(vtkVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume,
                      const PaintSettings& settings, Frame& frame);
  void makeRenderer(const vtkINRDataArray& array, RendererOptions options);
  void noteBackend();
  using Clock = std::chrono::steady_clock;

  bool draw(const Frame& frame, vtkRenderer* renderer);
  ImageReduction& resolution(RenderMode mode)
  {
    return mode == RenderMode::PathTracing ? this->Paths : this->Rays;
  }
  Clock::time_point deadline(double rate, int reduction) const;
  Surroundings reduced(const Surroundings& around, const Viewport& viewport, int reduction) const;
  bool render(const Frame& scene, const Surroundings& around, int reduction,
              const std::function<bool()>& keepGoing);
  /// The same of all processes, each with its part.
  bool renderTogether(const Frame& scene, const Surroundings& around, int reduction,
                      Clock::time_point deadline, vtkRenderWindow* window);
  bool blend(vtkRenderer* renderer, const Surroundings& around);
  /// Shows the picture of the call before if that is the one `frame` asks for.
  bool showAgain(const Frame& frame);
  double timeLimit(vtkRenderWindow* window, double stillTimeLimit) const;
  /// Sees to it that an unfinished still picture goes on.
  void refineLater(vtkRenderWindow* window, RenderMode mode);

  std::unique_ptr<Renderer> Caster;
  ModelPointer CasterModel;
  RendererOptions CasterOptions;
  std::shared_ptr<const Accelerator> GivenUp; ///< it has failed
  bool CountSamples = false;
  PictureGroup Group;
  TransferFunctionCache TransferFunctions;
  ImageReduction Rays;
  /// Nobody knows what paths cost before some are traced: a thousand samples, or ten.
  ImageReduction Paths{true, ImageReduction::UnmeasuredPaths};
  ImageBlender Blender;
  TranslucentPeeler Peeler;
  RefinementTimer Refine;
  PaintedFrame Last;
  PaintedFrame Before;           ///< of the call before, until there is another
  std::optional<PictureKey> Key; ///< of what was drawn last, if it is complete
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRStatusActor
 * @brief text in a view's upper left corner that says how far a volume's picture is
 *
 * Asks vtkINRVolumeMapper when the picture is drawn, so that the text is about the same frame. The
 * texts of several volumes in a renderer stand below each other, in the order in which they were
 * added. Where several processes draw, the text is about all of them, and in the picture of the one
 * that lies over the others'.
 */
#ifndef vtkINRStatusActor_h
#define vtkINRStatusActor_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkTextActor.h"
#include "vtkWeakPointer.h" // for Window

#include <string> // for return value

class vtkINRLODVolume;
class vtkINRVolumeMapper;
class vtkMultiProcessController;
class vtkRenderWindow;

namespace inr {
struct FrameStatus;
}

class VTKINRREPRESENTATIONS_EXPORT vtkINRStatusActor : public vtkTextActor
{
public:
  static vtkINRStatusActor* New();
  vtkTypeMacro(vtkINRStatusActor, vtkTextActor);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What it is about, and whose pictures; they must outlive this.
  void SetVolume(vtkINRLODVolume* volume, vtkINRVolumeMapper* mapper);

  /// Those that draw a part of `window` each, and then must draw this at the same time; null when
  /// one draws it all. Of several, the bounds are everywhere while the window is drawn, as ParaView
  /// composes what lies within them; else nowhere, or cameras would be set to see all of them.
  void SetProcesses(vtkMultiProcessController* processes, vtkRenderWindow* window);

  /// Two lines on the mapper's latest picture in this process, or one where the volume is out of
  /// sight; empty when it has drawn none.
  std::string GetText();

  /// Nothing: the picture comes later in the frame.
  int RenderOpaqueGeometry(vtkViewport*) override { return 0; }
  int RenderOverlay(vtkViewport* viewport) override;
  double* GetBounds() VTK_SIZEHINT(6) override;
  using vtkTextActor::GetBounds;

protected:
  vtkINRStatusActor();
  ~vtkINRStatusActor() override = default;

private:
  vtkINRStatusActor(const vtkINRStatusActor&) = delete;
  void operator=(const vtkINRStatusActor&) = delete;

  std::string TextOf(const inr::FrameStatus& status);
  std::string TextIn(vtkViewport* viewport);
  double TopIn(vtkViewport* viewport);
  /// Makes letters as large as the view is wide enough for.
  void FitInto(vtkViewport* viewport);

  vtkINRLODVolume* StatusVolume = nullptr;
  vtkINRVolumeMapper* StatusMapper = nullptr;
  vtkMultiProcessController* Processes = nullptr;
  vtkWeakPointer<vtkRenderWindow> Window;
  double Everywhere[6] = {-1e30, 1e30, -1e30, 1e30, -1e30, 1e30};
  double Height = 0; ///< pixels, of the latest text
};

#endif

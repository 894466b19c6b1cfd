// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRLODVolume
 * @brief volume prop of the representation "INR Volume"
 *
 * ParaView draws translucent geometry by depth peeling, and draws volumes once per peel into
 * buffers that blend by maximum, where a finished picture cannot go. While something is being
 * peeled, this prop therefore steps aside and draws its picture afterwards, in the overlay stage of
 * the same frame. The mapper sees to it that translucent surfaces come out in their places. It
 * learns here, too, which process of a parallel server has the picture that lies over the others'.
 */
#ifndef vtkINRLODVolume_h
#define vtkINRLODVolume_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkPVLODVolume.h"
#include "vtkTimeStamp.h" // for Shown

class VTKINRREPRESENTATIONS_EXPORT vtkINRLODVolume : public vtkPVLODVolume
{
public:
  static vtkINRLODVolume* New();
  vtkTypeMacro(vtkINRLODVolume, vtkPVLODVolume);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int RenderVolumetricGeometry(vtkViewport* viewport) override;
  int RenderOverlay(vtkViewport* viewport) override;

  ///@{
  /**
   * Says that a view is about to be drawn that shows this, and whether this process has what it
   * takes to draw it; and when that was said last, 0 before the first time.
   */
  void Show(bool here);
  vtkMTimeType GetShownMTime() const { return this->Shown.GetMTime(); }
  /// When it was said last of any of them.
  static vtkMTimeType GetLatestShownMTime();
  /// Whether the renderer has had this drawn since then; else it is out of sight.
  bool GetDrawn() const { return this->Drawn.GetMTime() > this->Shown.GetMTime(); }
  /// Whether that is so, in a view that was drawn.
  bool GetOutOfSight() const { return this->Shown.GetMTime() > 0 && !this->GetDrawn(); }
  bool GetDrawnHere() const { return this->DrawnHere; }
  ///@}

  /// Draws nothing from now on, whatever it has; or does again.
  void Withhold(bool on) { this->Withheld = on; }
  bool GetWithheld() const { return this->Withheld; }

protected:
  vtkINRLODVolume() = default;
  ~vtkINRLODVolume() override = default;

private:
  vtkINRLODVolume(const vtkINRLODVolume&) = delete;
  void operator=(const vtkINRLODVolume&) = delete;

  int Draw(vtkViewport* viewport);

  bool DrawInOverlay = false;
  bool DrawnHere = false;
  bool Withheld = false;
  vtkTimeStamp Shown;
  vtkTimeStamp Drawn;
};

#endif

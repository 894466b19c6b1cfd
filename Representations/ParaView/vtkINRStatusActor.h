// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRStatusActor
 * @brief text in a view's upper left corner that says how far a volume's picture is
 *
 * Asks vtkINRVolumeMapper when the picture is drawn, so that the text is about the same frame. The
 * texts of several volumes in a renderer stand below each other, in the order in which they were
 * added.
 */
#ifndef vtkINRStatusActor_h
#define vtkINRStatusActor_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkTextActor.h"

#include <string> // for return value

class vtkINRVolumeMapper;

class VTKINRREPRESENTATIONS_EXPORT vtkINRStatusActor : public vtkTextActor
{
public:
  static vtkINRStatusActor* New();
  vtkTypeMacro(vtkINRStatusActor, vtkTextActor);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whose picture it is about; it must outlive this.
  void SetVolumeMapper(vtkINRVolumeMapper* mapper) { this->StatusMapper = mapper; }

  /// Two lines on the mapper's latest picture; empty when it has drawn none.
  std::string GetText();

  /// Nothing: the picture comes later in the frame.
  int RenderOpaqueGeometry(vtkViewport*) override { return 0; }
  int RenderOverlay(vtkViewport* viewport) override;

protected:
  vtkINRStatusActor();
  ~vtkINRStatusActor() override = default;

private:
  vtkINRStatusActor(const vtkINRStatusActor&) = delete;
  void operator=(const vtkINRStatusActor&) = delete;

  double TopIn(vtkViewport* viewport);

  vtkINRVolumeMapper* StatusMapper = nullptr;
  double Height = 0; ///< pixels, of the latest text
};

#endif

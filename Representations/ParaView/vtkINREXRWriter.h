// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINREXRWriter
 * @brief ParaView's screenshots of an INR volume as OpenEXR
 *
 * ParaView hands an image writer the picture in 8 bits. This one takes of it the size, and writes
 * the floats that the volume's mapper has made of the same picture (vtkINRVolumeMapper::WriteEXR).
 * Where a server has drawn the view, this process draws it once more: the server sends it the model
 * and the surfaces in the view, whatever their size. Of a volume that is out of sight the picture
 * is empty. Writing fails with a message when there is not exactly one INR volume in the view that
 * was drawn last, the picture was put together from tiles, several views or both eyes, or something
 * in the view can only be drawn by the server, as a picture in stereo that was drawn there.
 */
#ifndef vtkINREXRWriter_h
#define vtkINREXRWriter_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkImageWriter.h"

#include <string> // for Fail

class vtkINRLODVolume;
class vtkINRVolumeMapper;
class vtkSMViewProxy;

class VTKINRREPRESENTATIONS_EXPORT vtkINREXRWriter : public vtkImageWriter
{
public:
  static vtkINREXRWriter* New();
  vtkTypeMacro(vtkINREXRWriter, vtkImageWriter);

  void Write() override;

  /// Has the writer know of the pictures of a view of this client: screenshots of others are
  /// refused.
  static void WatchView(vtkSMViewProxy* view);

protected:
  vtkINREXRWriter() = default;
  ~vtkINREXRWriter() override = default;

private:
  vtkINREXRWriter(const vtkINREXRWriter&) = delete;
  void operator=(const vtkINREXRWriter&) = delete;

  void WriteFrom(vtkINRLODVolume* volume, vtkImageData* screenshot);
  void WriteOutOfSight(vtkINRVolumeMapper& mapper, vtkImageData* screenshot);
  void Fail(const std::string& problem);
};

#endif

// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINREXRWriter
 * @brief ParaView's screenshots of an INR volume as OpenEXR
 *
 * ParaView hands an image writer the picture in 8 bits. This one takes of it the size, and writes
 * the floats that the volume's mapper has made of the same picture (vtkINRVolumeMapper::WriteEXR).
 * Writing fails with a message when there is not exactly one INR volume in the view that was drawn
 * last, or the picture was put together from tiles or several views.
 */
#ifndef vtkINREXRWriter_h
#define vtkINREXRWriter_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkImageWriter.h"

#include <string> // for Fail

class VTKINRREPRESENTATIONS_EXPORT vtkINREXRWriter : public vtkImageWriter
{
public:
  static vtkINREXRWriter* New();
  vtkTypeMacro(vtkINREXRWriter, vtkImageWriter);

  void Write() override;

protected:
  vtkINREXRWriter() = default;
  ~vtkINREXRWriter() override = default;

private:
  vtkINREXRWriter(const vtkINREXRWriter&) = delete;
  void operator=(const vtkINREXRWriter&) = delete;

  void Fail(const std::string& problem);
};

#endif

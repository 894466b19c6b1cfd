// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRVolumeMapper
 * @brief draws an implicit neural representation (INR) straight from its network
 *
 * The input is image data whose selected point scalars are a vtkINRDataArray, as vtkINRReader
 * gives them. The picture always shows the INR's native resolution, however coarse the grid is that
 * the reader presents, and no value of that grid is computed for it.
 *
 * Honoured: every camera (perspective, parallel, stereo, off-axis), tiles and viewports, the
 * volume's matrix, the image's origin, spacing and direction, opaque geometry (its depth buffer is
 * read only when a visible prop has opaque geometry), the mapper's clipping planes, and from
 * vtkVolumeProperty the colour and scalar opacity functions of component 0 and the
 * ScalarOpacityUnitDistance, a length in world space. Interpolation type has no meaning here: an
 * INR is continuous.
 *
 * Refused with an error and not drawn: blend modes other than composite, cropping, gradient
 * opacity, 2D transfer functions, masks, scalars that are not an INR. Shading draws a warning. A
 * message comes once, not at every frame.
 *
 * When the render window asks for more than 0.1 frames per second and the last frame says that full
 * resolution is too slow for it, the picture is computed at a half, a quarter or an eighth of the
 * window's resolution and stretched. Hardware selection does not see the volume.
 */
#ifndef vtkINRVolumeMapper_h
#define vtkINRVolumeMapper_h

#include "vtkINRMapperModule.h" // for export macro

#include <vtkVolumeMapper.h>

#include <memory> // for std::unique_ptr

class VTKINRMAPPER_EXPORT vtkINRVolumeMapper : public vtkVolumeMapper
{
public:
  static vtkINRVolumeMapper* New();
  vtkTypeMacro(vtkINRVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Distance between samples in voxels, along the axis in which the voxels are densest. Smaller is
   * slower and closer to the integral. Default 1.
   */
  vtkSetClampMacro(SampleDistance, double, 0.01, 100.0);
  vtkGetMacro(SampleDistance, double);
  ///@}

  ///@{
  /** Threads that compute a frame; 0, the default, means every core this process may use. */
  vtkSetClampMacro(NumberOfThreads, int, 0, 4096);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /** Seed of the samples' random offsets along their rays. Default 0. */
  vtkSetClampMacro(Seed, int, 0, VTK_INT_MAX);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * About the last frame drawn; 0 before the first: seconds from the call to the drawn picture,
   * samples inferred, samples that lay outside their macro-cell's range and were moved into it, and
   * how many times smaller than the viewport the picture's width and height were.
   */
  double GetFrameTime() const;
  vtkIdType GetNumberOfSamples() const;
  vtkIdType GetNumberOfClampedSamples() const;
  int GetImageReduction() const;
  ///@}

  /** What computed the last frame, such as "CPU avx512"; empty before the first. */
  const char* GetBackendInUse() const;

  /**
   * Whether the last frame read the depth of opaque geometry.
   */
  bool GetOpaqueDepthRead() const;

  /**
   * Writes the last frame as OpenEXR, exact: premultiplied float R, G, B, A and window-space depth
   * Z of the volume alone, where its opacity first reaches one half. False, with an error, when
   * there is no frame or the file cannot be written.
   */
  bool WriteEXR(const char* fileName);

  /** Bounds of what is drawn: those of the input, and one spacing along an axis of one voxel. */
  double* GetBounds() VTK_SIZEHINT(6) override;
  using vtkVolumeMapper::GetBounds;

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkINRVolumeMapper();
  ~vtkINRVolumeMapper() override;

private:
  vtkINRVolumeMapper(const vtkINRVolumeMapper&) = delete;
  void operator=(const vtkINRVolumeMapper&) = delete;

  void ReportOnce(const std::string& error, const std::string& warning);

  double SampleDistance = 1.0;
  int NumberOfThreads = 0;
  int Seed = 0;

  struct Internals;
  std::unique_ptr<Internals> Self;
};

#endif

// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRDecode
 * @brief computes the voxels of an implicit neural representation as ordinary image data
 *
 * The input is vtkINRReader's output. Level 0 is the native grid of N voxels per axis; level l + 1
 * has half as many as level l, rounded up, n in all. Voxel v of a level sits at
 * origin + spacing * ((v + 0.5) * N/n - 0.5) along an axis. It is the sample there or, where the
 * model tells more apart within a voxel, the mean of two per axis across it (inr::PointsPerAxis).
 *
 * AbortExecute, SIGINT and SIGTERM stop it; then the output is empty.
 */
#ifndef vtkINRDecode_h
#define vtkINRDecode_h

#include "vtkINRReadersModule.h" // for export macro

#include <vtkImageAlgorithm.h>

class StopSignals;
struct NativeGrid;

class VTKINRREADERS_EXPORT vtkINRDecode : public vtkImageAlgorithm
{
public:
  static vtkINRDecode* New();
  vtkTypeMacro(vtkINRDecode, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// First and last voxel per axis in the level's grid; an axis whose last is below its first
  /// (default) is taken whole. Cut to the grid; an error when it lies outside.
  vtkSetVector6Macro(VolumeOfInterest, int);
  vtkGetVector6Macro(VolumeOfInterest, int);
  ///@}

  ///@{
  /// Resolution level, 0 (default) to 30.
  vtkSetClampMacro(Level, int, 0, 30);
  vtkGetMacro(Level, int);
  ///@}

  ///@{
  /// VTK type of the voxels, e.g. VTK_FLOAT; -1 (default) = the source's. Integers round to
  /// nearest.
  vtkSetMacro(ScalarType, int);
  vtkGetMacro(ScalarType, int);
  ///@}

protected:
  vtkINRDecode() = default;
  ~vtkINRDecode() override = default;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkINRDecode(const vtkINRDecode&) = delete;
  void operator=(const vtkINRDecode&) = delete;

  bool DescribeOutput(vtkInformation* outInfo);
  void Decode(const NativeGrid& grid, vtkImageData* output, const StopSignals& signals);
  /// False when it was stopped.
  template <class T, class Stop>
  bool Fill(const NativeGrid& grid, const int extent[6], T* values, const Stop& stop);

  int VolumeOfInterest[6] = {0, -1, 0, -1, 0, -1};
  int Level = 0;
  int ScalarType = -1;
};

#endif

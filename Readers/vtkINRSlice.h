// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRSlice
 * @brief the native field of an implicit neural representation on a plane
 *
 * The input is vtkINRReader's output. What the plane and the volume's bounds have in common comes
 * out as polygons; the value at each point is what the network gives there, not rounded to the type
 * of the volume and not interpolated between voxels. Nothing else of the volume is computed.
 *
 * The points form a regular grid that has a point at least every native voxel, but at most
 * MaximumPoints; on a plane of voxels they are the voxels. At the rim cells are cut. An axis with a
 * single voxel counts as one spacing thick. A plane beside the volume gives an empty output.
 *
 * AbortExecute, SIGINT and SIGTERM stop it; then the output is empty.
 */
#ifndef vtkINRSlice_h
#define vtkINRSlice_h

#include "vtkINRReadersModule.h" // for export macro

#include <vtkPolyDataAlgorithm.h>
#include <vtkSmartPointer.h> // for member

class StopSignals;
class vtkPlane;
struct NativeGrid;

class VTKINRREADERS_EXPORT vtkINRSlice : public vtkPolyDataAlgorithm
{
public:
  static vtkINRSlice* New();
  vtkTypeMacro(vtkINRSlice, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The plane, with its transform if it has one. Default: z = 0.
  void SetCutFunction(vtkPlane* plane);
  vtkPlane* GetCutFunction();
  ///@}

  ///@{
  /// Points of the rectangle around the slice at most; where one per native voxel would be more,
  /// they are further apart. 0 = no limit. Default 2^20.
  vtkSetClampMacro(MaximumPoints, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(MaximumPoints, vtkIdType);
  ///@}

  /// The plane's changes count.
  vtkMTimeType GetMTime() override;

protected:
  vtkINRSlice();
  ~vtkINRSlice() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkINRSlice(const vtkINRSlice&) = delete;
  void operator=(const vtkINRSlice&) = delete;

  void Cut(const NativeGrid& grid, vtkInformation* outInfo, const StopSignals& signals);

  vtkSmartPointer<vtkPlane> CutFunction;
  vtkIdType MaximumPoints = vtkIdType{1} << 20;
};

#endif

// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRContour
 * @brief isosurfaces of the native field of an implicit neural representation
 *
 * The input is vtkINRReader's output. The surfaces are those that a contour filter would find in
 * the voxels of a level (see vtkINRDecode), in double precision and not rounded to the volume's
 * type. Only those bricks of voxels are decoded that the file's macro-cells say a surface may run
 * through, and where a surface leaves them the bricks that it goes on in: it has no holes but where
 * it meets the volume's faces. A piece that lies wholly where the ranges of the file know nothing
 * of it stays unseen; ranges taken from all decoded voxels, as vtkINRWriter stores them of up to
 * 2^28, miss none of level 0.
 *
 * The points have the isovalue as scalars and, unless told otherwise, normals towards smaller
 * values. In parallel each process makes its share of the bricks.
 *
 * AbortExecute, SIGINT and SIGTERM stop it; then the output is empty.
 */
#ifndef vtkINRContour_h
#define vtkINRContour_h

#include "vtkINRReadersModule.h" // for export macro

#include <vtkPolyDataAlgorithm.h>

#include <vector> // for member

class BrickQueue;
class ContourBricks;
class CrossedCells;
class StopSignals;
class SurfaceBuilder;
struct NativeGrid;
namespace inr {
struct Model;
}

class VTKINRREADERS_EXPORT vtkINRContour : public vtkPolyDataAlgorithm
{
public:
  static vtkINRContour* New();
  vtkTypeMacro(vtkINRContour, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Isovalue number `k`, in data units. None by default. Setting one beyond the last adds all up
  /// to it; a negative `k` sets the first, and is 0 when asked for.
  void SetValue(int k, double value);
  double GetValue(int k);
  void SetNumberOfContours(int count);
  int GetNumberOfContours();
  ///@}

  ///@{
  /// Resolution level, 0 (the reader's grid) to 30; beyond the last level that has two voxels per
  /// axis, or is one brick of eight or more, that one. -1 (default) = the finest one that takes at
  /// most MaximumSamples, or the coarsest.
  vtkSetClampMacro(Level, int, -1, 30);
  vtkGetMacro(Level, int);
  ///@}

  ///@{
  /// Evaluations of the network that an automatic Level may take: one per voxel on level 0, and one
  /// or eight per voxel on the others. Default 2^27, on two cores some seconds with a small model
  /// and some 20 with one of instantvnr's size.
  vtkSetClampMacro(MaximumSamples, vtkIdType, 1, VTK_ID_MAX);
  vtkGetMacro(MaximumSamples, vtkIdType);
  ///@}

  ///@{
  /// MiB that the surfaces may take while they are made; beyond that there is an error and an empty
  /// output. Default 2048, some 40 million triangles.
  vtkSetClampMacro(MemoryLimit, int, 1, VTK_INT_MAX);
  vtkGetMacro(MemoryLimit, int);
  ///@}

  ///@{
  /// Whether the points get normals, from central differences of the voxels. Default on.
  vtkSetMacro(ComputeNormals, bool);
  vtkGetMacro(ComputeNormals, bool);
  vtkBooleanMacro(ComputeNormals, bool);
  ///@}

  ///@{
  /// What the last update did: its level (-1: nothing to do), the bricks that it decoded and those
  /// that there are; the macro-cells that it saw no surface in and all of them.
  vtkGetMacro(LevelInUse, int);
  vtkGetMacro(DecodedBricks, vtkIdType);
  vtkGetMacro(NumberOfBricks, vtkIdType);
  vtkGetMacro(SkippedCells, vtkIdType);
  vtkGetMacro(NumberOfCells, vtkIdType);
  ///@}

protected:
  vtkINRContour() = default;
  ~vtkINRContour() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkINRContour(const vtkINRContour&) = delete;
  void operator=(const vtkINRContour&) = delete;

  struct Selection;

  void Contour(const NativeGrid& grid, vtkInformation* outInfo, const StopSignals& signals);
  Selection Select(const inr::Model& model, const CrossedCells& crossed) const;
  /// False when it was stopped.
  bool Build(const NativeGrid& grid, const ContourBricks& bricks, BrickQueue& queue,
             SurfaceBuilder& surface, const StopSignals& signals);
  void RequireMemoryFor(const SurfaceBuilder& surface) const;

  std::vector<double> Values;
  int Level = -1;
  vtkIdType MaximumSamples = vtkIdType{1} << 27;
  int MemoryLimit = 2048;
  bool ComputeNormals = true;

  int LevelInUse = -1;
  vtkIdType DecodedBricks = 0;
  vtkIdType NumberOfBricks = 0;
  vtkIdType SkippedCells = 0;
  vtkIdType NumberOfCells = 0;
};

#endif

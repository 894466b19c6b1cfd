// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkTurbulentChannelSource
 * @brief image data of a turbulence-like channel flow, of any size and known at every point
 *
 * inr::TurbulentChannel as point data of image data, with a scalar array "velocity". Only the
 * extent that is asked for is computed, on threads of its own, so that a volume which fits no
 * memory can be read piece by piece; pieces and the whole have the same bits. The points lie at the
 * voxels' centres of a channel that is 8 pi x 3 pi x 2 half-heights large.
 */
#ifndef vtkTurbulentChannelSource_h
#define vtkTurbulentChannelSource_h

#include "vtkINRTurbulenceModule.h" // for export macro

#include <vtkImageAlgorithm.h>

#include <memory> // for Grid

namespace inr {
class ChannelGrid;
}

class VTKINRTURBULENCE_EXPORT vtkTurbulentChannelSource : public vtkImageAlgorithm
{
public:
  static vtkTurbulentChannelSource* New();
  vtkTypeMacro(vtkTurbulentChannelSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Voxels per axis, 1 to 2^20. Default 256 x 192 x 64.
  vtkSetVector3Macro(Dimensions, int);
  vtkGetVector3Macro(Dimensions, int);
  ///@}

  ///@{
  /// Which field; default 1.
  vtkSetClampMacro(Seed, int, 0, VTK_INT_MAX);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /// Octaves of structures, 1 to 8; default 6.
  vtkSetClampMacro(Octaves, int, 1, 8);
  vtkGetMacro(Octaves, int);
  ///@}

  ///@{
  /// Root mean square of the fluctuations in mean velocities of the middle, 0 to 1; default 0.06.
  vtkSetClampMacro(Intensity, double, 0, 1);
  vtkGetMacro(Intensity, double);
  ///@}

  ///@{
  /// VTK_FLOAT (default) or VTK_DOUBLE.
  vtkSetClampMacro(OutputScalarType, int, VTK_FLOAT, VTK_DOUBLE);
  vtkGetMacro(OutputScalarType, int);
  ///@}

  ///@{
  /// Time steps, TimeStepSize half-heights over velocity apart, from 0 on; default 1 (no time),
  /// 0.05.
  vtkSetClampMacro(NumberOfTimeSteps, int, 1, 1000000);
  vtkGetMacro(NumberOfTimeSteps, int);
  vtkSetMacro(TimeStepSize, double);
  vtkGetMacro(TimeStepSize, double);
  ///@}

  ///@{
  /// 0 (default) = as many as there are cores.
  vtkSetClampMacro(NumberOfThreads, int, 0, 4096);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /// What was asked for so far: number of requests, the largest of them in bytes, and the bytes of
  /// all.
  vtkGetMacro(NumberOfRequests, vtkIdType);
  vtkGetMacro(LargestRequest, vtkIdType);
  vtkGetMacro(BytesRequested, vtkIdType);
  ///@}

protected:
  vtkTurbulentChannelSource();
  ~vtkTurbulentChannelSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkTurbulentChannelSource(const vtkTurbulentChannelSource&) = delete;
  void operator=(const vtkTurbulentChannelSource&) = delete;

  double TimeAsked(vtkInformation* output) const;
  void PrepareGrid(double time);
  void Compute(vtkInformation* output);
  void Count(vtkIdType bytes);

  int Dimensions[3] = {256, 192, 64};
  int Seed = 1;
  int Octaves = 6;
  double Intensity = 0.06;
  int OutputScalarType = VTK_FLOAT;
  int NumberOfTimeSteps = 1;
  double TimeStepSize = 0.05;
  int NumberOfThreads = 0;
  vtkIdType NumberOfRequests = 0;
  vtkIdType LargestRequest = 0;
  vtkIdType BytesRequested = 0;

  std::unique_ptr<const inr::ChannelGrid> Grid; ///< of the last request
  vtkMTimeType GridMade = 0;
  double GridTime = 0;
};

#endif

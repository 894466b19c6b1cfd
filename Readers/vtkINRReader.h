// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRReader
 * @brief opens an implicit neural representation as virtual image data
 *
 * Reads .inr files and the *_params.json files of instantvnr and cINR. The output has the point
 * bounds of the original volume and one point array, a vtkINRDataArray, whose values are computed
 * when somebody asks for them. The native grid may be far too large for stock filters, so the grid
 * presented to them has at most MaximumGridPoints points; vtkINRVolumeMapper always shows the
 * native resolution, and vtkINRDecode computes native voxels.
 *
 * The output's field data tells about the volume behind the grid: INRNativeDimensions,
 * INRNativeSpacing, INRScaledDimensions, INRScaledSpacing, INRRatio and, where the file has them,
 * INRPSNR (dB), INRSSIM, INRMaximumError; and INRSummary says the most of it in words.
 *
 * In a series of files (vtkINRSeriesReader, in ParaView), all steps present as many points as the
 * first one that was asked for, between bounds of their own, since filters do not expect more or
 * fewer at another time.
 *
 * Models of files that were shown before stay in memory, in a sixteenth of the machine's, 4 GiB
 * at most, so that going back to a time step of a series of files loads nothing unless its file has
 * changed.
 *
 * A file that cannot be read gives one error and an empty output; mend the file, call Modified(),
 * and the reader goes on.
 */
#ifndef vtkINRReader_h
#define vtkINRReader_h

#include "vtkINRReadersModule.h" // for export macro

#include <vtkImageAlgorithm.h>

#include <limits> // for what is not known
#include <memory> // for Internals
#include <string> // for Summary

namespace inr {
struct VolumeInfo;
}

class VTKINRREADERS_EXPORT vtkINRReader : public vtkImageAlgorithm
{
public:
  static vtkINRReader* New();
  vtkTypeMacro(vtkINRReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The model file.
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /// 1 if the file's content is a model file, whatever its name; INRIA's images, which are called
  /// .inr too, are not.
  virtual int CanReadFile(VTK_FILEPATH const char* fileName);

  /// The time that a file says its volume belongs to, NaN where it says none. False, without a
  /// message, where it cannot be read.
  bool FindTime(VTK_FILEPATH const char* fileName, double& time);

  ///@{
  /// Name of the point array; empty (default) = the name in the file.
  vtkSetStringMacro(ArrayName);
  vtkGetStringMacro(ArrayName);
  ///@}

  ///@{
  /// The output is the finest grid of at most this many points, but at least two on every axis that
  /// has two, that has exactly the native point bounds. Default 2^24; 0 = the native grid. More
  /// than 2^28 points are never presented, since stock filters would crash on them: then that many
  /// are, with a warning. A negative number is an error.
  vtkSetMacro(MaximumGridPoints, vtkIdType);
  vtkGetMacro(MaximumGridPoints, vtkIdType);
  ///@}

  ///@{
  /// Voxels per axis over those in the file, 0.25 to 4 (default 1); an axis of a single voxel keeps
  /// it. The network is asked for the values of these voxels: they are what vtkINRVolumeMapper and
  /// vtkINRDecode take for native from here on. What they show stays where it is: of n voxels in
  /// place of N the spacing is N/n times the native one, and the first point (1 - N/n)/2 native
  /// spacings before the native one.
  vtkSetMacro(ScaleFactor, double);
  vtkGetMacro(ScaleFactor, double);
  ///@}

  ///@{
  /// Value range for files that lack it (0 and 1 of the network's output stand for these). 0, 0
  /// (default) = as in the file.
  vtkSetVector2Macro(DataRange, double);
  vtkGetVector2Macro(DataRange, double);
  ///@}

  ///@{
  /// Voxels per axis for files that lack or misstate them; 0, 0, 0 (default) = as in the file.
  vtkSetVector3Macro(Dimensions, int);
  vtkGetVector3Macro(Dimensions, int);
  ///@}

  ///@{
  /// What the file says, valid after UpdateInformation, 0 where nothing of it can be shown: voxels
  /// per axis and their distance in the original volume.
  vtkGetVector3Macro(NativeDimensions, vtkIdType);
  vtkGetVector3Macro(NativeSpacing, double);
  ///@}

  ///@{
  /// The same after ScaleFactor.
  vtkGetVector3Macro(ScaledDimensions, vtkIdType);
  vtkGetVector3Macro(ScaledSpacing, double);
  ///@}

  ///@{
  /// Quality measured when the file was written, against the original data: PSNR in dB (infinite
  /// for an exact file), SSIM, largest error in data units; of the field's values, as they are
  /// drawn. Arrays of integers have these rounded to whole numbers: another half of error at most,
  /// and often less in all. NaN where the file does not say.
  vtkGetMacro(PSNR, double);
  vtkGetMacro(SSIM, double);
  vtkGetMacro(MaximumError, double);
  ///@}

  /// Bytes of the original volume over bytes of the file; 0 as above.
  vtkGetMacro(Ratio, double);

protected:
  vtkINRReader();
  ~vtkINRReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkINRReader(const vtkINRReader&) = delete;
  void operator=(const vtkINRReader&) = delete;

  class Internals;

  void ReadInformation(vtkInformation* outInfo);
  void TellPipeline(vtkInformation* outInfo);
  void Fail(const char* reason);
  void ReadData(vtkInformation* outInfo);
  void Describe(const inr::VolumeInfo& scaled);
  void DescribeNothing();
  void WarnIfLimited();
  void AddFieldData(vtkDataObject* output);
  std::string Summary() const;

  char* FileName = nullptr;
  char* ArrayName = nullptr;
  vtkIdType MaximumGridPoints = vtkIdType{1} << 24;
  double ScaleFactor = 1;
  double DataRange[2] = {0, 0};
  int Dimensions[3] = {0, 0, 0};

  vtkIdType NativeDimensions[3] = {0, 0, 0};
  double NativeSpacing[3] = {0, 0, 0};
  vtkIdType ScaledDimensions[3] = {0, 0, 0};
  double ScaledSpacing[3] = {0, 0, 0};
  double PSNR = std::numeric_limits<double>::quiet_NaN();
  double SSIM = std::numeric_limits<double>::quiet_NaN();
  double MaximumError = std::numeric_limits<double>::quiet_NaN();
  double Ratio = 0;

  std::unique_ptr<Internals> Internal;
};

#endif

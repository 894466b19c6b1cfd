// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRSeriesReader
 * @brief opens model files as the time steps of one volume
 *
 * The times are those that the files tell; files that tell none, or cannot be read, get times
 * between and beyond those of the others. Where no file tells a time, or two tell the same one, the
 * steps are counted from 0. A .series file's times come before all of these. Steps may differ in
 * grid, range and model. A file that cannot be read leaves its step empty, with one message when
 * that is shown.
 */
#ifndef vtkINRSeriesReader_h
#define vtkINRSeriesReader_h

#include "vtkFileSeriesReader.h"
#include "vtkINRRepresentationsModule.h" // for export macro

#include <vector> // for Times

class VTKINRREPRESENTATIONS_EXPORT vtkINRSeriesReader : public vtkFileSeriesReader
{
public:
  static vtkINRSeriesReader* New();
  vtkTypeMacro(vtkINRSeriesReader, vtkFileSeriesReader);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkINRSeriesReader();
  ~vtkINRSeriesReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestInformationForInput(int index, vtkInformation* request,
                                 vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkINRSeriesReader(const vtkINRSeriesReader&) = delete;
  void operator=(const vtkINRSeriesReader&) = delete;

  void LookIntoFiles();
  int FindStepToTellOf(vtkInformation* outInfo);

  // Of each file; empty where there is one only.
  std::vector<double> Times; ///< empty where they tell none, too
  std::vector<bool> Readable;
  bool IsListing = false; ///< what there is, without looking into it
};

#endif

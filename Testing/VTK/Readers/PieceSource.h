// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkSetGet.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// The field 100 + 40 sin(0.02 x) cos(0.03 y) + 0.2 z, computed where it is asked for; keeps
/// account of that.
class PieceSource : public vtkImageAlgorithm
{
public:
  static PieceSource* New() { VTK_STANDARD_NEW_BODY(PieceSource); }
  vtkTypeMacro(PieceSource, vtkImageAlgorithm);

  int Extent[6] = {10, 329, -5, 154, 0, 159};
  int Type = VTK_DOUBLE;
  bool GivesParts = true;
  bool IsMadeOfRequest = false; ///< all of it, of as much of something else as it is asked for
  int FailingRequest = 0;       ///< by number from 1; 0 = none
  bool FailsFromThere = false;  ///< also afterwards
  bool SaysSoOnce = false;      ///< afterwards, it fails without a word
  bool OnlyComplains = false;   ///< and succeeds, in place of failing
  int HiddenFrom = 1 << 30;     ///< points of this z and beyond are hidden, and -1000
  int RenamedFrom = 1 << 30;    ///< requests by number; then the array has another name
  int MoreArrays = 0;           ///< besides the one
  bool TellsOfArrays = false;   ///< of these, too, before it is asked for them
  double Time = 0;              ///< of the last request

  int Requests = 0;
  vtkIdType LargestRequest = 0; ///< points

protected:
  PieceSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**,
                         vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), this->Extent, 6);
    info->Set(vtkDataObject::SPACING(), 0.5, 1.5, 2.5);
    info->Set(vtkDataObject::ORIGIN(), 1.0, 2.0, 3.0);
    info->Set(CAN_PRODUCE_SUB_EXTENT(), 1);
    vtkDataObject::SetPointDataActiveScalarInfo(info, this->Type, 1);
    for (int k = 0; this->TellsOfArrays && k < this->MoreArrays; ++k) {
      vtkNew<vtkInformation> array;
      array->Set(vtkDataObject::FIELD_ARRAY_TYPE(), VTK_DOUBLE);
      array->Set(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS(), 1);
      info->Get(vtkDataObject::POINT_DATA_VECTOR())->Append(array);
    }
    const double times[] = {0.5, 1.5};
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times, 2);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), times, 2);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    ++this->Requests;
    if (this->Requests == this->FailingRequest ||
        (this->FailsFromThere && this->Requests > this->FailingRequest)) {
      if (!this->SaysSoOnce || this->Requests == this->FailingRequest) {
        vtkErrorMacro("the tape is torn");
      }
      this->SetErrorCode(vtkErrorCode::UnknownError); // and keeps it, as some readers do
      if (!this->OnlyComplains) {
        return 0;
      }
    }
    this->Time = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    int extent[6];
    std::copy_n(this->Extent, 6, extent);
    if (this->GivesParts) {
      info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    }
    auto* image = vtkImageData::GetData(outputs);
    image->SetExtent(extent);
    image->AllocateScalars(this->Type, 1);
    vtkDataArray* values = image->GetPointData()->GetScalars();
    values->SetName(this->Requests < this->RenamedFrom ? "field" : "another");
    this->LargestRequest = std::max(this->LargestRequest, values->GetNumberOfTuples());
    for (int k = 0; k < this->MoreArrays; ++k) {
      vtkNew<vtkDoubleArray> other;
      other->SetName(("other" + std::to_string(k)).c_str());
      other->SetNumberOfTuples(values->GetNumberOfTuples());
      image->GetPointData()->AddArray(other);
    }
    int asked[6];
    info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), asked);
    if (this->IsMadeOfRequest && !std::equal(asked, asked + 6, this->Extent)) {
      values->Fill(0.0);
    } else {
      switch (this->Type) {
        vtkTemplateMacro(fill(static_cast<VTK_TT*>(values->GetVoidPointer(0)), extent));
      }
    }
    this->hide(image, extent);
    return 1;
  }

private:
  /// The field at every point of `extent`, of which each test asks for many millions.
  template <typename T> static void fill(T* values, const int extent[6])
  {
    std::vector<double> waves;
    for (int x = extent[0]; x <= extent[1]; ++x) {
      waves.push_back(40.0 * std::sin(0.02 * x));
    }
    for (int z = extent[4]; z <= extent[5]; ++z) {
      for (int y = extent[2]; y <= extent[3]; ++y) {
        const double wave = std::cos(0.03 * y);
        for (double alongX : waves) {
          *values++ = static_cast<T>(100.0 + alongX * wave + 0.2 * z);
        }
      }
    }
  }

  void hide(vtkImageData* image, const int extent[6]) const
  {
    const int first = std::max(extent[4], this->HiddenFrom);
    if (first > extent[5]) {
      return;
    }
    image->AllocatePointGhostArray();
    int corner[3] = {extent[0], extent[2], first};
    for (vtkIdType k = image->ComputePointId(corner); k < image->GetNumberOfPoints(); ++k) {
      image->GetPointGhostArray()->SetValue(k, vtkDataSetAttributes::HIDDENPOINT);
      image->GetPointData()->GetArray("field")->SetTuple1(k, -1000);
    }
  }
};

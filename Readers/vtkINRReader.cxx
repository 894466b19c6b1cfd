// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRReader.h"

#include "Core/Cache/CacheOptions.h"
#include "Core/Error.h"
#include "Core/NumberText.h"
#include "Readers/Common/Extents.h"
#include "Readers/Grid/NativeGrid.h"
#include "Readers/Grid/PresentedGrid.h"
#include "Readers/Grid/RecentModels.h"
#include "Readers/Grid/Scalars.h"
#include "vtkINRDataArray.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <string>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRReader);

class vtkINRReader::Internals
{
public:
  RecentModels Models{inr::DefaultCacheBytes() / 4};
  ModelSource* Source = nullptr; ///< of the models, after ReadInformation
  PresentedGrid Grid;
  bool Failed = false; ///< the file is of no use, and the user has been told
  std::string Told;    ///< the latest message, and the reader's MTime then
  vtkMTimeType ToldAt = 0;
};

namespace {

void WholeExtent(const glm::ivec3& dims, int extent[6])
{
  for (int axis = 0; axis < 3; ++axis) {
    extent[2 * axis] = 0;
    extent[2 * axis + 1] = dims[axis] - 1;
  }
}

/// The part of the requested extent that this process is to produce, with so many layers of ghost
/// cells around it.
std::array<int, 6> RequestedPiece(vtkInformation* outInfo, int ghostLevels)
{
  int requested[6];
  outInfo->Get(Pipeline::UPDATE_EXTENT(), requested);
  return PieceExtent(requested, outInfo->Get(Pipeline::UPDATE_PIECE_NUMBER()),
                     outInfo->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), ghostLevels);
}

// Whether an upstream file may have been made of more voxels than it tells: training out of core
// stores at most 1,024 along an axis.
bool MayHideVoxels(const inr::Model& header)
{
  const glm::i64vec3& dims = header.volume.dims;
  const bool upstream = !header.training && !header.quality &&
                        header.macroCells.provenance == inr::MacroCellProvenance::File;
  return upstream && (dims.x == 1024 || dims.y == 1024 || dims.z == 1024);
}

/// What the user knows better than the file.
inr::ModelOverrides OverridesOf(const int dims[3], const double range[2])
{
  inr::ModelOverrides overrides;
  if (dims[0] != 0 || dims[1] != 0 || dims[2] != 0) {
    overrides.dims = glm::i64vec3(dims[0], dims[1], dims[2]);
  }
  if (range[0] != 0 || range[1] != 0) {
    overrides.dataRange = glm::dvec2(range[0], range[1]);
  }
  return overrides;
}

/// Row by row, as VTK keeps it; glm's matrices are columns.
void CopyDirection(const glm::dmat3& direction, double elements[9])
{
  const glm::dmat3 rows = glm::transpose(direction);
  std::copy_n(glm::value_ptr(rows), 9, elements);
}

template <class Array, class Value>
void AddTuple(vtkFieldData* fields, const char* name, const Value* values, int components)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(1);
  for (int k = 0; k < components; ++k) {
    array->SetValue(k, values[k]);
  }
  fields->AddArray(array);
}

void AddKnown(vtkFieldData* fields, const char* name, double value)
{
  if (!std::isnan(value)) {
    AddTuple<vtkDoubleArray>(fields, name, &value, 1);
  }
}

/// With so many digits as tell files apart.
std::string Rounded(double value) { return inr::NumberText(value, 4); }

void AddText(vtkFieldData* fields, const char* name, const std::string& text)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  fields->AddArray(array);
}

} // namespace

vtkINRReader::vtkINRReader() : Internal(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(0);
}

vtkINRReader::~vtkINRReader()
{
  delete[] this->FileName;
  delete[] this->ArrayName;
}

int vtkINRReader::CanReadFile(const char* fileName)
{
  try {
    return fileName && inr::IsModelFile(fileName) ? 1 : 0;
  } catch (const std::exception&) { // not even for its name
    return 0;
  }
}

int vtkINRReader::RequestInformation(vtkInformation*, vtkInformationVector**,
                                     vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  outInfo->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  this->Internal->Failed = false;
  try {
    this->ReadInformation(outInfo);
  } catch (const std::exception& error) { // inr::Error, or no memory
    outInfo->Set(Pipeline::WHOLE_EXTENT(), NoVoxels, 6);
    this->DescribeNothing();
    this->Fail(error.what());
  }
  return 1; // a failed request would add the pipeline's own error to ours
}

void vtkINRReader::ReadInformation(vtkInformation* outInfo)
{
  if (!this->FileName || !*this->FileName) {
    throw inr::Error(inr::ErrorCode::InvalidArgument, "no FileName is set");
  }
  ModelSource& source =
      this->Internal->Models.Select(this->FileName, OverridesOf(this->Dimensions, this->DataRange));
  this->Internal->Source = &source;
  source.Scale(this->ScaleFactor);
  const inr::VolumeInfo volume = source.Volume();
  this->Internal->Grid = PresentGrid(volume, this->MaximumGridPoints);
  this->Describe(volume);
  this->WarnIfLimited();

  this->TellPipeline(outInfo);
}

void vtkINRReader::TellPipeline(vtkInformation* outInfo)
{
  const inr::VolumeInfo volume = this->Internal->Source->Volume();
  int extent[6];
  WholeExtent(this->Internal->Grid.dims, extent);
  double direction[9];
  CopyDirection(volume.direction, direction);
  outInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::SPACING(), &this->Internal->Grid.spacing.x, 3);
  outInfo->Set(vtkDataObject::ORIGIN(), &volume.origin.x, 3);
  outInfo->Set(vtkDataObject::DIRECTION(), direction, 9);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo, VtkTypeOf(volume.type), 1);
}

int vtkINRReader::RequestUpdateExtent(vtkInformation*, vtkInformationVector**,
                                      vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  int extent[6];
  outInfo->Get(Pipeline::WHOLE_EXTENT(), extent);
  if (this->Internal->Failed || IsEmpty(extent)) {
    return 1;
  }
  try { // in a series the pipeline, and what follows in it, knows the grid of another step
    const glm::ivec3 known(extent[1] + 1, extent[3] + 1, extent[5] + 1);
    if (known != this->Internal->Grid.dims) {
      this->Internal->Grid = PresentGridOf(this->Internal->Source->Volume(), known);
    }
    this->TellPipeline(outInfo);
  } catch (const std::exception& error) {
    this->Fail(error.what());
  }
  return 1;
}

bool vtkINRReader::FindTime(const char* fileName, double& time)
{
  time = std::numeric_limits<double>::quiet_NaN();
  try {
    ModelSource& source =
        this->Internal->Models.Find(fileName, OverridesOf(this->Dimensions, this->DataRange));
    time = source.Header().volume.time.value_or(time);
    return true;
  } catch (const std::exception&) { // to be told when the file is to be shown
    return false;
  }
}

void vtkINRReader::WarnIfLimited()
{
  const PresentedGrid& grid = this->Internal->Grid;
  if (grid.limited) {
    vtkWarningMacro("'" << this->FileName << "' has a native grid of " << this->ScaledDimensions[0]
                        << " x " << this->ScaledDimensions[1] << " x " << this->ScaledDimensions[2]
                        << " points; filters are shown " << grid.dims.x << " x " << grid.dims.y
                        << " x " << grid.dims.z << ", since many cannot cope with more than "
                        << LargestPresentedGrid
                        << ". INRDecode computes native voxels of a part, and the INR Volume "
                           "representation shows them all.");
  }
}

void vtkINRReader::DescribeNothing()
{
  for (int axis = 0; axis < 3; ++axis) {
    this->NativeDimensions[axis] = this->ScaledDimensions[axis] = 0;
    this->NativeSpacing[axis] = this->ScaledSpacing[axis] = 0;
  }
  this->PSNR = this->SSIM = this->MaximumError = std::numeric_limits<double>::quiet_NaN();
  this->Ratio = 0;
}

void vtkINRReader::Describe(const inr::VolumeInfo& scaled)
{
  const inr::Model& header = this->Internal->Source->Header();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  for (int axis = 0; axis < 3; ++axis) {
    this->NativeDimensions[axis] = header.volume.dims[axis];
    this->NativeSpacing[axis] = header.volume.spacing[axis];
    this->ScaledDimensions[axis] = scaled.dims[axis];
    this->ScaledSpacing[axis] = scaled.spacing[axis];
  }
  this->PSNR = header.quality ? header.quality->psnr : unknown;
  this->SSIM = header.quality ? header.quality->ssim : unknown;
  this->MaximumError = header.quality ? header.quality->maxError : unknown;

  const glm::dvec3 dims(header.nativeDims.value_or(header.volume.dims)); // what was compressed
  this->Ratio = dims.x * dims.y * dims.z *
                static_cast<double>(inr::ScalarSize(header.volume.type)) /
                static_cast<double>(this->Internal->Source->FileSize());
}

int vtkINRReader::RequestData(vtkInformation*, vtkInformationVector**,
                              vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  if (this->Internal->Failed) {
    vtkImageData::GetData(outInfo)->Initialize();
    return 1;
  }
  try {
    this->ReadData(outInfo);
  } catch (const std::exception& error) {
    vtkImageData::GetData(outInfo)->Initialize();
    this->DescribeNothing();
    this->Fail(error.what());
  }
  return 1;
}

void vtkINRReader::Fail(const char* reason)
{
  Internals& self = *this->Internal;
  self.Failed = true;
  // A series' reader asks again where nothing has changed.
  if (self.Told != reason || self.ToldAt != this->GetMTime()) {
    vtkErrorMacro("Cannot open an implicit neural representation: " << reason);
  }
  self.Told = reason;
  self.ToldAt = this->GetMTime();
}

void vtkINRReader::ReadData(vtkInformation* outInfo)
{
  vtkImageData* output = vtkImageData::GetData(outInfo);
  output->Initialize();
  std::array<int, 6> extent =
      RequestedPiece(outInfo, outInfo->Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()));
  if (IsEmpty(extent.data())) { // more processes than cells
    return;
  }
  int whole[6];
  WholeExtent(this->Internal->Grid.dims, whole);
  if (!Contains(whole, extent.data())) { // no fault of the file's
    vtkErrorMacro("The extent that was asked for is not within the grid, which has "
                  << this->Internal->Grid.dims.x << " x " << this->Internal->Grid.dims.y << " x "
                  << this->Internal->Grid.dims.z << " points; ask for a part of these.");
    return;
  }

  ModelSource& source = *this->Internal->Source;
  const inr::ModelPointer& model = source.Model();
  auto array = vtkINRDataArray::Create(model, &this->Internal->Grid.dims.x, extent.data(),
                                       source.Keepsake());
  if (this->ArrayName && *this->ArrayName) {
    array->SetName(this->ArrayName);
  }
  double direction[9];
  CopyDirection(model->volume.direction, direction);
  output->SetExtent(extent.data());
  output->SetOrigin(&model->volume.origin.x);
  output->SetSpacing(&this->Internal->Grid.spacing.x);
  output->SetDirectionMatrix(direction);
  output->GetPointData()->SetScalars(array);
  // Whoever counts or adds up afterwards, of pieces that somebody else wanted with ghost cells, has
  // to know these. The pipeline marks them for those only who leave it to cut the pieces.
  std::array<int, 6> own = RequestedPiece(outInfo, 0);
  output->GenerateGhostArray(own.data()); // none where there are no such cells
  this->AddFieldData(output);
}

void vtkINRReader::AddFieldData(vtkDataObject* output)
{
  vtkFieldData* fields = output->GetFieldData();
  AddTuple<vtkTypeInt64Array>(fields, "INRNativeDimensions", this->NativeDimensions, 3);
  AddTuple<vtkDoubleArray>(fields, "INRNativeSpacing", this->NativeSpacing, 3);
  AddTuple<vtkTypeInt64Array>(fields, "INRScaledDimensions", this->ScaledDimensions, 3);
  AddTuple<vtkDoubleArray>(fields, "INRScaledSpacing", this->ScaledSpacing, 3);
  AddKnown(fields, "INRRatio", this->Ratio);
  AddKnown(fields, "INRPSNR", this->PSNR);
  AddKnown(fields, "INRSSIM", this->SSIM);
  AddKnown(fields, "INRMaximumError", this->MaximumError);
  AddText(fields, "INRSummary", this->Summary());
}

std::string vtkINRReader::Summary() const
{
  std::string text;
  for (const vtkIdType voxels : this->NativeDimensions) {
    text += (text.empty() ? "" : " x ") + std::to_string(voxels);
  }
  text += " voxels";
  if (MayHideVoxels(this->Internal->Source->Header()) && this->Dimensions[0] == 0) {
    text += " (of more, if it was trained out of core: set Dimensions)";
  }
  text += ", " + Rounded(this->Ratio) + ":1";
  const auto add = [&text](const char* what, double value, const char* unit) {
    text += std::isnan(value) ? "" : std::string(", ") + what + " " + Rounded(value) + unit;
  };
  add("PSNR", this->PSNR, " dB");
  add("SSIM", this->SSIM, "");
  add("largest error", this->MaximumError, "");
  const std::optional<inr::Quality>& quality = this->Internal->Source->Header().quality;
  if (quality && quality->sampledVoxels > 0) {
    text += ", measured on " + std::to_string(quality->sampledVoxels) + " voxels";
  }
  const std::optional<inr::TrainingRecord>& training = this->Internal->Source->Header().training;
  if (training && training->nonFinite > 0) {
    text += "; what it shows at " + std::to_string(training->nonFinite) +
            " voxels that had no value is made up";
  }
  return text;
}

void vtkINRReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "ArrayName: " << (this->ArrayName ? this->ArrayName : "(as in the file)") << "\n"
     << indent << "MaximumGridPoints: " << this->MaximumGridPoints << "\n"
     << indent << "ScaleFactor: " << this->ScaleFactor << "\n"
     << indent << "DataRange: " << this->DataRange[0] << " " << this->DataRange[1] << "\n"
     << indent << "Dimensions: " << this->Dimensions[0] << " " << this->Dimensions[1] << " "
     << this->Dimensions[2] << "\n";
}

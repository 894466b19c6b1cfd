// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/PipelineReader.h"

#include "Core/Error.h"
#include "Readers/Common/Extents.h"
#include "Readers/Common/StopSignals.h"
#include "Readers/Training/RawFiles.h"
#include "Readers/Training/Upstream.h"

#include <vtkAbstractArray.h>
#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <string>

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;
using Extent = std::array<int, 6>;

/// Neighbours that a chain of filters looks at; of longer ones that do so hardly any are.
constexpr int MostMargin = 3;

Extent ExtentOf(const inr::GridBox& box, const int* whole)
{
  Extent extent{};
  for (int axis = 0; axis < 3; ++axis) {
    extent[2 * axis] = whole[2 * axis] + static_cast<int>(box.first[axis]);
    extent[2 * axis + 1] = extent[2 * axis] + static_cast<int>(box.size[axis]) - 1;
  }
  return extent;
}

Extent Grown(const Extent& extent, int margin, const int* whole)
{
  Extent grown{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grown[2 * axis] = std::max(extent[2 * axis] - margin, whole[2 * axis]);
    grown[2 * axis + 1] = std::min(extent[2 * axis + 1] + margin, whole[2 * axis + 1]);
  }
  return grown;
}

/// One voxel for each filter upstream. Those of VTK's imaging modules ask for what they look at,
/// and what ParaView has behind every source passes image data on.
int MarginFor(vtkAlgorithm& consumer)
{
  int filters = 0;
  for (vtkAlgorithm* algorithm : UpstreamOf(&consumer)) {
    const bool isFilter = algorithm->GetTotalNumberOfInputConnections() > 0;
    const bool needsNone =
        algorithm->IsA("vtkThreadedImageAlgorithm") || algorithm->IsA("vtkPVPostFilter");
    filters += isFilter && !needsNone ? 1 : 0;
  }
  return std::min(filters, MostMargin);
}

std::string ToText(const Extent& extent)
{
  std::string text;
  for (const int limit : extent) {
    text += (text.empty() ? "" : " ") + std::to_string(limit);
  }
  return text;
}

/// Lets all data upstream go.
void ReleaseUpstream(vtkAlgorithm& consumer)
{
  for (vtkAlgorithm* algorithm : UpstreamOf(&consumer)) {
    for (int port = 0; port < algorithm->GetNumberOfOutputPorts(); ++port) {
      vtkDataObject* data = algorithm->GetOutputDataObject(port);
      if (data) {
        data->ReleaseData();
      }
    }
  }
}

/// Asks for an extent, whichever process this is.
void Request(vtkInformation* input, const Extent& extent)
{
  input->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
  input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  input->Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
}

/// Per voxel, of the arrays of which a source tells the type before it reads them.
std::int64_t KnownBytes(vtkInformationVector* arrays)
{
  std::int64_t bytes = 0;
  for (int k = 0; arrays && k < arrays->GetNumberOfInformationObjects(); ++k) {
    vtkInformation* array = arrays->GetInformationObject(k);
    if (array->Has(vtkDataObject::FIELD_ARRAY_TYPE())) {
      const bool told = array->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
      const int components = told ? array->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()) : 1;
      bytes += std::int64_t{vtkAbstractArray::GetDataTypeSize(
                   array->Get(vtkDataObject::FIELD_ARRAY_TYPE()))} *
               std::max(components, 1);
    }
  }
  return bytes;
}

/// Of all arrays.
std::int64_t BytesPerVoxel(vtkImageData& image)
{
  std::int64_t bytes = 0;
  for (vtkDataSetAttributes* data : {static_cast<vtkDataSetAttributes*>(image.GetPointData()),
                                     static_cast<vtkDataSetAttributes*>(image.GetCellData())}) {
    for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
      const vtkAbstractArray* array = data->GetAbstractArray(k);
      bytes += std::int64_t{array->GetDataTypeSize()} * array->GetNumberOfComponents();
    }
  }
  return bytes;
}

} // namespace

WholeImage WholeImage::Of(vtkInformation* input)
{
  WholeImage image;
  auto* data = vtkImageData::SafeDownCast(input->Get(vtkDataObject::DATA_OBJECT()));
  if (!data || !input->Has(Pipeline::WHOLE_EXTENT())) {
    return image;
  }
  input->Get(Pipeline::WHOLE_EXTENT(), image.extent);
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t first = image.extent[2 * axis];
    image.dims[axis] = std::max<std::int64_t>(0, image.extent[2 * axis + 1] - first + 1);
  }
  image.isInMemory = std::equal(image.extent, image.extent + 6, data->GetExtent()) &&
                     data->GetPointData()->GetNumberOfArrays() > 0;
  const std::int64_t known = KnownBytes(input->Get(vtkDataObject::POINT_DATA_VECTOR())) +
                             KnownBytes(input->Get(vtkDataObject::CELL_DATA_VECTOR()));
  const glm::dvec3 dims(image.dims);
  image.bytes = dims.x * dims.y * dims.z *
                static_cast<double>(known > 0 ? known : std::int64_t{sizeof(double)});
  return image;
}

void WholeImage::learnBytes(vtkImageData& part)
{
  const glm::dvec3 voxels(this->dims);
  this->bytes = voxels.x * voxels.y * voxels.z * static_cast<double>(BytesPerVoxel(part));
}

void WholeImage::ask(vtkInformation* input, bool onlyFirst) const
{
  Extent wanted{};
  std::copy_n(this->extent, 6, wanted.begin());
  for (std::size_t axis = 0; axis < 3 && onlyFirst; ++axis) {
    wanted[2 * axis + 1] = wanted[2 * axis];
  }
  Request(input, wanted);
}

vtkImageData* UpdateInput(vtkAlgorithm& consumer, const std::function<void(vtkInformation*)>& ask,
                          bool afresh)
{
  const std::string rawProblem = RawFiles(&consumer).problem(); // it may have been cut since
  if (!rawProblem.empty()) {
    throw inr::Error(inr::ErrorCode::CannotRead, rawProblem);
  }
  if (afresh) {
    ReleaseUpstream(consumer);
  }
  const UpstreamErrors errors(&consumer);
  auto* producer = Pipeline::SafeDownCast(consumer.GetInputExecutive());
  if (producer) {
    producer->UpdateInformation(); // which makes what is asked for the whole, where it is new
  }
  ask(consumer.GetInputInformation());
  const int port = consumer.GetInputConnection(0, 0)->GetIndex();
  // Some readers keep the code of a failure before, and report with a new one.
  const unsigned long before = producer ? producer->GetAlgorithm()->GetErrorCode() : 0;
  const bool updated = producer && producer->Update(port) != 0;
  errors.check();
  const unsigned long after = producer ? producer->GetAlgorithm()->GetErrorCode() : 0;
  if (!updated || (after != 0 && after != before)) {
    throw inr::Error(inr::ErrorCode::CannotRead,
                     "the source failed; what it reported, if anything, says why");
  }
  return vtkImageData::SafeDownCast(consumer.GetInputDataObject(0, 0));
}

void ForgetKept(vtkAlgorithm& consumer)
{
  for (vtkAlgorithm* algorithm : UpstreamOf(&consumer)) {
    if (algorithm->GetTotalNumberOfInputConnections() > 0) { // a reader keeps what it knows
      algorithm->Modified();
    }
  }
}

PipelineReader::PipelineReader(vtkAlgorithm& consumer, const WholeImage& whole, vtkImageData& first,
                               Finder finder, bool afresh)
    : Consumer(consumer), Whole(whole), Afresh(afresh), Margin(MarginFor(consumer)),
      Bytes(BytesPerVoxel(first)), Find(std::move(finder))
{
  const TrainingInput input = this->Find(&first);
  this->Type = input.data.type;
  this->ArrayName = input.info.arrayName;
}

vtkSmartPointer<vtkImageData> PipelineReader::request(const inr::GridBox& box) const
{
  const Extent extent = ExtentOf(box, this->Whole.extent);
  const Extent wanted = Grown(extent, this->Margin, this->Whole.extent);
  const auto ask = [&](vtkInformation* input) { Request(input, wanted); };
  vtkImageData* image = UpdateInput(this->Consumer, ask, this->Afresh);
  if (StopSignals::Received()) { // what was asked for may have stopped, too
    throw inr::Error(inr::ErrorCode::Cancelled, "stopped while the source was read");
  }
  if (image && !Contains(image->GetExtent(), extent.data())) {
    ForgetKept(this->Consumer);
    image = UpdateInput(this->Consumer, ask, this->Afresh);
  }
  if (!image || !Contains(image->GetExtent(), extent.data())) {
    throw inr::Error(inr::ErrorCode::CannotRead, "the source did not give the voxels of extent " +
                                                     ToText(extent) +
                                                     "; what it reported, if anything, says why");
  }
  auto piece = vtkSmartPointer<vtkImageData>::New();
  piece->ShallowCopy(image);
  piece->Crop(extent.data()); // nothing is copied where the extents are the same
  return piece;
}

inr::VolumePiece PipelineReader::read(const inr::GridBox& box)
{
  this->Piece = TrainingInput(); // two pieces need not be in memory
  const vtkSmartPointer<vtkImageData> image = this->request(box);
  this->Piece = this->Find(image);
  if (this->Piece.info.arrayName != this->ArrayName) {
    throw inr::Error(inr::ErrorCode::CannotRead,
                     "the source gave array '" + this->Piece.info.arrayName +
                         "' where it had given '" + this->ArrayName + "' before; choose one");
  }
  return {this->Piece.data, box.first};
}

// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRSlice.h"

#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Readers/Common/MemoryCheck.h"
#include "Readers/Common/StopSignals.h"
#include "Readers/Common/VTKCompat.h"
#include "Readers/Grid/NativeGrid.h"
#include "Readers/Grid/PlaneGrid.h"
#include "Readers/Grid/Scalars.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRSlice);

namespace {

/// Positions evaluated between two looks at whether to stop.
constexpr std::int64_t PositionsPerLook = std::int64_t{1} << 18;
/// What a point takes with its cell while the output is made.
constexpr double BytesPerPoint = 150;

/// Of any affine function, its transform included.
Plane PlaneOf(vtkPlane* function)
{
  double zero[3] = {0, 0, 0};
  glm::dvec3 gradient;
  function->FunctionGradient(zero, &gradient.x);
  const double offset = function->FunctionValue(zero);
  const double length = glm::length(gradient);
  if (!std::isfinite(length) || !std::isfinite(offset)) {
    throw inr::Error(
        inr::ErrorCode::InvalidArgument,
        "the plane is nowhere; set an Origin and a Normal that are finite and not that large");
  }
  if (!(length > 0.0)) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "the plane has no direction; set a Normal other than 0 0 0, or a longer one");
  }
  return {gradient / length, offset / length};
}

vtkSmartPointer<vtkDoubleArray> Coordinates(const PlaneGrid& plane, const PlaneMesh& mesh)
{
  auto coordinates = vtkSmartPointer<vtkDoubleArray>::New();
  coordinates->SetNumberOfComponents(3);
  RequireRoom(mesh.points.size() * 3 * sizeof(double));
  coordinates->SetNumberOfTuples(static_cast<vtkIdType>(mesh.points.size()));
  double* out = coordinates->GetPointer(0);
  for (const glm::dvec2& point : mesh.points) {
    const glm::dvec3 world = plane.World(point);
    out = std::copy_n(&world.x, 3, out);
  }
  return coordinates;
}

vtkSmartPointer<vtkIdTypeArray> Numbers(const std::vector<std::int64_t>& values)
{
  auto array = vtkSmartPointer<vtkIdTypeArray>::New();
  RequireRoom(values.size() * sizeof(vtkIdType));
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

/// Integers of up to 16 bits, and their means, fit into float.
bool NeedsDouble(inr::ScalarType type)
{
  return inr::ScalarSize(type) > 2 && type != inr::ScalarType::Float32;
}

/// Values at the points of a slice, a batch at a time.
class SliceValues
{
public:
  SliceValues(const inr::ModelPointer& model, const PlaneGrid& plane, const PlaneMesh& mesh)
      : Model(model), Evaluator(inr::MakeEvaluator(model)), Plane(plane), Mesh(mesh)
  {}

  template <class T> void Compute(std::int64_t first, std::int64_t count, T* values)
  {
    std::vector<glm::vec3> positions(static_cast<std::size_t>(count));
    std::vector<float> normalised(positions.size());
    this->Arena.forEachBlock(count, 4096, [&](std::int64_t begin, std::int64_t end) {
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
        positions[k] = this->Plane.Unit(this->Mesh.points[static_cast<std::size_t>(first) + k]);
      }
    });
    inr::EvaluateParallel(*this->Evaluator, this->Arena, positions.data(), count,
                          normalised.data());
    std::transform(normalised.begin(), normalised.end(), values + first, [this](float y) {
      return static_cast<T>(inr::ValueOf(this->Model->volume, inr::NormalisedOutput(y)));
    });
  }

private:
  inr::ModelPointer Model;
  std::shared_ptr<const inr::Evaluator> Evaluator;
  inr::Arena Arena;
  const PlaneGrid& Plane;
  const PlaneMesh& Mesh;
};

/// Null when it was stopped.
template <class Array>
vtkSmartPointer<vtkDataArray> ComputeValues(vtkAlgorithm& filter, const StopSignals& signals,
                                            SliceValues& source, std::int64_t count)
{
  auto values = vtkSmartPointer<Array>::New();
  RequireRoom(static_cast<std::size_t>(count) * sizeof(typename Array::ValueType));
  values->SetNumberOfValues(count);
  for (std::int64_t first = 0; first < count; first += PositionsPerLook) {
    const std::int64_t batch = std::min(PositionsPerLook, count - first);
    source.Compute(first, batch, values->GetPointer(0));
    filter.UpdateProgress(static_cast<double>(first + batch) / static_cast<double>(count));
    if (signals.Received() || IsAborted(filter)) {
      return nullptr;
    }
  }
  return values;
}

} // namespace

vtkINRSlice::vtkINRSlice() : CutFunction(vtkSmartPointer<vtkPlane>::New()) {}

vtkINRSlice::~vtkINRSlice() = default;

void vtkINRSlice::SetCutFunction(vtkPlane* plane)
{
  if (plane && plane != this->CutFunction) {
    this->CutFunction = plane;
    this->Modified();
  }
}

vtkPlane* vtkINRSlice::GetCutFunction() { return this->CutFunction; }

vtkMTimeType vtkINRSlice::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->CutFunction->GetMTime());
}

int vtkINRSlice::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkINRSlice::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
                                     vtkInformationVector*)
{
  RequestWholeInput(inputVector[0]->GetInformationObject(0));
  return 1;
}

int vtkINRSlice::RequestData(vtkInformation*, vtkInformationVector** inputVector,
                             vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  vtkPolyData* output = vtkPolyData::GetData(outInfo);
  output->Initialize();
  const StopSignals signals;
  try {
    const auto grid = FindInputGrid(this, vtkDataObject::GetData(inputVector[0]));
    if (grid) {
      this->Cut(*grid, outInfo, signals);
    }
  } catch (const std::exception& error) { // inr::Error, or no memory
    output->Initialize();
    vtkErrorMacro("Cannot slice: " << error.what());
  }
  return 1;
}

void vtkINRSlice::Cut(const NativeGrid& grid, vtkInformation* outInfo, const StopSignals& signals)
{
  const vtkIdType most = this->MaximumPoints > 0 ? this->MaximumPoints : VTK_ID_MAX;
  const PlaneGrid plane(grid, PlaneOf(this->CutFunction), most);
  const int pieces = std::max(1, outInfo->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()));
  RequireMemory(BytesPerPoint * static_cast<double>(plane.GetNumberOfPoints()) / pieces,
                "the points of the slice", "lower MaximumPoints");
  const PlaneMesh mesh = plane.Mesh(outInfo->Get(Pipeline::UPDATE_PIECE_NUMBER()), pieces);

  SliceValues source(grid.model, plane, mesh);
  const auto count = static_cast<std::int64_t>(mesh.points.size());
  const auto values = NeedsDouble(grid.model->volume.type)
                          ? ComputeValues<vtkDoubleArray>(*this, signals, source, count)
                          : ComputeValues<vtkFloatArray>(*this, signals, source, count);
  if (!values) {
    return;
  }
  values->SetName(grid.arrayName.c_str());
  vtkNew<vtkPoints> points;
  points->SetData(Coordinates(plane, mesh));
  vtkNew<vtkCellArray> polygons;
  polygons->SetData(Numbers(mesh.offsets), Numbers(mesh.connectivity));
  vtkPolyData* output = vtkPolyData::GetData(outInfo);
  output->SetPoints(points);
  output->SetPolys(polygons);
  output->GetPointData()->SetScalars(values);
}

void vtkINRSlice::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumPoints: " << this->MaximumPoints << "\n" << indent << "CutFunction:\n";
  this->CutFunction->PrintSelf(os, indent.GetNextIndent());
}

// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINRContour.h"

#include "Core/Cache/LevelVoxels.h"
#include "Core/Error.h"
#include "Core/Inference/Evaluator.h"
#include "Readers/Common/StopSignals.h"
#include "Readers/Common/VTKCompat.h"
#include "Readers/Contour/BrickContour.h"
#include "Readers/Contour/BrickQueue.h"
#include "Readers/Contour/ContourBricks.h"
#include "Readers/Contour/SurfaceBuilder.h"
#include "Readers/Grid/NativeGrid.h"

#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkINRContour);

namespace {

/// Bricks between two looks at whether to stop.
constexpr std::size_t BricksPerLook = 64;
/// Of a level that somebody asks for: the list of them stays well below a GiB.
constexpr std::int64_t MostBricks = std::int64_t{1} << 23;

/// Decodes bricks and finds the surfaces in them.
class PatchMaker
{
public:
  PatchMaker(const inr::ModelPointer& model, const ContourBricks& bricks,
             const std::vector<double>& values, bool gradients)
      : Volume(model->volume), Evaluator(inr::MakeEvaluator(model)),
        Voxels(*model, bricks.GetLevel()), Bricks(bricks), Values(values),
        GradientUnit(gradients ? model->volume.high - model->volume.low : 0)
  {}

  /// By brick, then by value.
  std::vector<std::vector<SurfacePatch>> Make(const std::vector<inr::BrickKey>& keys) const
  {
    std::vector<std::vector<SurfacePatch>> patches(keys.size());
    this->Arena.forEachBlock(static_cast<std::int64_t>(keys.size()), 1,
                             [&](std::int64_t k, std::int64_t) {
                               const auto at = static_cast<std::size_t>(k);
                               patches[at] = this->MakeOne(keys[at]);
                             });
    return patches;
  }

private:
  std::vector<SurfacePatch> MakeOne(inr::BrickKey key) const
  {
    BrickContour brick(this->Bricks.BoxOf(key), this->Bricks.Size(), this->GradientUnit);
    for (const float y : this->Voxels.in(brick.GetBox(), *this->Evaluator)) {
      brick.values.push_back(inr::ValueOf(this->Volume, y));
    }
    std::vector<SurfacePatch> patches;
    for (const double value : this->Values) {
      patches.push_back(brick.Contour(value));
    }
    return patches;
  }

  const inr::VolumeInfo& Volume;
  std::shared_ptr<const inr::Evaluator> Evaluator;
  inr::LevelVoxels Voxels;
  const ContourBricks& Bricks;
  const std::vector<double>& Values;
  double GradientUnit; ///< no voxels differ by more
  inr::Arena Arena;
};

void RequireDepth(const glm::i64vec3& dims)
{
  if (std::min({dims.x, dims.y, dims.z}) < 2) {
    throw inr::Error(inr::ErrorCode::Unsupported,
                     "a volume with a single voxel along an axis has no isosurfaces; decode it "
                     "with INRDecode and take ParaView's Contour");
  }
}

void RequireNumbers(const std::vector<double>& values)
{
  if (std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); })) {
    throw inr::Error(inr::ErrorCode::InvalidArgument,
                     "an isovalue is not a number; set Isosurfaces to values of the data's range");
  }
}

} // namespace

struct vtkINRContour::Selection
{
  int level;
  std::vector<inr::BrickKey> bricks;
};

void vtkINRContour::SetValue(int k, double value)
{
  k = std::max(k, 0);
  if (k >= this->GetNumberOfContours()) {
    this->SetNumberOfContours(k + 1);
  }
  double& mine = this->Values[static_cast<std::size_t>(k)];
  if (mine != value) {
    mine = value;
    this->Modified();
  }
}

double vtkINRContour::GetValue(int k)
{
  return k >= 0 && k < this->GetNumberOfContours() ? this->Values[static_cast<std::size_t>(k)] : 0;
}

void vtkINRContour::SetNumberOfContours(int count)
{
  if (count != this->GetNumberOfContours()) {
    this->Values.resize(static_cast<std::size_t>(std::max(count, 0)));
    this->Modified();
  }
}

int vtkINRContour::GetNumberOfContours() { return static_cast<int>(this->Values.size()); }

int vtkINRContour::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkINRContour::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
                                       vtkInformationVector*)
{
  RequestWholeInput(inputVector[0]->GetInformationObject(0));
  return 1;
}

int vtkINRContour::RequestData(vtkInformation*, vtkInformationVector** inputVector,
                               vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  vtkPolyData* output = vtkPolyData::GetData(outInfo);
  output->Initialize();
  this->LevelInUse = -1;
  this->DecodedBricks = this->NumberOfBricks = this->SkippedCells = this->NumberOfCells = 0;
  const StopSignals signals;
  try {
    const auto grid = FindInputGrid(this, vtkDataObject::GetData(inputVector[0]));
    if (grid) {
      this->Contour(*grid, outInfo, signals);
    }
  } catch (const std::exception& error) { // inr::Error, or no memory
    output->Initialize();
    vtkErrorMacro("Cannot contour: " << error.what());
  }
  return 1;
}

void vtkINRContour::Contour(const NativeGrid& grid, vtkInformation* outInfo,
                            const StopSignals& signals)
{
  const inr::Model& model = *grid.model;
  RequireDepth(model.volume.dims);
  RequireNumbers(this->Values);
  if (this->Values.empty()) {
    return;
  }
  const CrossedCells crossed(model, this->Values, inr::Arena());
  this->NumberOfCells = static_cast<vtkIdType>(model.macroCells.ranges.size());
  this->SkippedCells = this->NumberOfCells - crossed.Count();
  const Selection selection = this->Select(model, crossed);
  const ContourBricks bricks(model, selection.level);
  this->LevelInUse = selection.level;
  this->NumberOfBricks = bricks.Bricks().x * bricks.Bricks().y * bricks.Bricks().z;

  BrickQueue queue(selection.bricks, outInfo->Get(Pipeline::UPDATE_PIECE_NUMBER()),
                   std::max(1, outInfo->Get(Pipeline::UPDATE_NUMBER_OF_PIECES())));
  SurfaceBuilder surface(grid, selection.level, this->Values.size(), this->ComputeNormals);
  if (this->Build(grid, bricks, queue, surface, signals)) {
    vtkPolyData* output = vtkPolyData::GetData(outInfo);
    surface.Finish(output);
    vtkNew<vtkIntArray> level;
    level->SetName("INRLevel");
    level->InsertNextValue(selection.level);
    output->GetFieldData()->AddArray(level);
  }
}

vtkINRContour::Selection vtkINRContour::Select(const inr::Model& model,
                                               const CrossedCells& crossed) const
{
  const glm::i64vec3& dims = model.volume.dims;
  const int coarsest = ContourBricks::CoarsestLevel(dims, model.macroCells);
  int level = std::clamp(this->Level, 0, coarsest);
  for (; this->Level < 0 && level < coarsest; ++level) {
    const ContourBricks bricks(model, level);
    const double limit = static_cast<double>(this->MaximumSamples) / bricks.SamplesPerBrick();
    const auto selected = bricks.Select(crossed, static_cast<std::int64_t>(limit));
    if (selected) {
      return {level, *selected};
    }
  }
  const auto selected = ContourBricks(model, level).Select(crossed, MostBricks);
  if (!selected) {
    throw inr::Error(inr::ErrorCode::TooLarge,
                     "the surface may run through more than " + std::to_string(MostBricks) +
                         " bricks of level " + std::to_string(level) + "; choose a higher Level");
  }
  return {level, *selected};
}

bool vtkINRContour::Build(const NativeGrid& grid, const ContourBricks& bricks, BrickQueue& queue,
                          SurfaceBuilder& surface, const StopSignals& signals)
{
  const PatchMaker maker(grid.model, bricks, this->Values, this->ComputeNormals);
  double progress = 0;
  for (auto keys = queue.Next(BricksPerLook); !keys.empty(); keys = queue.Next(BricksPerLook)) {
    const auto patches = maker.Make(keys);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      for (std::size_t value = 0; value < this->Values.size(); ++value) {
        surface.Add(value, this->Values[value], patches[k][value]);
        queue.Follow(keys[k], patches[k][value].reaches, bricks.Bricks());
      }
    }
    this->DecodedBricks = queue.GetNumberDone();
    this->RequireMemoryFor(surface);
    const auto known = static_cast<double>(queue.GetNumberKnown());
    progress = std::max(progress, static_cast<double>(this->DecodedBricks) / known);
    this->UpdateProgress(progress);
    if (signals.Received() || IsAborted(*this)) {
      return false;
    }
  }
  return true;
}

void vtkINRContour::RequireMemoryFor(const SurfaceBuilder& surface) const
{
  constexpr double mib = 1024.0 * 1024.0;
  if (surface.GetBytes() > this->MemoryLimit * mib) {
    throw inr::Error(inr::ErrorCode::TooLarge,
                     "after " + std::to_string(surface.GetNumberOfTriangles()) +
                         " triangles the surfaces take more than the MemoryLimit of " +
                         std::to_string(this->MemoryLimit) + " MiB; choose a higher Level than " +
                         std::to_string(this->LevelInUse) + ", or raise MemoryLimit");
  }
}

void vtkINRContour::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Level: " << this->Level << "\n"
     << indent << "MaximumSamples: " << this->MaximumSamples << "\n"
     << indent << "MemoryLimit: " << this->MemoryLimit << "\n"
     << indent << "ComputeNormals: " << (this->ComputeNormals ? "on" : "off") << "\n"
     << indent << "Values:";
  for (const double value : this->Values) {
    os << " " << value;
  }
  os << "\n";
}

// SPDX-License-Identifier: BSD-3-Clause
#include "TestModel.h"

#include "Core/Inference/Evaluator.h"
#include "Core/Model/ModelFile.h"

#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace test {
namespace {

constexpr int CellEdge = 16;

/// 1 at the centre of a blob, falling smoothly to 0 at `radius`.
double Blob(const glm::dvec3& u, const glm::dvec3& centre, double radius)
{
  const double r = glm::length(u - centre) / radius;
  return r >= 1 ? 0.0 : (1 - r * r) * (1 - r * r);
}

double Field(const glm::dvec3& u)
{
  return std::max({Blob(u, {0.38, 0.42, 0.45}, 0.36), 0.7 * Blob(u, {0.72, 0.60, 0.35}, 0.22),
                   0.45 * Blob(u, {0.55, 0.25, 0.75}, 0.20)});
}

inr::Description PassThrough()
{
  inr::Description description;
  description.grid.type = inr::GridType::Dense;
  description.grid.levels = 1;
  description.grid.features = 1;
  description.grid.baseResolution = 28;
  description.network.hiddenLayers = 0;
  return description;
}

void FillParameters(inr::Model& model)
{
  const inr::Layout layout(model.description);
  model.parameters.assign(layout.parameterCount, 0.0f);
  model.parameters[layout.layers[0].offset] = 1.0f;
  const inr::GridLevel& level = layout.levels[0];
  const std::uint64_t n = level.resolution;
  for (std::uint64_t i = 0; i < n * n * n; ++i) {
    const glm::dvec3 lattice(i % n, i / n % n, i / (n * n));
    const double value = Field((lattice - 0.5) / static_cast<double>(level.scale));
    model.parameters[layout.gridOffset + level.offset + i] = static_cast<float>(value);
  }
}

std::vector<float> Voxels(const inr::ModelPointer& model)
{
  const glm::i64vec3 dims = model->volume.dims;
  std::vector<float> values(dims.x * dims.y * dims.z);
  inr::EvaluateLattice(*inr::MakeEvaluator(model), inr::Arena(),
                       inr::VoxelLattice(dims, glm::i64vec3(0), dims), values.data());
  return values;
}

/// Every voxel extends its own cell and, as the apron of one voxel, the neighbouring ones.
inr::MacroCells MeasureCells(const glm::i64vec3& dims, const std::vector<float>& voxels)
{
  inr::MacroCells cells = inr::MakeMacroCells(dims, CellEdge);
  cells.provenance = inr::MacroCellProvenance::Decoded;
  for (std::int64_t i = 0; i < dims.x * dims.y * dims.z; ++i) {
    const glm::i64vec3 v = inr::GridPlace(i, dims);
    const glm::i64vec3 first =
        glm::max(v - std::int64_t{1}, std::int64_t{0}) / std::int64_t{CellEdge};
    const glm::i64vec3 last =
        glm::min(v + std::int64_t{1}, dims - std::int64_t{1}) / std::int64_t{CellEdge};
    for (std::int64_t z = first.z; z <= last.z; ++z) {
      for (std::int64_t y = first.y; y <= last.y; ++y) {
        for (std::int64_t x = first.x; x <= last.x; ++x) {
          cells.ranges[cells.index(x, y, z)].extend(voxels[i]);
        }
      }
    }
  }
  return cells;
}

inr::ModelPointer Make(const glm::dmat3& direction)
{
  auto model = std::make_shared<inr::Model>();
  model->description = PassThrough();
  model->volume.dims = {40, 48, 56};
  model->volume.spacing = {1.5, 1.0, 0.75};
  model->volume.origin = {10.0, -5.0, 3.0};
  model->volume.direction = direction;
  model->volume.arrayName = "blobs";
  model->volume.low = -20;
  model->volume.high = 180;
  model->storedAs = inr::ParameterType::Float;
  FillParameters(*model);
  model->macroCells = MeasureCells(model->volume.dims, Voxels(model));
  return model;
}

} // namespace

inr::ModelPointer MakeModel() { return Make(glm::dmat3(1.0)); }

inr::ModelPointer MakeOblique()
{
  const double c = std::cos(0.6), s = std::sin(0.6);
  return Make(glm::dmat3(c, s, 0, -s, c, 0, 0, 0, 1)); // columns: turned about z
}

std::string Write(const inr::Model& model, const std::string& name)
{
  const std::string path = std::string(INR_TEST_OUTPUT) + "/" + name;
  inr::WriteModel(model, path);
  return path;
}

vtkSmartPointer<vtkImageData> Decode(const inr::ModelPointer& model)
{
  const inr::VolumeInfo& info = model->volume;
  const std::vector<float> normalised = Voxels(model);
  vtkNew<vtkFloatArray> scalars;
  scalars->SetName(info.arrayName.c_str());
  scalars->SetNumberOfTuples(static_cast<vtkIdType>(normalised.size()));
  for (std::size_t i = 0; i < normalised.size(); ++i) {
    scalars->SetValue(static_cast<vtkIdType>(i),
                      static_cast<float>(info.low + (info.high - info.low) * normalised[i]));
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(info.dims.x), static_cast<int>(info.dims.y),
                       static_cast<int>(info.dims.z));
  image->SetSpacing(info.spacing.x, info.spacing.y, info.spacing.z);
  image->SetOrigin(info.origin.x, info.origin.y, info.origin.z);
  const glm::dmat3& d = info.direction;
  image->SetDirectionMatrix(d[0][0], d[1][0], d[2][0], d[0][1], d[1][1], d[2][1], d[0][2], d[1][2],
                            d[2][2]);
  image->GetPointData()->SetScalars(scalars);
  return image;
}

} // namespace test

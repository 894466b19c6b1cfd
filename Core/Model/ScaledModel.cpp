// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/ScaledModel.h"

#include "Core/Error.h"
#include "Core/Model/RangeGrids.h"
#include "Core/Parallel.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace inr {

namespace {

constexpr double SmallestFactor = 0.25;
constexpr double LargestFactor = 4.0;

void RequireFactor(double factor)
{
  if (!(factor >= SmallestFactor && factor <= LargestFactor)) {
    std::ostringstream message;
    message << "the ScaleFactor must be from " << SmallestFactor << " to " << LargestFactor
            << ", not " << factor;
    throw Error(ErrorCode::InvalidArgument, message.str());
  }
}

/// Whether samples between voxels of the volume show nothing beyond the neighbouring cells.
bool HoldNeighbours(const MacroCells& cells, const VolumeInfo& volume)
{
  const glm::dvec3 edges = cells.spacing * glm::dvec3(volume.dims);
  return (cells.dims.x == 1 || edges.x >= 1) && (cells.dims.y == 1 || edges.y >= 1) &&
         (cells.dims.z == 1 || edges.z >= 1);
}

/// Ranges hold the values of native voxels next to a cell; those of a coarser grid may come from
/// further away.
MacroCells WidenedFor(const VolumeInfo& volume, MacroCells cells)
{
  const Arena arena;
  while (!HoldNeighbours(cells, volume)) {
    cells = Joined(cells, arena);
  }
  return Dilated(cells, arena);
}

} // namespace

VolumeInfo ScaledVolume(const VolumeInfo& volume, double factor)
{
  RequireFactor(factor);
  VolumeInfo scaled = volume;
  glm::dvec3 first(0.0); // where voxel 0 is, from that of the native grid
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t native = volume.dims[axis];
    const std::int64_t wanted = std::llround(static_cast<double>(native) * factor);
    if (native > 1 && wanted != native) {
      scaled.dims[axis] = std::max<std::int64_t>(2, wanted);
      scaled.spacing[axis] *= static_cast<double>(native) / static_cast<double>(scaled.dims[axis]);
      first[axis] = 0.5 * (scaled.spacing[axis] - volume.spacing[axis]);
    }
  }
  scaled.origin += volume.direction * first;
  RequireValidVolume(scaled, ErrorCode::InvalidArgument);
  return scaled;
}

ModelPointer ScaledModel(const ModelPointer& model, double factor)
{
  VolumeInfo volume = ScaledVolume(model->volume, factor);
  if (factor == 1) {
    return model;
  }
  auto scaled = std::make_shared<Model>(*model);
  if (factor < 1 && !scaled->macroCells.empty()) {
    scaled->macroCells = WidenedFor(volume, std::move(scaled->macroCells));
  }
  if (factor > 1) { // what lies between the voxels that were measured, nobody has looked at
    scaled->macroCells.provenance = MacroCellProvenance::File;
  }
  scaled->nativeDims = model->nativeDims.value_or(model->volume.dims);
  scaled->volume = std::move(volume);
  return scaled;
}

} // namespace inr

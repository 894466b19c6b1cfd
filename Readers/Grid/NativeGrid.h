// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;

/// The whole extent of what is not there.
constexpr int NoVoxels[6] = {0, -1, 0, -1, 0, -1};

/// The native grid behind an image that presents an INR, placed as the image is now: a filter may
/// have changed spacing, origin and extent. Voxel i of N stands at
/// origin + direction * (i * spacing).
struct NativeGrid
{
  inr::ModelPointer model;
  std::string arrayName;
  glm::dvec3 origin{0.0};
  glm::dvec3 spacing{1.0};
  glm::dmat3 direction{1.0};

  /// Columns: the way from a voxel to the next one along each axis.
  glm::dmat3 Axes() const
  {
    const glm::dmat3& d = this->direction;
    return {d[0] * this->spacing.x, d[1] * this->spacing.y, d[2] * this->spacing.z};
  }
};

/// The grid of a coarser level, see inr::VoxelsAtLevel: it fills the same space.
struct LevelGrid
{
  LevelGrid(const NativeGrid& native, int level);

  glm::i64vec3 dims;
  glm::dvec3 growth; ///< of the spacing
  glm::dvec3 origin; ///< where its voxel 0 stands
};

/// The grid of the first array of `data` that an INR computes, the active scalars first; nothing
/// where there is none.
std::optional<NativeGrid> FindNativeGrid(vtkDataObject* data);

/// Like it, for the input of a filter. Where data are there but no INR, the filter reports an
/// error; where there are none, the reader has said why.
std::optional<NativeGrid> FindInputGrid(vtkAlgorithm* filter, vtkDataObject* data);

/// Asks for the whole of a filter's input in one piece: it is virtual, and its grid is what counts.
void RequestWholeInput(vtkInformation* inInfo);

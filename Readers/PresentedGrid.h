// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

/// The grid that stock filters see: it spans the native grid's point bounds, with fewer points
/// where the native grid has too many. Point k of n on an axis is the native index k*(N-1)/(n-1).
struct PresentedGrid
{
  glm::ivec3 dims{1};
  glm::dvec3 spacing{1.0};
};

/// The finest such grid with at most `maximumPoints` points (but at least two on every axis that
/// has two); 0 asks for the native grid. A valid model's grid is never too large for VTK's numbers.
PresentedGrid PresentGrid(const inr::VolumeInfo& volume, std::int64_t maximumPoints);

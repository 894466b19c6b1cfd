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
  /// Coarser than what was asked for, which has more than LargestPresentedGrid points.
  bool limited = false;
};

/// Points of the largest grid that is presented, and values that its array hands out as a copy:
/// many a stock filter takes a pointer to all values and crashes where it gets none.
constexpr std::int64_t LargestPresentedGrid = std::int64_t{1} << 28;

/// The finest such grid with at most `maximumPoints` points (but at least two on every axis that
/// has two); 0 asks for the native grid. Never more than LargestPresentedGrid. Throws
/// inr::Error(InvalidArgument) for a negative number.
PresentedGrid PresentGrid(const inr::VolumeInfo& volume, std::int64_t maximumPoints);

/// Points per axis when as many are left out evenly as it takes to have at most `maximumPoints`,
/// but at least two on every axis that has two.
glm::i64vec3 FinestDims(const glm::i64vec3& native, double maximumPoints);

/// The grid of so many points, more or fewer than the native one's. Throws
/// inr::Error(InvalidArgument) where one of the two is flat along an axis and the other is not.
PresentedGrid PresentGridOf(const inr::VolumeInfo& volume, const glm::ivec3& dims);

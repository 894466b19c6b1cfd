// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Cropping.h"
#include "Representations/Mapper/Scene/DrawnGrid.h"

#include <optional>

class vtkVolumeMapper;

namespace inr {

/// Which regions of the native grid a mapper shows, nothing when it does not crop. The mapper's
/// planes are across the axes of the image's physical space; those that are not across the axes of
/// its points, as a direction matrix turns them, cannot be followed: see WhyNotCropped. Along an
/// axis of one point each is half a voxel further out, as that is what bounds of points lack.
std::optional<Cropping> CroppingOf(const DrawnGrid& grid, vtkVolumeMapper* mapper);

/// Why CroppingOf would not be what the mapper asks for; empty when it would.
const char* WhyNotCropped(const DrawnGrid& grid, vtkVolumeMapper* mapper);

} // namespace inr

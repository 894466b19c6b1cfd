// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/CroppingRegions.h"

#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkVolumeMapper.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace inr {
namespace {

/// The axis of the physical space that an axis of the image is along, and which way.
struct PhysicalAxis
{
  int axis;
  bool opposite;
};

/// Of each of the image's axes; nothing where one of them is along none.
std::optional<std::array<PhysicalAxis, 3>> PhysicalAxes(vtkImageData* image)
{
  std::array<PhysicalAxis, 3> axes{};
  for (int column = 0; column < 3; ++column) {
    int found = -1;
    for (int row = 0; row < 3; ++row) {
      const double element = image->GetDirectionMatrix()->GetElement(row, column);
      if (std::abs(std::abs(element) - 1) < 1e-6) { // as far as files keep it
        found = row;
        axes[column] = {row, (element < 0) != (image->GetSpacing()[column] < 0)};
      } else if (std::abs(element) > 1e-6) {
        return {};
      }
    }
    if (found < 0) {
      return {};
    }
  }
  return axes;
}

/// The flags by regions of the image's axes.
std::uint32_t Reordered(std::uint32_t flags, const std::array<PhysicalAxis, 3>& axes)
{
  constexpr std::array<int, 3> strides{1, 3, 9};
  std::uint32_t result = 0;
  for (int region = 0; region < 27; ++region) {
    int physical = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int along = region / strides[axis] % 3;
      physical += strides[axes[axis].axis] * (axes[axis].opposite ? 2 - along : along);
    }
    result |= (flags >> physical & 1u) << region;
  }
  return result;
}

} // namespace

std::optional<Cropping> CroppingOf(const DrawnGrid& grid, vtkVolumeMapper* mapper)
{
  const auto axes = PhysicalAxes(grid.image);
  if (!mapper->GetCropping() || !axes) {
    return {};
  }
  const glm::dmat4 toNative = PresentedToNative(grid);
  Cropping cropping;
  for (int axis = 0; axis < 3; ++axis) {
    const PhysicalAxis physical = (*axes)[axis];
    const double step = std::abs(grid.image->GetSpacing()[axis]) * (physical.opposite ? -1 : 1);
    const auto indexOf = [&](int side) {
      const double plane = mapper->GetCroppingRegionPlanes()[2 * physical.axis + side];
      return (plane - grid.image->GetOrigin()[physical.axis]) / step - grid.shift[axis];
    };
    const double half = grid.presented[axis] == 1 ? 0.5 : 0;
    cropping.low[axis] = (indexOf(physical.opposite ? 1 : 0) - half) * toNative[axis][axis];
    cropping.high[axis] = (indexOf(physical.opposite ? 0 : 1) + half) * toNative[axis][axis];
  }
  cropping.flags = Reordered(static_cast<std::uint32_t>(mapper->GetCroppingRegionFlags()), *axes);
  return cropping;
}

const char* WhyNotCropped(const DrawnGrid& grid, vtkVolumeMapper* mapper)
{
  return mapper->GetCropping() && !PhysicalAxes(grid.image)
             ? "An INR that its direction matrix turns by other than right angles cannot be "
               "cropped; turn cropping off, and use a Clip of the decoded voxels (INRDecode) or "
               "clipping planes."
             : "";
}

} // namespace inr

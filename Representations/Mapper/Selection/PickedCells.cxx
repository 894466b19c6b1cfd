// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Selection/PickedCells.h"

#include <vtkImageData.h>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstdint>

namespace inr {
namespace {

/// Calls paint(x, y, pixel) for what is not transparent in `rgba`.
template <class Paint> Image Painted(const Image& rgba, const Paint& paint)
{
  Image painted(rgba.width, rgba.height, 4);
  for (int y = 0; y < rgba.height; ++y) {
    for (int x = 0; x < rgba.width; ++x) {
      if (rgba.pixel(x, y)[3] > 0) {
        float* pixel = painted.pixel(x, y);
        paint(x, y, pixel);
        pixel[3] = 1;
      }
    }
  }
  return painted;
}

/// The middle of what of a way is inside a box; of a way that misses it, somewhere near.
glm::dvec3 MiddleInside(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& low,
                        const glm::dvec3& high)
{
  double begin = 0;
  double end = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (way != 0) {
      const double one = (low[axis] - from[axis]) / way;
      const double other = (high[axis] - from[axis]) / way;
      begin = std::max(begin, std::min(one, other));
      end = std::min(end, std::max(one, other));
    }
  }
  return glm::mix(from, to, 0.5 * (begin + end));
}

} // namespace

Image PaintedWith(const glm::vec3& color, const Image& rgba)
{
  return Painted(rgba, [&](int, int, float* pixel) { std::copy_n(&color.x, 3, pixel); });
}

Image WithoutWhatIsUnder(Image rgba, const std::vector<const Image*>& over)
{
  for (const Image* other : over) {
    for (int y = 0; y < rgba.height && !other->pixels.empty(); ++y) {
      for (int x = 0; x < rgba.width; ++x) {
        const int column = x * other->width / rgba.width; // one of them may be smaller
        const int row = y * other->height / rgba.height;
        if (other->pixel(column, row)[3] > 0) {
          std::fill_n(rgba.pixel(x, y), 4, 0.0f);
        }
      }
    }
  }
  return rgba;
}

glm::vec3 ColorOfBits(std::uint64_t bits)
{
  glm::vec3 color;
  for (int k = 0; k < 3; ++k) {
    color[k] = static_cast<float>(bits >> 8 * k & 255) / 255.0f;
  }
  return color;
}

PickedCells::PickedCells(const Image& rgba, const Image& depth, const glm::dmat4& clipToWorld,
                         const DrawnGrid& grid, const glm::dmat4& worldToIndex)
    : Rgba(rgba), Depth(depth)
{
  const int* extent = grid.image->GetExtent();
  for (int axis = 0; axis < 3; ++axis) {
    this->Low[axis] = extent[2 * axis] - grid.shift[axis];
    this->High[axis] = extent[2 * axis + 1] - grid.shift[axis];
    this->Cells[axis] = std::max(1, extent[2 * axis + 1] - extent[2 * axis]);
  }
  this->ClipToIndex = glm::inverse(PresentedToNative(grid)) * worldToIndex * clipToWorld;
}

std::int64_t PickedCells::last() const { return this->Cells.x * this->Cells.y * this->Cells.z - 1; }

glm::dvec3 PickedCells::at(double clipX, double clipY, double clipZ) const
{
  const glm::dvec4 place = this->ClipToIndex * glm::dvec4(clipX, clipY, clipZ, 1.0);
  return glm::dvec3(place) / place.w;
}

std::int64_t PickedCells::cellAt(int x, int y) const
{
  const double clipX = 2 * (x + 0.5) / this->Rgba.width - 1;
  const double clipY = 2 * (y + 0.5) / this->Rgba.height - 1;
  const double depth = *this->Depth.pixel(x, y);
  const glm::dvec3 place = depth < 1
                               ? this->at(clipX, clipY, 2 * depth - 1)
                               : MiddleInside(this->at(clipX, clipY, -1), this->at(clipX, clipY, 1),
                                              this->Low, this->High);
  const glm::dvec3 last(this->Cells - std::int64_t{1});
  const glm::i64vec3 cell(glm::clamp(glm::floor(place - this->Low), glm::dvec3(0.0), last));
  return cell.x + this->Cells.x * (cell.y + this->Cells.y * cell.z);
}

Image PickedCells::numbers(int shift) const
{
  return Painted(this->Rgba, [&](int x, int y, float* pixel) {
    const auto number = static_cast<std::uint64_t>(this->cellAt(x, y));
    const glm::vec3 color = ColorOfBits(number >> shift);
    std::copy_n(&color.x, 3, pixel);
  });
}

} // namespace inr

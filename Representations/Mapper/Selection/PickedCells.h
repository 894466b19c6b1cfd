// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Representations/Mapper/Scene/DrawnGrid.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// A picture of the volume as a selection buffer wants it: RGBA, opaque wherever `rgba` is not
/// transparent, and empty elsewhere.
Image PaintedWith(const glm::vec3& color, const Image& rgba);

/// A picture of RGBA without the pixels in which another one, over the same viewport, shows
/// anything.
Image WithoutWhatIsUnder(Image rgba, const std::vector<const Image*>& over);

/// The lowest 24 bits in red, green and blue, as selection buffers have them.
glm::vec3 ColorOfBits(std::uint64_t bits);

/// Which cells of the grid that stock filters see a picture shows: where a ray's opacity reaches
/// one half or, where it never does, half way through the volume.
class PickedCells
{
public:
  /// `depth`: of the picture, see Renderer::render. All must outlive this.
  PickedCells(const Image& rgba, const Image& depth, const glm::dmat4& clipToWorld,
              const DrawnGrid& grid, const glm::dmat4& worldToIndex);

  /// The largest number that a cell has.
  std::int64_t last() const;
  /// Bits `shift` to `shift` + 23 of the cells' numbers in red, green and blue.
  Image numbers(int shift) const;

private:
  std::int64_t cellAt(int x, int y) const;
  /// Continuous index in the presented grid.
  glm::dvec3 at(double clipX, double clipY, double clipZ) const;

  const Image& Rgba;
  const Image& Depth;
  glm::dmat4 ClipToIndex; ///< of the presented grid
  glm::dvec3 Low;         ///< its first and last points here
  glm::dvec3 High;
  glm::i64vec3 Cells; ///< along each axis, at least 1
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Rays/Ray.h"
#include "Core/Render/Scene/Cropping.h"

#include <algorithm>
#include <limits>

namespace inr {

/// Where a ray is cropped. Places count steps of t.
class CroppedWay
{
public:
  CroppedWay(const Cropping& cropping, const Ray& ray, double step)
  {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double plane : {cropping.low[axis], cropping.high[axis]}) {
        const double end = (plane - ray.entry[axis]) * ray.inverse[axis] / step;
        if (end > 0 && end * step < ray.length) { // and no ray along the plane
          this->Ends[this->Count++] = end;
        }
      }
    }
    std::sort(this->Ends, this->Ends + this->Count);
    double begin = 0;
    for (int k = 0; k <= this->Count; ++k) {
      const double end = k < this->Count ? this->Ends[k] : ray.length / step;
      this->Shown[k] = cropping.shows(ray.at(0.5 * (begin + end) * step));
      begin = end;
    }
    this->Ends[this->Count] = std::numeric_limits<double>::infinity();
  }

  bool shows(double place) const { return this->Shown[this->pieceOf(place)]; }
  /// Up to where what is said of `place` holds.
  double end(double place) const { return this->Ends[this->pieceOf(place)]; }

private:
  int pieceOf(double place) const
  {
    int piece = 0;
    while (piece < this->Count && place >= this->Ends[piece]) {
      ++piece;
    }
    return piece;
  }

  double Ends[7];
  bool Shown[7];
  int Count = 0;
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
//
// Where a ray crosses isosurfaces, by halving what it passed; the same for all backends.
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Marching/KnownValue.h"
#include "Core/Render/Scene/Isosurfaces.h"

#include <cmath>
#include <cstdint>

namespace inr {

/// A place between two others on a ray, in whatever unit these are, where the field takes a value.
struct SurfaceCrossing
{
  static constexpr int Halvings = 10;

  double low;
  double high;
  float value;
  bool rises; ///< the field, from low to high

  INR_HOST_DEVICE double middle() const { return 0.5 * (this->low + this->high); }
  /// To the half that it is in, when the field is `found` in the middle.
  INR_HOST_DEVICE void halve(float found)
  {
    ((found >= this->value) == this->rises ? this->high : this->low) = this->middle();
  }
};

/// A part of a ray, and the field's values at its ends. The search for the first surface in it may
/// have begun: that is then in front of `until`, after so many halvings.
struct SurfaceInterval
{
  double begin;
  double end;
  float first;
  float last;
  double until;
  std::int16_t halvings;

  INR_HOST_DEVICE bool rises() const { return this->first < this->last; }
  /// Only what is behind a place where it takes `value`.
  INR_HOST_DEVICE void cutBehind(double place, float value)
  {
    // A field that falls has passed the value when it is below.
    this->first = this->rises() ? value : std::nextafter(value, -static_cast<float>(Infinite));
    this->begin = place;
    this->halvings = 0;
  }
};

/// What a ray does behind a surface that it was to draw.
enum class BehindSurface {
  GoOn,
  End, ///< nothing behind it shows
  Wait ///< it could not be drawn yet
};

/// Where the first surface of `interval`, that of `value`, is; false where the ray waits. What was
/// looked at by then is not looked at again: a step of many bricks would never come to its end in a
/// cache of few.
template <class Look>
INR_HOST_DEVICE bool FindSurface(float value, SurfaceInterval& interval, const Look& look,
                                 double& place)
{
  const double high = interval.halvings > 0 ? interval.until : interval.end;
  SurfaceCrossing crossing{interval.begin, high, value, interval.rises()};
  for (; interval.halvings < SurfaceCrossing::Halvings; ++interval.halvings) {
    float found = 0;
    if (!look(crossing.middle(), found)) {
      return false;
    }
    crossing.halve(found);
    interval.begin = crossing.low;
    interval.until = crossing.high;
  }
  place = crossing.middle();
  return true;
}

/// Draws the surfaces in `interval` from front to back, as long as they show; see PassSurfaces.
/// `interval` is then what is behind the latest surface drawn.
template <class Look, class Draw>
INR_HOST_DEVICE bool DrawSurfaces(const SurfaceLookup& surfaces, SurfaceInterval& interval,
                                  const Look& look, const Draw& draw)
{
  const bool rises = interval.rises();
  const int last = surfaces.below(interval.last);
  for (int at = surfaces.below(interval.first); at != last; at += rises ? 1 : -1) {
    const float value = surfaces.values[rises ? at : at - 1];
    double place = 0;
    if (!FindSurface(value, interval, look, place)) {
      return false;
    }
    const BehindSurface behind = draw(value, place);
    if (behind != BehindSurface::GoOn) {
      return behind == BehindSurface::End;
    }
    interval.cutBehind(place, value);
  }
  return true;
}

/// Draws the surfaces of a ray from place `begin` on to `end`, where `level` has the value `last`,
/// or of what is left of that since the ray waited: `known` says how far it had come.
/// `look(place, value)`: the field there, false where the ray waits for that; `draw(value, place)`:
/// see BehindSurface. False when the ray waits.
template <class Look, class Draw>
INR_HOST_DEVICE bool PassSurfaces(const SurfaceLookup& surfaces, int level, double begin,
                                  double end, float last, KnownValue& known, const Look& look,
                                  const Draw& draw)
{
  if (known.at < begin || known.level != level) {
    const double place = known.at < begin ? begin : known.at;
    float value = 0;
    if (!look(place, value)) {
      return false;
    }
    known = {place, value, static_cast<std::int16_t>(level)};
  }
  SurfaceInterval passed{known.at, end, known.value, last, known.until, known.halvings};
  const bool done = DrawSurfaces(surfaces, passed, look, draw);
  known = {passed.begin, passed.first, known.level, passed.halvings, passed.until};
  return done;
}

} // namespace inr

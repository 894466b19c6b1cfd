// SPDX-License-Identifier: BSD-3-Clause
//
// A ray through the cache of which both ends of samples are looked at, for isosurfaces and for
// colours of all values in between; Core's CachedSurfaces and CachedIntegration do the same.
#pragma once

#include "CUDA/Render/Kernels/RayMarch.h"
#include "Core/Render/Marching/KnownValue.h"
#include "Core/Render/Marching/PreIntegratedColors.h"
#include "Core/Render/Marching/SurfaceCrossings.h"

namespace inr {
namespace cuda {

class EndsMarch : public RayMarch
{
public:
  struct Progress : RayProgress
  {
    KnownValue known; ///< the latest
  };

  INR_HOST_DEVICE EndsMarch(const RenderScene& scene, const CacheView& cache, OnMiss onMiss,
                            const Ray& way, int x, int y, Progress& progress)
      : RayMarch(scene, cache, onMiss, way, x, y, progress), Known(progress.known)
  {}
  INR_HOST_DEVICE static void beginPart(Progress& progress)
  {
    RayMarch::beginPart(progress);
    progress.known = {};
  }

  /// See RayMarch.
  INR_HOST_DEVICE bool advance()
  {
    while (!this->isDone() && this->moveOn()) {
      if (!this->takeNext()) {
        this->stop();
        return false;
      }
    }
    return true;
  }

private:
  /// A sample, and the brick that it is read from.
  struct Taken
  {
    const BrickReader& reader;
    float value;
  };

  /// False where it, or what is looked at for it, waits for a brick: then nothing has changed, but
  /// that surfaces in front of it may be drawn, and the search for the next one begun.
  INR_HOST_DEVICE bool takeNext()
  {
    const bool finds = this->Scene.settings.projector.findsSurfaces();
    const LevelOfDetail& detail = this->Samples.detail();
    // A surface would be torn where one sample is of this and the next of that level.
    const std::int64_t counter = finds ? 0 : this->Samples.next();
    const int level = detail.isDithered() ? this->levelAt(0, counter) : detail.level();
    this->Coarser = static_cast<std::uint64_t>(level - detail.level());
    if (!this->open(level)) {
      return false;
    }
    const BrickReader& reader = this->readerOf(0);
    const float found = ValueOn(this->Cache, reader.path(), this->alongOf(reader, 0));
    Taken taken{reader, found};
    ClampToRange(this->rangeOf(reader), taken.value);
    const float through = this->State.light.through();
    this->ProbeMissed = false;
    if (!(finds ? this->crossSurfaces(taken) : this->integrate(taken))) {
      return false;
    }
    this->count(reader, 1, through);
    this->Counts.missed += this->ProbeMissed && reader.exact() ? 1 : 0; // as a whole, once
    this->Counts.clamped += std::abs(found - taken.value) > RoundingOfStorage ? 1 : 0;
    this->pass(1);
    return true;
  }

  /// The value at a place as `level` has it; false where the ray waits for that.
  INR_HOST_DEVICE bool probe(int level, double place, float& value)
  {
    this->Probe = BrickReader(); // places may fall
    if (!this->Probe.open(this->Cache, this->Way, level, place, this->Scene.settings.step,
                          this->Missing)) {
      this->Cache.request(this->Probe.wish(), 1.0f);
      return false;
    }
    if (!this->Probe.exact()) {
      this->ProbeMissed = true;
      this->Cache.request(this->Probe.wish(), this->State.light.through());
    }
    value = ValueOn(this->Cache, this->Probe.path(), this->Probe.along(place));
    return true;
  }

  /// The colours of all values since the sample before.
  INR_HOST_DEVICE bool integrate(const Taken& taken)
  {
    const std::int64_t interval = this->Samples.next();
    float begin = this->Known.value;
    if (interval >= 0 && this->Known.at != static_cast<double>(interval) &&
        !this->probe(taken.reader.servedLevel(), static_cast<double>(interval), begin)) {
      return false;
    }
    glm::vec4 color(0.0f);
    if (interval >= 0) { // else it is in front of the ray
      color = this->Scene.settings.preIntegrated->between(begin, taken.value);
    }
    if (color.w > 0.0f) {
      const double steps =
          this->Alike.last ? this->Samples.rest() : static_cast<double>(this->Alike.steps());
      const MarchSettings& settings = this->Scene.settings;
      const auto length = static_cast<float>(steps * settings.step * settings.unitsPerT);
      const float along = this->alongOf(taken.reader, 0);
      if (this->Scene.lit && !this->shade(taken.reader, along, this->at(0), color)) {
        return false;
      }
      this->addLight(color, OpacityOver(length, color.w), 0);
    } else {
      this->State.light.count();
    }
    this->Known = {static_cast<double>(interval + this->Alike.steps()), taken.value};
    return true;
  }

  INR_HOST_DEVICE bool crossSurfaces(const Taken& taken)
  {
    const std::int64_t interval = this->Samples.next();
    const int level = taken.reader.servedLevel();
    const auto look = [&](double place, float& value) { return this->probe(level, place, value); };
    const auto draw = [&](float value, double place) {
      if (!this->drawSurface(level, value, place)) {
        return BehindSurface::Wait;
      }
      return this->State.light.isOpaque() ? BehindSurface::End : BehindSurface::GoOn;
    };
    if (interval >= 0 && // else nothing is in front of it
        !PassSurfaces(this->Scene.settings.projector.surfaces, level, static_cast<double>(interval),
                      this->placeOf(0), taken.value, this->Known, look, draw)) {
      return false;
    }
    this->State.light.count();
    this->Known = {static_cast<double>(interval + this->Alike.steps()), taken.value,
                   static_cast<std::int16_t>(level)};
    return true;
  }

  INR_HOST_DEVICE bool drawSurface(int level, float value, double place)
  {
    const double t = place * this->Scene.settings.step;
    if (!this->Way.isInPiece(t)) {
      return true; // that of another picture finds it, too, from the same samples
    }
    glm::vec4 color = this->Scene.colors.at(value);
    if (this->Scene.lit) {
      float found = 0;
      if (!this->probe(level, place, found) ||
          !this->shade(this->Probe, this->Probe.along(place), t, color)) {
        return false;
      }
    }
    this->State.light.addMore(color, color.w);
    this->noteHalfOpaque(t);
    return true;
  }

  KnownValue& Known;
  BrickReader Probe;
  bool ProbeMissed = false; ///< something that the present sample looked at was a coarser level's
};

} // namespace cuda
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
//
// One ray through the cache by one thread: where samples are is Core's SampleWalker, what they are
// read from a BrickReader. Core's CachedMarcher does the same by the vector, and comes to the same
// picture but for rounding.
#pragma once

#include "CUDA/Render/Kernels/BrickGradient.h"
#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/StepTable.h"

namespace inr {
namespace cuda {

/// Where a ray stands, as long as it waits.
struct RayProgress
{
  std::int64_t interval = -1; ///< of the next sample; -1: the ray has not begun
  SampleStretch stretch;      ///< that it belongs to
  double rgb[3] = {};         ///< premultiplied, so far
  double transmittance = 1;
  double halfOpaqueAt = -1; ///< t where opacity reached one half; -1 = not yet
  Projection projection;    ///< instead, of values that are projected
  std::int64_t samples = 0;
  std::int64_t levels = 0; ///< that these came from, summed up
};

/// What happened while a ray came further.
struct RayCounts
{
  std::uint32_t rays = 0; ///< 1 where it began, and meets the volume
  std::uint32_t samples = 0;
  std::uint32_t missed = 0;
  std::uint32_t clamped = 0;
  std::uint32_t gradients = 0;
  std::uint32_t scatterings = 0; ///< of paths that ended
  std::uint32_t lightSteps = 0;  ///< samples of these on the way to a light
  std::uint32_t levels = 0;      ///< a bit for each that samples came from
};

/// A ray while a thread has it.
class RayMarch
{
public:
  INR_HOST_DEVICE RayMarch(const RenderScene& scene, const CacheView& cache, OnMiss onMiss, int x,
                           int y, RayProgress& progress)
      : Scene(scene), Cache(cache), Missing(onMiss), Way(scene.rays.ray(x, y)),
        Stream(scene.streams.at(x, y)),
        Samples(scene.majorants, scene.settings, this->Way, scene.levelOfDetailScale,
                cache.hierarchy.levels(), JitterOf(scene.settings, this->Stream)),
        State(progress)
  {
    if (progress.interval >= 0) {
      this->Samples.resume(progress.interval, progress.stretch, scene.settings);
    } else {
      this->Counts.rays = this->Way.length > 0 ? 1 : 0;
    }
    if (scene.lit) {
      this->ToEye = scene.shading.toEye(this->Way);
    }
  }

  /// What keeps a ray from going on.
  enum class Outcome {
    Ends,
    Waits, ///< for a brick
    Pauses ///< as it has come past as many samples as it may
  };

  /// Goes on, for `most` samples at the most. Of a ray that has not ended the progress says where.
  INR_HOST_DEVICE Outcome advance(int most)
  {
    const MarchSettings& settings = this->Scene.settings;
    while (this->Samples.moveToVisible(settings)) {
      const AlikeSamples alike = this->Samples.alike();
      if (settings.projector.canSkip(this->State.projection, this->Samples.stretch().range)) {
        this->Samples.pass(alike, alike.count);
        continue;
      }
      const Outcome outcome = this->takeAll(alike, most);
      if (outcome != Outcome::Ends || this->isDone() || alike.last) {
        return outcome;
      }
    }
    return Outcome::Ends;
  }

  INR_HOST_DEVICE const RayCounts& counts() const { return this->Counts; }

  /// Of a ray at its end.
  INR_HOST_DEVICE void write(const PictureView& picture, std::int64_t pixel)
  {
    this->finishProjection();
    glm::vec4 color(0.0f);
    for (int channel = 0; channel < 3; ++channel) {
      color[channel] = static_cast<float>(this->State.rgb[channel]);
    }
    color[3] = static_cast<float>(1.0 - this->State.transmittance);
    reinterpret_cast<glm::vec4*>(picture.rgba)[pixel] = color;
    const double at = this->State.halfOpaqueAt;
    picture.depth[pixel] =
        at >= 0 ? static_cast<float>(this->Scene.rays.windowDepth(this->Way.at(at))) : 1.0f;
    const auto count = static_cast<double>(this->State.samples);
    picture.samples[2 * pixel] = static_cast<float>(count);
    picture.samples[2 * pixel + 1] =
        count > 0 ? static_cast<float>(static_cast<double>(this->State.levels) / count) : -1.0f;
  }

private:
  INR_HOST_DEVICE bool isDone() const
  {
    return this->State.transmittance <= OpaqueTransmittance ||
           this->Scene.settings.projector.isFinal(this->State.projection);
  }

  /// Takes such samples until all are past or something keeps it from going on.
  INR_HOST_DEVICE Outcome takeAll(const AlikeSamples& alike, int most)
  {
    Outcome outcome = Outcome::Ends;
    int taken = 0;
    while (taken < alike.count && !this->isDone()) {
      if (static_cast<int>(this->Counts.samples) >= most) {
        outcome = Outcome::Pauses;
        break;
      }
      if (!this->take(alike, taken)) {
        outcome = Outcome::Waits;
        break;
      }
      ++taken;
    }
    this->Samples.pass(alike, taken);
    if (outcome != Outcome::Ends) {
      this->State.interval = this->Samples.next();
      this->State.stretch = this->Samples.stretch();
    }
    return outcome;
  }

  /// A sample, number k of those that are alike. False where it waits for a brick.
  INR_HOST_DEVICE bool take(const AlikeSamples& alike, int k)
  {
    const MarchSettings& settings = this->Scene.settings;
    const std::int64_t interval = this->Samples.next() + k * alike.steps();
    const double place = static_cast<double>(interval) + this->Samples.offset(alike);
    const double t = glm::min(place * settings.step, this->Way.length);
    if (settings.crops && !settings.cropping.shows(this->Way.at(t))) {
      return true;
    }
    const int level = this->levelAt(interval, place);
    BrickReader& reader = this->Readers[level & 1];
    if (!reader.covers(level, place) &&
        !reader.open(this->Cache, this->Way, level, place, settings.step, this->Missing)) {
      this->Cache.request(reader.wish(), 1.0f);
      return false;
    }
    const float along = reader.along(static_cast<double>(interval)) +
                        static_cast<float>(this->Samples.offset(alike));
    if (!this->add(alike, reader, along, t)) {
      return false;
    }
    this->count(reader);
    return true;
  }

  /// The level of the cache that a sample is from.
  INR_HOST_DEVICE int levelAt(std::int64_t interval, double place) const
  {
    const LevelOfDetail& detail = this->Samples.detail();
    if (!detail.isDithered()) {
      return detail.level();
    }
    const double fraction =
        detail.fractionAtEntry() + detail.fractionGrowth() * this->Scene.settings.step * place;
    const float random =
        RandomUnit32(DitherSeed(this->Stream), static_cast<std::uint32_t>(interval));
    return detail.level() + (random < static_cast<float>(fraction) ? 1 : 0);
  }

  INR_HOST_DEVICE void count(const BrickReader& reader)
  {
    ++this->Counts.samples;
    ++this->State.samples;
    this->State.levels += reader.servedLevel();
    this->Counts.levels |= 1u << reader.servedLevel();
    if (!reader.exact()) {
      ++this->Counts.missed;
      this->Cache.request(reader.wish(), static_cast<float>(this->State.transmittance));
    }
  }

  /// What the sample is worth; false where its gradient waits for a brick.
  INR_HOST_DEVICE bool add(const AlikeSamples& alike, const BrickReader& reader, float along,
                           double t)
  {
    const MarchSettings& settings = this->Scene.settings;
    const float found = ValueOn(this->Cache, reader.path(), along);
    float value = found;
    ClampToRange(reader.exact() ? this->Samples.stretch().range : ValueRange{0.0f, 1.0f}, value);
    const double steps = alike.last ? this->Samples.rest() : static_cast<double>(alike.steps());
    const double length = steps * settings.step * settings.unitsPerT;
    if (settings.projector.projects()) {
      settings.projector.add(this->Scene.colors, value, length, t, this->State.projection);
    } else if (this->Scene.lit) {
      if (!this->addLit(reader, along, value, static_cast<float>(length), t)) {
        return false;
      }
    } else if (alike.last) {
      const glm::vec4 color = this->Scene.colors.at(value);
      this->addLight(color, OpacityOver(static_cast<float>(length), color.w), t);
    } else {
      const float place =
          this->Scene.colors.logarithmic ? this->Scene.colors.coordinate(value) : value;
      const glm::vec4 color =
          SampleColor(this->Scene.steps, LengthOf(alike.joined, alike.power), place);
      this->addLight(color, color.w, t);
    }
    this->Counts.clamped += std::abs(found - value) > RoundingOfStorage ? 1 : 0;
    return true;
  }

  INR_HOST_DEVICE bool addLit(const BrickReader& reader, float along, float value, float length,
                              double t)
  {
    glm::vec4 color = this->Scene.colors.at(value);
    if (color.w <= 0.0f) {
      return true;
    }
    GradientFinder finder(this->Cache, reader, along, this->Missing,
                          static_cast<float>(this->State.transmittance));
    glm::vec3 gradient(0.0f);
    if (!finder.find(gradient)) {
      return false;
    }
    ++this->Counts.gradients;
    this->Counts.missed += static_cast<std::uint32_t>(finder.missed());
    const glm::vec3 lit =
        this->Scene.shading.shade(glm::vec3(color), this->ToEye, this->Way.at(t), gradient);
    this->addLight(glm::vec4(lit, color.w), OpacityOver(length, color.w), t);
    return true;
  }

  INR_HOST_DEVICE void addLight(const glm::vec4& color, float opacity, double t)
  {
    const double weight = this->State.transmittance * opacity;
    for (int channel = 0; channel < 3; ++channel) {
      this->State.rgb[channel] += weight * color[channel];
    }
    this->State.transmittance -= weight;
    if (this->State.halfOpaqueAt < 0 && this->State.transmittance <= 0.5) {
      this->State.halfOpaqueAt = t;
    }
  }

  INR_HOST_DEVICE void finishProjection()
  {
    const Projector& projector = this->Scene.settings.projector;
    if (!projector.projects() || !(this->Way.length > 0)) {
      return;
    }
    const glm::vec4 color = projector.color(this->Scene.colors, this->State.projection);
    for (int channel = 0; channel < 3; ++channel) {
      this->State.rgb[channel] = color[channel];
    }
    this->State.transmittance = 1.0f - color.w;
    this->State.halfOpaqueAt = color.w >= 0.5f ? this->State.projection.at : -1.0;
  }

  const RenderScene& Scene;
  const CacheView& Cache;
  OnMiss Missing;
  Ray Way;
  std::uint64_t Stream; ///< of random numbers
  SampleWalker Samples;
  BrickReader Readers[2]; ///< of even and of odd levels: dithering alternates between neighbours
  RayProgress& State;
  RayCounts Counts;
  glm::dvec3 ToEye{0.0};
};

} // namespace cuda
} // namespace inr

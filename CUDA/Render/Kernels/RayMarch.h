// SPDX-License-Identifier: BSD-3-Clause
//
// One ray through the cache by one thread: where samples are is Core's SampleWalker, what they are
// read from a BrickReader. Core's CachedMarcher does the same by the vector, and comes to the same
// picture but for rounding.
#pragma once

#include "CUDA/Render/Kernels/BrickGradient.h"
#include "CUDA/Render/Kernels/CompositeSamples.h"
#include "CUDA/Render/Kernels/RayCounts.h"
#include "Core/Render/Marching/StepLattice.h"
#include "Core/Render/Marching/StepTable.h"

#include <cstdint>
#include <limits>

namespace inr {
namespace cuda {

/// Where a ray stands, as long as it waits.
struct RayProgress
{
  static constexpr std::int64_t NotBegun = std::numeric_limits<std::int64_t>::min();

  std::int64_t interval = NotBegun; ///< of the next sample
  SampleStretch stretch;            ///< that it belongs to
  GatheredLight light;
  double halfOpaqueAt = -1; ///< t where opacity reached one half; -1 = not yet
  Projection projection;    ///< instead, of values that are projected
  std::int64_t levels = 0;  ///< that samples came from, summed up
};

/// How many samples a ray has taken, and the mean of the levels that they came from.
INR_HOST_DEVICE inline void WriteSamples(const RayProgress& ray, const PictureView& picture,
                                         std::int64_t pixel)
{
  const auto count = static_cast<double>(ray.light.samples());
  picture.samples[2 * pixel] = static_cast<float>(count);
  picture.samples[2 * pixel + 1] =
      count > 0 ? static_cast<float>(static_cast<double>(ray.levels) / count) : -1.0f;
}

/// A ray while a thread has it. It comes from stretch to stretch, within one from brick to brick,
/// and within a brick by a few samples at once: so the threads of a warp, whose rays meet all that
/// at about the same samples, do each of it together.
class RayMarch
{
public:
  using Progress = RayProgress;
  /// For the next part of the ray's way.
  INR_HOST_DEVICE static void beginPart(RayProgress& progress)
  {
    progress.interval = RayProgress::NotBegun;
  }

  /// `way`: the ray through pixel (x, y), or a part of it.
  INR_HOST_DEVICE RayMarch(const RenderScene& scene, const CacheView& cache, OnMiss onMiss,
                           const Ray& way, int x, int y, RayProgress& progress)
      : Scene(scene), Cache(cache), Missing(onMiss), Way(way), Stream(scene.streams.at(x, y)),
        Samples(scene.majorants, scene.settings, this->Way, scene.levelOfDetailScale,
                cache.hierarchy.levels(), JitterOf(scene.settings, this->Stream)),
        State(progress)
  {
    if (progress.interval != RayProgress::NotBegun) {
      this->Samples.resume(progress.interval, progress.stretch, scene.settings);
    }
    if (scene.lit) {
      this->ToEye = scene.shading.toEye(this->Way);
    }
  }

  /// Goes on until the ray ends, or waits for a brick: false, and the progress says where.
  INR_HOST_DEVICE bool advance()
  {
    while (!this->isDone() && this->moveOn()) {
      if (!this->takeSome()) {
        this->stop();
        return false;
      }
    }
    return true;
  }

  INR_HOST_DEVICE const RayCounts& counts() const { return this->Counts; }

  /// Of a ray at its end.
  INR_HOST_DEVICE void write(const PictureView& picture, std::int64_t pixel)
  {
    glm::dvec4 light = this->State.light.sum();
    double at = this->State.halfOpaqueAt;
    this->finishProjection(light, at);
    reinterpret_cast<glm::vec4*>(picture.rgba)[pixel] =
        glm::vec4(glm::dvec4(glm::dvec3(light), 1.0 - light.w));
    picture.depth[pixel] =
        at >= 0 ? static_cast<float>(this->Scene.rays.windowDepth(this->Way.at(at))) : 1.0f;
    WriteSamples(this->State, picture, pixel);
  }

protected:
  /// Notes where the ray waits.
  INR_HOST_DEVICE void stop()
  {
    this->State.interval = this->Samples.next();
    this->State.stretch = this->Samples.stretch();
  }

  /// Samples that are taken together, from one brick or two: of more, other threads that have fewer
  /// would wait for too long.
  static constexpr int MostOfOne = 64;
  static constexpr int MostOfTwo = 16;

  INR_HOST_DEVICE bool isDone() const
  {
    return this->State.light.isOpaque() ||
           this->Scene.settings.projector.isFinal(this->State.projection);
  }

  /// To the next sample that is to be taken; false where there is none.
  INR_HOST_DEVICE bool moveOn()
  {
    const MarchSettings& settings = this->Scene.settings;
    while (this->Alike.count > 0 || this->Samples.moveToVisible(settings)) {
      if (this->Alike.count == 0) {
        this->Alike = this->Samples.alike();
        if (settings.projector.canSkip(this->State.projection, this->Samples.stretch().range)) {
          this->pass(this->Alike.count);
          continue;
        }
      }
      if (this->shows(0)) {
        return true;
      }
      this->pass(1);
    }
    return false;
  }

  INR_HOST_DEVICE void pass(int count)
  {
    this->Samples.pass(this->Alike, count);
    this->Alike.count -= count;
  }

  INR_HOST_DEVICE std::int64_t intervalOf(int k) const
  {
    return this->Samples.next() + k * this->Alike.steps();
  }
  INR_HOST_DEVICE double placeOf(int k) const
  {
    return static_cast<double>(this->intervalOf(k)) + this->Samples.offset(this->Alike);
  }
  /// t of number k of the samples that are alike.
  INR_HOST_DEVICE double at(int k) const
  {
    return glm::min(this->placeOf(k) * this->Scene.settings.step, this->Way.length);
  }
  /// Whether it is not cropped.
  INR_HOST_DEVICE bool shows(int k) const
  {
    const MarchSettings& settings = this->Scene.settings;
    return !settings.crops || settings.cropping.shows(this->Way.at(this->at(k)));
  }

  /// Takes samples that are alike, as many as are read from the same brick, or where levels are
  /// mixed the same two, and at most as many as others have patience for. False where one waits for
  /// a brick.
  INR_HOST_DEVICE bool takeSome()
  {
    const bool mixes = this->Samples.detail().isDithered();
    const int most = glm::min(this->Alike.count, mixes ? MostOfTwo : MostOfOne);
    const int count = mixes ? this->openTwo(most) : this->openOne(most);
    const bool composites = !this->Scene.lit && !this->Scene.settings.projector.projects() &&
                            !this->Scene.settings.crops && !this->Alike.last;
    const int taken = !composites ? this->takeOneByOne(count)
                      : mixes     ? this->takeFromTwo(count)
                                  : this->takeFromOne(count);
    this->pass(taken);
    return taken > 0 && (taken == count || this->isDone());
  }

  /// How many samples, from the first one on, are in the brick of that one; 0 where it waits.
  INR_HOST_DEVICE int openOne(int most)
  {
    const int level = this->Samples.detail().level();
    this->Coarser = 0;
    return this->open(level) ? glm::max(1, this->covered(level, most)) : 0;
  }

  /// The same where levels are mixed, of two bricks: up to where one of them is needed that is not
  /// open. Tells in Coarser which samples are from the coarser level.
  INR_HOST_DEVICE int openTwo(int most)
  {
    const int finer = this->Samples.detail().level();
    this->Coarser = 0;
    if (!this->open(this->levelAt(0))) {
      return 0;
    }
    const int inFiner = this->covered(finer, most);
    const int inCoarser = this->covered(finer + 1, most);
    int count = 0;
    while (count < most) {
      const int above = this->levelAt(count) - finer;
      if (count > 0 && count >= (above > 0 ? inCoarser : inFiner)) {
        break;
      }
      this->Coarser |= static_cast<std::uint64_t>(above) << count;
      ++count;
    }
    return count;
  }

  /// Sees to it that the brick is open that the first sample is read from, of `level`; false where
  /// it waits for it.
  INR_HOST_DEVICE bool open(int level)
  {
    BrickReader& reader = this->Readers[level & 1];
    if (this->covered(level, 1) > 0 || reader.open(this->Cache, this->Way, level, this->placeOf(0),
                                                   this->Scene.settings.step, this->Missing)) {
      return true;
    }
    this->Cache.request(reader.wish(), 1.0f);
    return false;
  }

  /// How many samples, from the first one on, are in the brick of `level` that is open.
  INR_HOST_DEVICE int covered(int level, int most) const
  {
    // None are joined, or two or four; or three, of which there is one.
    const double perSample = PowerOfTwo(-this->Alike.power) *
                             static_cast<double>(1.0f / static_cast<float>(this->Alike.joined));
    return this->Readers[level & 1].covered(level, this->placeOf(0), perSample, most);
  }

  /// The level of the cache that sample k is from.
  INR_HOST_DEVICE int levelAt(int k) const { return this->levelAt(k, this->intervalOf(k)); }
  /// The same by a number that chooses between the two.
  INR_HOST_DEVICE int levelAt(int k, std::int64_t counter) const
  {
    const LevelOfDetail& detail = this->Samples.detail();
    const double fraction = detail.fractionAtEntry() +
                            detail.fractionGrowth() * this->Scene.settings.step * this->placeOf(k);
    const float random =
        RandomUnit32(DitherSeed(this->Stream), static_cast<std::uint32_t>(counter));
    return detail.level() + (random < static_cast<float>(fraction) ? 1 : 0);
  }

  /// Whether sample k is from the coarser one of two levels that are mixed.
  INR_HOST_DEVICE int isCoarser(int k) const { return static_cast<int>(this->Coarser >> k & 1); }
  INR_HOST_DEVICE const BrickReader& readerOf(int k) const
  {
    return this->Readers[(this->Samples.detail().level() + this->isCoarser(k)) & 1];
  }

  INR_HOST_DEVICE int takeFromOne(int count)
  {
    return this->composite(count, OneBrick{this->sampled(this->readerOf(0))});
  }
  INR_HOST_DEVICE int takeFromTwo(int count)
  {
    const int finer = this->Samples.detail().level();
    return this->composite(count, TwoBricks{{this->sampled(this->Readers[finer & 1]),
                                             this->sampled(this->Readers[(finer + 1) & 1])},
                                            static_cast<std::uint32_t>(this->Coarser)});
  }

  /// From the next sample on.
  INR_HOST_DEVICE SampledBrick sampled(const BrickReader& reader) const
  {
    return {reader.path(), reader.along(static_cast<double>(this->Samples.next())),
            this->rangeOf(reader)};
  }
  INR_HOST_DEVICE float spacing() const { return static_cast<float>(this->Alike.steps()); }
  INR_HOST_DEVICE float offset() const
  {
    return static_cast<float>(this->Samples.offset(this->Alike));
  }

  template <class Bricks> INR_HOST_DEVICE int composite(int count, const Bricks& bricks)
  {
    const AlikeRow row{count, this->spacing(), this->offset(),
                       LengthOf(this->Alike.joined, this->Alike.power)};
    CompositedRow sum{this->State.light, this->State.halfOpaqueAt >= 0};
    RowCompositor<Bricks>(this->Cache, this->Scene, row, bricks).add(sum);
    if (sum.halfOpaque && this->State.halfOpaqueAt < 0) {
      this->State.halfOpaqueAt = this->at(sum.halfOpaqueAt);
    }
    this->State.light = sum.light;
    this->Counts.clamped += sum.clamped;
    const int finer = this->Samples.detail().level();
    for (int k = 0; k < 2; ++k) {
      this->count(this->Readers[(finer + k) & 1], sum.taken[k], sum.seen[k]);
    }
    return sum.count();
  }

  /// Where sample k is on its path.
  INR_HOST_DEVICE float alongOf(const BrickReader& reader, int k) const
  {
    return (reader.along(static_cast<double>(this->Samples.next())) +
            static_cast<float>(k) * this->spacing()) +
           this->offset();
  }
  /// That a value which is read there can have.
  INR_HOST_DEVICE ValueRange rangeOf(const BrickReader& reader) const
  {
    return reader.exact() ? this->Samples.stretch().range : ValueRange{0.0f, 1.0f};
  }

  /// Samples that were read from the same brick. `light`: let through by each, summed up.
  INR_HOST_DEVICE void count(const BrickReader& reader, int samples, float light)
  {
    if (samples == 0) {
      return;
    }
    this->State.levels += std::int64_t{reader.servedLevel()} * samples;
    this->Counts.samples += static_cast<std::uint32_t>(samples);
    this->Counts.levels |= 1u << reader.servedLevel();
    if (!reader.exact()) {
      this->Counts.missed += static_cast<std::uint32_t>(samples);
      this->Cache.request(reader.wish(), light);
    }
  }

  /// The same where more is done with values than look up their light. Returns less than `count`
  /// where nothing more is needed, or where a gradient waits for a brick.
  INR_HOST_DEVICE int takeOneByOne(int count)
  {
    int taken = 0;
    while (taken < count && !this->isDone()) {
      if (this->shows(taken)) {
        const BrickReader& reader = this->readerOf(taken);
        if (!this->add(reader, taken)) {
          break;
        }
        this->count(reader, 1, this->State.light.through());
      }
      ++taken;
    }
    return taken;
  }

  /// What sample k is worth; false where its gradient waits for a brick.
  INR_HOST_DEVICE bool add(const BrickReader& reader, int k)
  {
    const MarchSettings& settings = this->Scene.settings;
    const float along = this->alongOf(reader, k);
    const float found = ValueOn(this->Cache, reader.path(), along);
    float value = found;
    ClampToRange(this->rangeOf(reader), value);
    const double steps =
        this->Alike.last ? this->Samples.rest() : static_cast<double>(this->Alike.steps());
    const double length = steps * settings.step * settings.unitsPerT;
    if (settings.projector.projects()) {
      settings.projector.add(this->Scene.colors, value, length, this->at(k),
                             this->State.projection);
      this->State.light.count();
    } else if (this->Scene.lit) {
      if (!this->addLit(reader, k, value, static_cast<float>(length))) {
        return false;
      }
    } else if (this->Alike.last) {
      const glm::vec4 color = this->Scene.colors.at(value);
      this->addLight(color, OpacityOver(static_cast<float>(length), color.w), k);
    } else {
      const float place =
          this->Scene.colors.logarithmic ? this->Scene.colors.coordinate(value) : value;
      const int number = LengthOf(this->Alike.joined, this->Alike.power);
      const glm::vec4 color =
          FindColor(this->Scene.steps, number, place).color(UnitsOf(this->Scene.steps, number));
      this->addLight(color, color.w, k);
    }
    this->Counts.clamped += std::abs(found - value) > RoundingOfStorage ? 1 : 0;
    return true;
  }

  INR_HOST_DEVICE bool addLit(const BrickReader& reader, int k, float value, float length)
  {
    glm::vec4 color = this->Scene.colors.at(value);
    if (color.w <= 0.0f) {
      this->State.light.count();
      return true;
    }
    if (!this->shade(reader, this->alongOf(reader, k), this->at(k), color)) {
      return false;
    }
    this->addLight(color, OpacityOver(length, color.w), k);
    return true;
  }

  /// Lights what is at t, `along` a reader's path; false where the gradient waits for a brick.
  INR_HOST_DEVICE bool shade(const BrickReader& reader, float along, double t, glm::vec4& color)
  {
    GradientFinder finder(this->Cache, reader, along, this->Missing, this->State.light.through());
    glm::vec3 gradient(0.0f);
    if (!finder.find(gradient)) {
      return false;
    }
    ++this->Counts.gradients;
    this->Counts.missed += static_cast<std::uint32_t>(finder.missed());
    const glm::vec3 lit =
        this->Scene.shading.shade(glm::vec3(color), this->ToEye, this->Way.at(t), gradient);
    color = glm::vec4(lit, color.w);
    return true;
  }

  /// From sample k.
  INR_HOST_DEVICE void addLight(const glm::vec4& color, float opacity, int k)
  {
    this->State.light.add(color, opacity);
    this->noteHalfOpaque(this->at(k));
  }
  INR_HOST_DEVICE void noteHalfOpaque(double t)
  {
    if (this->State.light.isHalfOpaque() && this->State.halfOpaqueAt < 0) {
      this->State.halfOpaqueAt = t;
    }
  }

  INR_HOST_DEVICE void finishProjection(glm::dvec4& light, double& at) const
  {
    const Projector& projector = this->Scene.settings.projector;
    if (projector.projects() && this->Way.length > 0) {
      const glm::vec4 color = projector.color(this->Scene.colors, this->State.projection);
      light = glm::dvec4(glm::vec3(color), 1.0f - color.w);
      at = color.w >= 0.5f ? this->State.projection.at : -1.0;
    }
  }

  const RenderScene& Scene;
  const CacheView& Cache;
  OnMiss Missing;
  Ray Way;
  std::uint64_t Stream; ///< of random numbers
  SampleWalker Samples;
  AlikeSamples Alike{0, 1, 0, false}; ///< that come next
  BrickReader Readers[2];             ///< of even and of odd levels, as these are mixed in pairs
  std::uint64_t Coarser = 0;          ///< bit k: whether sample k is from the coarser of a pair
  RayProgress& State;
  RayCounts Counts;
  glm::dvec3 ToEye{0.0};
};

} // namespace cuda
} // namespace inr

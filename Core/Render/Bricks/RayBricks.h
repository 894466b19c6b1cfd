// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/BrickRun.h"
#include "Core/Render/Bricks/BrickWay.h"
#include "Core/Render/Bricks/CachedScene.h"
#include "Core/Render/Bricks/MarchNotes.h"
#include "Core/Render/Bricks/OnMiss.h"
#include "Core/Render/Rays/LevelOfDetail.h"
#include "Core/Render/Rays/Ray.h"

#include <cstdint>
#include <optional>

namespace inr {

/// The bricks that samples are read from, of the finer level and of the coarser one, which may be
/// the same; null where the ray has to wait.
struct RunPair
{
  BrickRun* fine;
  BrickRun* coarse;
};

/// Finds the bricks that the samples of one ray after another are read from, or what is there
/// instead, and notes which are used, and which are wished for.
class RayBricks
{
public:
  /// The references must outlive it.
  RayBricks(const CachedScene& scene, OnMiss onMiss, MarchNotes& notes)
      : Scene(scene), Missing(onMiss), Notes(notes)
  {}

  /// Another ray is next, another part of its way, or one that has waited.
  void begin();
  /// Another batch is: no brick is in it.
  void leaveBatch();
  /// Those of a sample; places do not fall from call to call.
  RunPair at(const Ray& ray, const LevelOfDetail& detail, float transmittance, double place)
  {
    BrickRun* const fine = this->runFor(ray, transmittance, detail.level(), place);
    return {fine, detail.isDithered() ? this->runFor(ray, transmittance, detail.level() + 1, place)
                                      : fine};
  }
  /// The ray turns back, and waits for something nearer than what was not there.
  void turnBack() { this->Awaited.reset(); }
  /// Notes what the ray has used, of which so much light comes through, and what it waits for.
  void finish(float transmittance, bool isEnded);

private:
  BrickRun* runFor(const Ray& ray, float transmittance, int level, double place)
  {
    BrickRun& run = this->Runs[level & 1];
    return run.covers(level, place) || this->reopen(run, ray, transmittance, level, place)
               ? &run
               : nullptr;
  }
  bool reopen(BrickRun& run, const Ray& ray, float transmittance, int level, double place);
  /// With what is there instead of a brick that is not: the slot.
  std::int32_t openCoarser(BrickRun& run, const Ray& ray, const BrickWay& wanted, double t);
  void close(BrickRun& run, float transmittance);

  const CachedScene& Scene;
  OnMiss Missing;
  MarchNotes& Notes;
  BrickWay Ways[2]; ///< of even and of odd levels, along the present ray
  BrickRun Runs[2]; ///< of even and of odd levels: dithering alternates between two neighbours
  std::optional<BrickKey> Awaited; ///< by the next sample
};

} // namespace inr

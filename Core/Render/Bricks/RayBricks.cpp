// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/RayBricks.h"

#include <algorithm>

namespace inr {

namespace {

void ShowKnown(const BlockSet& known, ShownBlocks& shown)
{
  shown.kind = known.isAll() ? ShownBlocks::Kind::All : ShownBlocks::Kind::Some;
  std::copy(known.words.begin(), known.words.end(), shown.words);
}

} // namespace

void RayBricks::begin()
{
  this->Awaited.reset();
  this->Ways[0].forget();
  this->Ways[1].forget();
}

void RayBricks::leaveBatch()
{
  this->Runs[0].setPlace(-1);
  this->Runs[1].setPlace(-1);
}

void RayBricks::finish(float transmittance, bool isEnded)
{
  this->close(this->Runs[0], transmittance);
  this->close(this->Runs[1], transmittance);
  if (this->Awaited && !isEnded) { // what made a ray opaque needs nothing behind it
    this->Notes.requests.add(*this->Awaited, 1.0f);
  }
}

// Flat: it is called for every brick of every ray.
__attribute__((flatten)) bool RayBricks::reopen(BrickRun& run, const Ray& ray, float transmittance,
                                                int level, double place)
{
  this->close(run, transmittance);
  const BrickCache& cache = this->Scene.bricks->cache();
  const double t = place * this->Scene.settings.step;
  BrickWay& wanted = this->Ways[level & 1];
  if (wanted.level() != level) {
    wanted = BrickWay(cache.hierarchy().view(), level, ray);
  }
  wanted.moveTo(t);
  const BrickKey key = wanted.brick();
  std::int32_t slot = this->Scene.bricks->find(key);
  if (slot >= 0) {
    run.open(wanted, wanted, cache.view(slot), this->Scene.settings.step);
  } else if (this->Missing == OnMiss::Stop) {
    this->Awaited = key;
    return false;
  } else {
    slot = this->openCoarser(run, ray, wanted, t);
  }
  cache.touch(slot);
  if (!run.exact()) { // a coarser brick may hide what is there, but what is not known is invisible
    ShowKnown(cache.blocks().known(slot), run.shown());
  } else if (this->Scene.blocks != nullptr) {
    this->Scene.blocks->find(slot, run.shown());
  }
  return true;
}

std::int32_t RayBricks::openCoarser(BrickRun& run, const Ray& ray, const BrickWay& wanted, double t)
{
  const BrickCache& cache = this->Scene.bricks->cache();
  const Hierarchy& hierarchy = cache.hierarchy();
  BrickKey wish = wanted.brick();
  for (int level = wanted.level() + 1;; ++level) { // the coarsest is there
    BrickWay served(hierarchy.view(), level, ray);
    served.moveTo(t);
    const std::int32_t slot = this->Scene.bricks->find(served.brick());
    if (slot >= 0) {
      run.open(wanted, served, cache.view(slot), this->Scene.settings.step);
      if (this->Missing == OnMiss::Approach) {
        run.wishFor(wish);
      }
      return slot;
    }
    wish = hierarchy.view().isOnTheWay(level) ? served.brick() : wish;
  }
}

void RayBricks::close(BrickRun& run, float transmittance)
{
  this->Notes.statistics.samples += run.count();
  if (run.count() > 0) {
    this->Notes.statistics.levels.add({run.servedLevel(), run.servedLevel()});
    this->Notes.levelSum += static_cast<double>(std::int64_t{run.count()} * run.servedLevel());
  }
  if (run.count() > 0 && !run.exact()) {
    this->Notes.statistics.missed += run.count();
    this->Notes.requests.add(run.wish(), static_cast<float>(run.count()) * transmittance);
  }
  run.close();
}

} // namespace inr

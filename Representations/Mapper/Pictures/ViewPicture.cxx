// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/ViewPicture.h"

#include <utility>

namespace inr {

void ViewPicture::begin()
{
  this->Before = this->Fine ? std::move(*this->Fine) : std::exchange(this->Last, {});
  this->Fine.reset();
  this->Last = {};
  this->Scene.reset();
}

bool ViewPicture::showAgain(const Frame& frame, bool countsSamples, std::int64_t colors)
{
  const bool isThere = this->Key && !this->Before.rgba.pixels.empty();
  if (!isThere || !this->Key->matches(frame, countsSamples, colors)) {
    this->Key.reset();
    this->Before = {};
    return false;
  }
  this->Before.depthRead = this->Last.depthRead;
  this->Before.statistics.work = {};
  this->Last = std::exchange(this->Before, {});
  return true;
}

void ViewPicture::finish(const Frame& frame, bool countsSamples, std::int64_t colors)
{
  this->Key.emplace(frame, countsSamples, colors);
}

void ViewPicture::depict(const DepictedScene& scene)
{
  Frame frame = scene.frame;
  frame.timeLimit = 0; // how long it may take is nothing that it shows
  this->Scene.emplace(frame, false, scene.colors);
  this->Surroundings = scene.surroundings;
}

bool ViewPicture::depicts(const DepictedScene& scene) const
{
  return !this->Last.rgba.pixels.empty() && this->Surroundings == scene.surroundings &&
         this->Scene && this->Scene->matches(scene.frame, false, scene.colors);
}

ViewPicture& ViewPicture::coarser()
{
  if (!this->Coarser) {
    this->Coarser = std::make_unique<ViewPicture>(NobodysPicture);
  }
  return *this->Coarser;
}

void ViewPicture::showCoarser()
{
  const PaintedFrame& coarse = this->Coarser->last();
  PaintedFrame shown;
  shown.rgba = coarse.rgba;
  shown.depth = coarse.depth;
  shown.reduction = coarse.reduction;
  shown.statistics = coarse.statistics;
  // But it is this one that is in the making.
  shown.statistics.complete = false;
  shown.statistics.blank = true;
  shown.statistics.paths = this->Last.statistics.paths;
  shown.statistics.seconds = this->Last.statistics.seconds;
  shown.statistics.marchSeconds = this->Last.statistics.marchSeconds;
  shown.statistics.work = this->Last.statistics.work;
  shown.backend = this->Last.backend;
  shown.depthRead = this->Last.depthRead;
  this->Fine = std::exchange(this->Last, std::move(shown));
}

void ViewPicture::outdate()
{
  this->Coarser.reset();
  this->Key.reset();
  this->Scene.reset();
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/ViewPicture.h"

#include <utility>

namespace inr {

namespace {

Frame InAnyTime(Frame frame)
{
  frame.timeLimit = 0; // how long it may take is nothing that it shows
  return frame;
}

} // namespace

ViewPicture::Depiction::Depiction(const DepictedScene& scene)
    : key(InAnyTime(scene.frame), false, scene.colors), surroundings(scene.surroundings)
{}

bool ViewPicture::Depiction::isOf(const DepictedScene& scene) const
{
  return this->surroundings == scene.surroundings && this->isOf(scene.frame, scene.colors);
}

bool ViewPicture::Depiction::isOf(const Frame& frame, std::int64_t colors) const
{
  return this->key.matches(frame, false, colors);
}

bool ViewPicture::hasSize(int width, int height) const
{
  const PaintedFrame& own = this->Passes ? this->Before : this->Fine ? *this->Fine : this->Last;
  return own.rgba.pixels.empty() || (own.rgba.width == width && own.rgba.height == height);
}

void ViewPicture::begin(bool passes)
{
  if (!this->Passes) {
    this->Before = this->Fine ? std::move(*this->Fine) : std::move(this->Last);
    this->SceneBefore = std::move(this->Scene);
  }
  this->Passes = passes;
  this->hurried = false;
  this->Fine.reset();
  this->Last = {};
  this->Scene.reset();
}

void ViewPicture::takeBefore()
{
  this->Before.depthRead = this->Last.depthRead;
  this->Before.statistics.work = {};
  this->Last = std::exchange(this->Before, {});
  this->Scene = std::move(this->SceneBefore);
  this->Passes = false;
}

bool ViewPicture::showStill(const DepictedScene& scene, int width, int height)
{
  const Image& rgba = this->Before.rgba;
  const bool isThere = this->Passes && !rgba.pixels.empty() && !this->Before.statistics.blank;
  if (!isThere || rgba.width != width || rgba.height != height || !this->SceneBefore ||
      !this->SceneBefore->isOf(scene)) {
    return false;
  }
  this->takeBefore();
  return true;
}

bool ViewPicture::showAgain(const Frame& frame, bool countsSamples, std::int64_t colors)
{
  const bool isThere = this->Key && !this->Before.rgba.pixels.empty();
  if (isThere && this->Key->matches(frame, countsSamples, colors)) {
    this->takeBefore();
    return true;
  }
  if (!this->Passes) {
    this->Key.reset();
    this->Before = {};
    this->SceneBefore.reset();
  }
  return false;
}

void ViewPicture::finish(const Frame& frame, bool countsSamples, std::int64_t colors)
{
  if (!this->Passes) {
    this->Key.emplace(frame, countsSamples, colors);
  }
}

void ViewPicture::depict(const DepictedScene& scene)
{
  this->Scene = std::make_unique<Depiction>(scene);
}

bool ViewPicture::wasOfSame(const DepictedScene& scene) const
{
  return this->SceneBefore && this->SceneBefore->isOf(scene.frame, scene.colors);
}

bool ViewPicture::depicts(const DepictedScene& scene) const
{
  return !this->Last.rgba.pixels.empty() && this->Scene && this->Scene->isOf(scene);
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
  this->SceneBefore.reset();
}

} // namespace inr

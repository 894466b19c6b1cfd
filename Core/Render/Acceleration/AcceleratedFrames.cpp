// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Acceleration/AcceleratedFrames.h"

#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/NumberText.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace inr {

namespace {

/// A bit for each kind of picture that kernels make in a way of their own.
std::uint64_t KindOf(const Frame& frame)
{
  const int layered = frame.layers && frame.layers->any() ? 1 : 0;
  if (frame.mode == RenderMode::PathTracing) {
    return std::uint64_t{1} << (62 + layered);
  }
  constexpr int modes = static_cast<int>(BlendMode::Isosurface) + 1;
  const int mode = frame.preIntegration ? modes : static_cast<int>(frame.blending.mode);
  const int lit = frame.shading ? 1 : 0;
  const int cropped = frame.cropping && !BoxOf(*frame.cropping).full ? 1 : 0;
  return std::uint64_t{1} << (8 * mode + 4 * layered + 2 * lit + cropped);
}

/// Every few pixels of the layers of a picture, for one of edge x edge pixels; null of none.
std::shared_ptr<const TranslucentLayers> Shrunk(const Frame& frame, int edge)
{
  if (!frame.layers) {
    return nullptr;
  }
  auto shrunk = std::make_shared<TranslucentLayers>();
  for (const TranslucentLayers::Layer& layer : frame.layers->layers) {
    TranslucentLayers::Layer few;
    for (int k = 0; k < edge * edge; ++k) {
      const std::int64_t x = std::int64_t{k % edge} * frame.width / edge;
      const std::int64_t y = std::int64_t{k / edge} * frame.height / edge;
      const auto pixel = static_cast<std::size_t>(y * frame.width + x);
      few.depth.push_back(layer.depth[pixel]);
      few.colors.push_back(layer.colors[pixel]);
    }
    shrunk->layers.push_back(std::move(few));
  }
  return shrunk;
}

int PixelsShown(const Image& rgba)
{
  int shown = 0;
  for (std::size_t k = 3; k < rgba.pixels.size(); k += 4) {
    shown += rgba.pixels[k] > 0.0f ? 1 : 0;
  }
  return shown;
}

/// As if the brightest colour of both pictures were white, and the largest alpha opaque: of faint
/// pictures, too, anybody can say whether they are the same.
void Brighten(Image& a, Image& b)
{
  float peaks[2] = {std::numeric_limits<float>::min(), std::numeric_limits<float>::min()};
  for (const Image* image : {&a, &b}) {
    for (std::size_t k = 0; k < image->pixels.size(); ++k) {
      float& peak = peaks[k % 4 / 3];
      peak = std::max(peak, image->pixels[k]);
    }
  }
  for (Image* image : {&a, &b}) {
    for (std::size_t k = 0; k < image->pixels.size(); ++k) {
      image->pixels[k] /= peaks[k % 4 / 3];
    }
  }
}

/// Pixels that say something where rounding may make another one of one in thousands.
constexpr int FewestPixels = 32;

/// Of the pixels that are shown in either picture, the part that is another colour: what parts ways
/// for rounding meets nothing the same any more. 0 where they are too few to tell.
double PartOfOthers(const Image& drawn, const Image& truth)
{
  constexpr float tolerance = 1e-2f;
  double shown = 0;
  double others = 0;
  for (std::size_t k = 0; k < truth.pixels.size(); k += 4) {
    const float* const a = &drawn.pixels[k];
    const float* const b = &truth.pixels[k];
    if (a[3] != 0.0f || b[3] != 0.0f) {
      const bool same = std::equal(a, a + 4, b, [](float one, float other) {
        return std::abs(one - other) <= tolerance * std::max(std::abs(other), 1e-3f);
      });
      ++shown;
      others += same ? 0 : 1;
    }
  }
  return shown >= FewestPixels ? others / shown : 0;
}

/// Whether a picture would be another one without its layers, if it has any.
bool ShowsLayers(const Frame& frame, const Image& picture, const AcceleratedFrames::Draw& draw)
{
  if (!frame.layers || !frame.layers->any()) {
    return true;
  }
  Frame bare = frame;
  bare.layers = nullptr;
  Image without(frame.width, frame.height, 4);
  draw(bare, {without, nullptr});
  return without.pixels != picture.pixels;
}

/// Whether rounding may make another pixel of one: a path goes elsewhere, a surface is missed.
bool MayFlip(const Frame& frame)
{
  return frame.mode == RenderMode::PathTracing || frame.blending.mode == BlendMode::Isosurface;
}

/// What is wrong with a picture, beyond rounding; empty if nothing is.
std::string WhatDiffers(const Frame& frame, Image drawn, Image truth)
{
  constexpr double least = 40; // dB; rounding leaves twice as many
  constexpr double mostOthers = 1. / 8;
  if (MayFlip(frame)) {
    const double others = PartOfOthers(drawn, truth);
    return others <= mostOthers ? ""
                                : std::to_string(std::lround(100 * others)) +
                                      " % of the pixels that it shows are different from the CPU's";
  }
  Brighten(drawn, truth);
  const double psnr = ImagePsnr(drawn, truth);
  return psnr >= least ? ""
                       : "it draws a picture that is " + NumberText(psnr, 4) +
                             " dB from the CPU's, not the same";
}

} // namespace

bool AcceleratedFrames::draws(const Frame& frame)
{
  if (this->Device && this->Field->failure()) { // of which somebody else was told
    this->Device.reset();
  }
  return this->Device && this->Device->draws(frame);
}

bool AcceleratedFrames::succeeds(const std::function<void()>& call)
{
  if (!this->Device) {
    return false;
  }
  try {
    call();
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Device) {
      throw;
    }
    this->Field->fail(error, true);
    this->Device.reset();
    return false;
  }
}

void AcceleratedFrames::setColors(const Majorants& majorants, const ColorLookup& colors)
{
  this->succeeds([&] { this->Device->setColors(majorants, colors); });
}

std::optional<FrameStatistics> AcceleratedFrames::march(const MarchJob& job, const DrawCall& call)
{
  std::optional<FrameStatistics> statistics;
  this->succeeds([&] { statistics = this->Device->march(job, call); });
  return statistics;
}

std::optional<TracedTiles> AcceleratedFrames::tracePaths(const PathRound& round,
                                                         const WorkLimit& limit,
                                                         const std::function<bool()>& keepGoing)
{
  std::optional<TracedTiles> traced;
  this->succeeds([&] { traced = this->Device->tracePaths(round, limit, keepGoing); });
  return traced;
}

void AcceleratedFrames::prove(const Frame& frame, double scale, const Draw& accelerated,
                              const Draw& cpu)
{
  constexpr int edge = 24; // pixels: little has to be inferred for them
  constexpr int paths = 4; // through each
  const std::uint64_t kind = KindOf(frame);
  if ((this->Proven & kind) != 0 || !this->draws(frame)) {
    return;
  }
  Frame small = frame;
  small.width = small.height = edge;
  small.samplesPerPixel = paths;
  small.opaqueDepth = nullptr;
  small.layers = Shrunk(frame, edge);
  small.timeLimit = 0;
  small.levelOfDetailScale = std::max(frame.levelOfDetailScale, scale);
  small.errorTolerance.reset();
  Image drawn(edge, edge, 4);
  accelerated(small, {drawn, nullptr});
  if (!this->draws(frame)) { // it has failed
    return;
  }
  Image truth(edge, edge, 4);
  cpu(small, {truth, nullptr});
  constexpr int mostTries = 4; // then it is as it is: each takes the time of some frames
  const int shown = PixelsShown(truth);
  const bool tells = shown >= (MayFlip(small) ? FewestPixels : 1) && ShowsLayers(small, truth, cpu);
  const bool mayTry = shown > 0 && small.mode == RenderMode::RayMarching;
  const bool proves = tells || (mayTry && ++this->Tries >= mostTries);
  this->succeeds([&] {
    const std::string difference = WhatDiffers(small, drawn, truth);
    if (!difference.empty()) {
      throw Error(ErrorCode::Device, difference);
    }
    if (proves) {
      this->Proven |= kind;
    }
  });
}

} // namespace inr

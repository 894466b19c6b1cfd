// SPDX-License-Identifier: BSD-3-Clause
//
// Kinds of ray-marched frames, for whatever draws them.
#pragma once

#include "Testing/CUDA/DrawingScene.h"

#include <vector>

inline std::vector<Case> MarchedCases()
{
  const auto lit = [](inr::Frame& frame) { Shade(frame); };
  const auto piece = [](inr::Frame& frame) { frame.piece = {PlaneAcross({0.1, 1, 0.4})}; };
  const auto opaque = [](inr::Frame& frame) { frame.unitDistance = 0.02; };
  const auto layered = [](inr::Frame& frame) { AddLayers(frame); };
  const auto both = [](const auto& first, const auto& second) {
    return [=](inr::Frame& frame) {
      first(frame);
      second(frame);
    };
  };
  return {
      {"Plain", [](inr::Frame&) {}},
      {"EverySample", [](inr::Frame& frame) { frame.adaptiveSampling = false; }},
      {"Fine", [](inr::Frame& frame) { frame.sampleDistance = 0.11; }},
      {"Lit", lit},
      {"Largest", Projected(inr::BlendMode::MaximumIntensity)},
      {"Smallest", Projected(inr::BlendMode::MinimumIntensity)},
      {"Average", Projected(inr::BlendMode::AverageIntensity)},
      {"Sum", Projected(inr::BlendMode::Additive)},
      {"Cropped", Crop},
      {"Clipped",
       [](inr::Frame& frame) {
         frame.clippingPlanes = {PlaneAcross({1, 0.3, -0.2})};
       }},
      {"Piece", piece},
      {"LitPiece", both(piece, lit)},
      {"BehindSomething", [](inr::Frame& frame) { frame.opaqueDepth = SomeDepth().data(); }},
      {"Layered", layered},
      {"LitLayered", both(layered, lit)},
      {"LayeredPiece", both(layered, piece)},
      {"LayeredOpaque", both(layered, opaque)},
      {"Opaque", opaque},
      {"LitOpaque", both(opaque, lit)},
      {"OneColumn", [](inr::Frame& frame) { frame.width = 1; }},
  };
}

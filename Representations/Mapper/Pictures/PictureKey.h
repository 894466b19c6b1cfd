// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/KeptFrame.h"

#include <cstdint>

namespace inr {

/// What a picture depends on beyond its renderer, to tell whether the next one is the same.
class PictureKey
{
public:
  /// `colors`: Renderer::colorsVersion(), which rises whenever they change.
  PictureKey(const Frame& frame, bool countsSamples, std::int64_t colors);
  PictureKey(const PictureKey&) = delete;
  PictureKey& operator=(const PictureKey&) = delete;

  bool matches(const Frame& frame, bool countsSamples, std::int64_t colors) const;

private:
  KeptFrame Picture;
  bool CountsSamples;
  std::int64_t Colors;
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

#include <cstdint>
#include <vector>

namespace inr {

/// What a picture depends on beyond its renderer, to tell whether the next one is the same.
class PictureKey
{
public:
  /// `colors`: Renderer::majorantBuilds(), which rises whenever they change.
  PictureKey(const Frame& frame, bool countsSamples, std::int64_t colors);
  PictureKey(const PictureKey&) = delete;
  PictureKey& operator=(const PictureKey&) = delete;

  bool matches(const Frame& frame, bool countsSamples, std::int64_t colors) const;

private:
  std::vector<float> OpaqueDepth;
  Frame Picture; ///< with its depth there
  bool CountsSamples;
  std::int64_t Colors;
};

} // namespace inr

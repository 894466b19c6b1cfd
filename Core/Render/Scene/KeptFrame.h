// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

#include <vector>

namespace inr {

/// A frame with its opaque depth, to be gone on with, or compared with later ones.
class KeptFrame
{
public:
  explicit KeptFrame(const Frame& frame) : Depth(CopyOfDepth(frame)), Picture(frame)
  {
    this->Picture.opaqueDepth = this->Depth.empty() ? nullptr : this->Depth.data();
  }
  KeptFrame(const KeptFrame&) = delete;
  KeptFrame& operator=(const KeptFrame&) = delete;

  bool isOf(const Frame& frame) const { return IsSamePicture(this->Picture, frame); }
  const Frame& frame() const { return this->Picture; }

private:
  std::vector<float> Depth;
  Frame Picture;
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"

#include <string>

namespace inr {

/// Writes premultiplied RGBA as 32-bit float channels R, G, B, A and, when `depth` is not empty,
/// its single channel as Z, and when `samples` is not empty, its two as "samples" and "level",
/// bit-exact. Whole file or none (temporary name and rename). Throws
/// Error(InvalidArgument) for wrong shapes, Error(CannotWrite) for an unwritable target.
void WriteExr(const std::string& path, const Image& rgba, const Image& depth = {},
              const Image& samples = {});

/// Reads what WriteExr wrote: R, G, B, A into a four-channel image; `depth`, when given, receives Z
/// (empty if there is none), and `samples` what was written of it. Throws Error(CannotRead),
/// Error(Malformed), or Error(Unsupported) where the pixels do not begin at (0, 0).
Image ReadExr(const std::string& path, Image* depth = nullptr, Image* samples = nullptr);

} // namespace inr

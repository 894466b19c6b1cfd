// SPDX-License-Identifier: BSD-3-Clause
//
// Long work in pieces, two of them on their way at once: while the GPU computes one, the other is
// copied.
#pragma once

#include "CUDA/Device/Runtime.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace inr {
namespace cuda {

/// Buffers of a piece, on both sides, and its stream, which is waited for before they go.
template <class In> struct Slot
{
  Slot(int device, std::int64_t ins, std::int64_t outs, std::int64_t scratchFloats)
      : hostIn(device, Memory::Place::Pinned, ins), hostOut(device, Memory::Place::Pinned, outs),
        in(device, Memory::Place::Device, ins), out(device, Memory::Place::Device, outs),
        scratch(device, Memory::Place::Device, scratchFloats), stream(device)
  {}

  /// Bytes of the device.
  static std::int64_t bytes(std::int64_t ins, std::int64_t outs, std::int64_t scratchFloats)
  {
    return ins * static_cast<std::int64_t>(sizeof(In)) +
           (outs + scratchFloats) * static_cast<std::int64_t>(sizeof(float));
  }

  Array<In> hostIn;
  Array<float> hostOut;
  Array<In> in;
  Array<float> out;
  Array<float> scratch;
  Stream stream;
};

template <class In> using SlotPair = std::array<Slot<In>, 2>;

/// Throws Error(Device) where there is no memory for them.
template <class In>
SlotPair<In> MakeSlots(int device, std::int64_t ins, std::int64_t outs, std::int64_t scratchFloats)
{
  RequireFree(device, 2 * Slot<In>::bytes(ins, outs, scratchFloats), "the buffers of inference");
  return {{{device, ins, outs, scratchFloats}, {device, ins, outs, scratchFloats}}};
}

/// For all pieces of at most `piece` of `count`: submit(slot, first, size) begins one and
/// collect(slot, first, size) takes its results, after the only wait there is: for its own stream.
/// Nothing is on its way when this ends, be it by an exception.
template <class In, class Submit, class Collect>
void InPieces(const SlotPair<In>& slots, std::int64_t count, std::int64_t piece,
              const Submit& submit, const Collect& collect)
{
  struct Landing
  {
    explicit Landing(const SlotPair<In>& pair) : Pair(pair) {}
    ~Landing()
    {
      for (const Slot<In>& slot : this->Pair) {
        slot.stream.settle();
      }
    }
    const SlotPair<In>& Pair;
  };
  const Landing landing(slots);
  const std::int64_t pieces = (count + piece - 1) / piece;
  for (std::int64_t k = 0; k < pieces + 1; ++k) {
    if (k < pieces) {
      submit(slots[static_cast<std::size_t>(k % 2)], k * piece, std::min(piece, count - k * piece));
    }
    if (k > 0) {
      const Slot<In>& slot = slots[static_cast<std::size_t>((k - 1) % 2)];
      slot.stream.wait();
      collect(slot, (k - 1) * piece, std::min(piece, count - (k - 1) * piece));
    }
  }
}

} // namespace cuda
} // namespace inr

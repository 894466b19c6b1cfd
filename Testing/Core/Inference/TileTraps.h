// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace imitation {

/// Lets code that was built for tile registers run on a processor without them, as long as this
/// lives: where it traps at one of their instructions (SIGILL), the imitated tiles do what that
/// says. So the very instructions that a compiler made are tested. One at a time.
class TileTraps
{
public:
  TileTraps();
  ~TileTraps();
  TileTraps(const TileTraps&) = delete;
  TileTraps& operator=(const TileTraps&) = delete;

  /// How many instructions have been done instead of the processor.
  static long count();
};

/// Whether the processor has tile instructions, whoever may use them.
bool HasTileInstructions();

} // namespace imitation

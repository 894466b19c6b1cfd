// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/CellWalker.h"
#include "Core/Render/Marching/MarchSettings.h"
#include "Core/Render/Marching/SampleStretch.h"
#include "Core/Render/Marching/StepLattice.h"
#include "Core/Render/Rays/LevelOfDetail.h"

#include <glm/common.hpp>

#include <cmath>

namespace inr {

/// The stretch from a ray's next sample on, where LevelOfDetail says how far apart samples are:
/// through cells that matter and are as faint as each other, or of that one sample. `cells` is
/// where the sample is, and goes on as far as had to be looked.
INR_HOST_DEVICE inline SampleStretch FindOpenStretch(CellWalker& cells, const LevelOfDetail& detail,
                                                     const StretchStart& start,
                                                     const MarchSettings& settings)
{
  const bool matters = cells.extinction() > 0.0f;
  const int level = detail.coarsest();
  const double length = settings.step * PowerOfTwo(level);
  const double depth = length * settings.unitsPerT;
  const int faint = FaintSamples(settings, cells.extinction() * depth);
  const double levelEnd = detail.exit();
  ValueRange range = cells.range();
  double exit = cells.exit();
  // As far as the end of a block of the lattice: further ones the ray may never see.
  const double enough = glm::min(BlockEnd(start.begin * settings.step, SamplesAhead * length),
                                 glm::min(levelEnd, start.rayEnd * settings.step));
  // What an extreme can skip is found cell by cell.
  const bool joins = matters && !settings.projector.isExtreme();
  bool leaves = false;
  while (joins && exit < enough) {
    cells.moveTo(exit);
    const float extinction = cells.extinction();
    leaves = extinction <= 0.0f;
    if (leaves || FaintSamples(settings, extinction * depth) != faint) {
      break;
    }
    range.extend(cells.range());
    exit = cells.exit();
  }
  const double stepsPerT = 1.0 / settings.step;
  const double reach = matters ? exit * stepsPerT : start.reach;
  double last = matters ? reach : std::nextafter(start.firstPlace, start.rayEnd + 1);
  if (leaves && settings.looksAtBothEnds() && cells.exit() >= exit + length) {
    // With the sample behind them whose steps begin in one of them.
    range.extend(cells.range());
    last += PowerOfTwo(level);
  }
  SampleStretch stretch;
  stretch.exit = last;
  stretch.levelEnd = levelEnd * stepsPerT;
  stretch.power = level;
  stretch.faint = faint;
  stretch.range = range;
  stretch.reach = reach;
  return stretch;
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Common/Extents.h"

#include <vtkExtentTranslator.h>
#include <vtkNew.h>

#include <algorithm>

bool IsEmpty(const int* extent)
{
  return extent[1] < extent[0] || extent[3] < extent[2] || extent[5] < extent[4];
}

bool Contains(const int* outer, const int* inner)
{
  return outer[0] <= inner[0] && outer[1] >= inner[1] && outer[2] <= inner[2] &&
         outer[3] >= inner[3] && outer[4] <= inner[4] && outer[5] >= inner[5];
}

std::array<int, 6> PieceExtent(const int* whole, int piece, int pieces, int ghostLevels)
{
  std::array<int, 6> extent{};
  std::copy_n(whole, 6, extent.data());
  if (pieces > 1) {
    std::array<int, 6> cut = extent; // the translator asks for one that it may write to
    vtkNew<vtkExtentTranslator> translator;
    translator->PieceToExtentThreadSafe(piece, pieces, ghostLevels, cut.data(), extent.data(),
                                        vtkExtentTranslator::BLOCK_MODE, 0);
  }
  return extent;
}

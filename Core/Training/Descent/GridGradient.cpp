// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Descent/GridGradient.h"

#include <algorithm>

namespace inr {

namespace {

std::int64_t LinesOf(std::int64_t parameters)
{
  return (parameters + GradientLine - 1) / GradientLine;
}

std::int64_t SizeOf(const ModelView& model, int level)
{
  return static_cast<std::int64_t>(model.levels[level].entries) * model.features;
}

} // namespace

GridGradient::GridGradient(const ModelView& model, float* values) : Values(values)
{
  std::int64_t lines = 0;
  for (int level = 0; level < model.levelCount; ++level) {
    lines += LinesOf(SizeOf(model, level));
  }
  this->Touched.resize(static_cast<std::size_t>(lines));
  std::uint8_t* touched = this->Touched.data();
  for (int level = 0; level < model.levelCount; ++level) {
    this->FirstPieces.push_back(this->Pieces.size());
    const std::int64_t size = SizeOf(model, level);
    for (std::int64_t first = 0; first < size; first += PieceSize) {
      const std::int64_t count = std::min(PieceSize, size - first);
      const std::size_t at = model.levels[level].offset + static_cast<std::size_t>(first);
      this->Pieces.push_back({at, count, touched});
      touched += LinesOf(count);
    }
  }
}

LevelGradient GridGradient::level(int level)
{
  const Piece& first = this->Pieces[this->FirstPieces[static_cast<std::size_t>(level)]];
  return {this->Values + first.first, first.touched};
}

void GridGradient::clear()
{
  for (const Piece& piece : this->Pieces) {
    std::uint8_t* const end = piece.touched + LinesOf(piece.count);
    if (std::find(piece.touched, end, 1) != end) {
      std::fill(piece.touched, end, std::uint8_t{0});
      std::fill_n(this->Values + piece.first, piece.count, 0.0f);
    }
  }
}

} // namespace inr

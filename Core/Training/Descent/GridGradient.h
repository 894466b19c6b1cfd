// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/ModelView.h"
#include "Core/Training/Descent/TrainKernel.h"

#include <cstdint>
#include <vector>

namespace inr {

/// d loss / d parameter of the grid, and which lines of it may differ from zero, so that an update
/// looks at what a mini-batch touched only.
class GridGradient
{
public:
  /// Parameters of a piece, a multiple of GradientLine.
  static constexpr std::int64_t PieceSize = 1 << 15;

  /// Parameters of one level that are updated in one task.
  struct Piece
  {
    std::size_t first;  ///< from the grid's start
    std::int64_t count; ///< parameters, at most PieceSize
    std::uint8_t* touched;
  };

  /// `values`: of the grid's parameters, all zero; they must outlive this.
  GridGradient(const ModelView& model, float* values);
  GridGradient(const GridGradient&) = delete;
  GridGradient& operator=(const GridGradient&) = delete;

  LevelGradient level(int level);
  float* values(const Piece& piece) { return this->Values + piece.first; }
  const std::vector<Piece>& pieces() const { return this->Pieces; }

  /// Makes everything zero that is not.
  void clear();

private:
  float* Values;
  std::vector<std::uint8_t> Touched; ///< every level begins with a line, so that no two share one
  std::vector<Piece> Pieces;         ///< level by level
  std::vector<std::size_t> FirstPieces; ///< of the levels
};

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Lanes.h.
#include "Core/Inference/GridKernel.h"

#include "Core/Inference/EncodeGrid.h"
#include "Core/Inference/Network.h"
#include "Core/Inference/Prefetch.h"

namespace inr {
namespace INR_ISA {

namespace {

/// Rows of a piece that make a strip.
constexpr int StripHeight = StripSize / PieceWidth;
static_assert(StripSize % PieceWidth == 0 && StripHeight <= RowCapacity,
              "a strip holds whole rows");

std::int64_t Workspace(const ModelView& model)
{
  return static_cast<std::int64_t>(sizeof(LevelPiece)) * model.levelCount + CacheLineBytes +
         static_cast<std::int64_t>(sizeof(float)) * StripWorkspace(model);
}

template <int Features>
void EncodeLevels(const ModelView& model, const Coordinates& y, int rows, LevelPiece* pieces,
                  float* encoded)
{
  for (int l = 0; l < model.levelCount; ++l) {
    const LevelView& level = model.levels[l];
    EncodeRows<Features>(level, model.interpolation, model.grid + level.offset, y, rows, pieces[l],
                         encoded + static_cast<std::int64_t>(l) * Features * StripSize, StripSize);
  }
}

void EncodeStrip(const ModelView& model, const Coordinates& y, int rows, LevelPiece* pieces,
                 float* encoded)
{
  switch (model.features) {
  case 1:
    return EncodeLevels<1>(model, y, rows, pieces, encoded);
  case 2:
    return EncodeLevels<2>(model, y, rows, pieces, encoded);
  case 4:
    return EncodeLevels<4>(model, y, rows, pieces, encoded);
  default:
    return EncodeLevels<8>(model, y, rows, pieces, encoded);
  }
}

/// Samples of a row that have places in a strip: all of a piece, or as many as hold the `count`
/// that are wanted. A strip of thin pieces has the more rows, and the network is asked for little
/// else.
int PlacesFor(int count)
{
  int places = 1;
  while (places < count) {
    places *= 2;
  }
  return places;
}

/// Rows of the strip that begins at row j, `height` at most; 0 where none does.
int RowsFrom(const LatticeAxis& y, std::int64_t j, int height)
{
  const std::int64_t left = y.count - j;
  return static_cast<int>(left < 0 ? 0 : left < height ? left : height);
}

/// Rows to encode so that whole vectors of samples hold `rows` of them and nothing else: the
/// missing ones repeat the last, so that no number comes up that belongs to no sample.
int WholeRows(int rows)
{
  return (rows * PieceWidth + LaneCount - 1) / LaneCount * LaneCount / PieceWidth;
}

/// Encodes the first `places` samples of each of `rows` rows, side by side in strips.in; the last
/// one is repeated up to a whole vector.
void EncodeThinStrip(const ModelView& model, const float* y, int rows, int places,
                     LevelPiece* pieces, StripPair& strips)
{
  for (int first = 0; first < rows; first += StripHeight) {
    const int some = rows - first < StripHeight ? rows - first : StripHeight;
    Coordinates heights;
    LoadCoordinates(y + first, some, heights);
    EncodeStrip(model, heights, some, pieces, strips.out.values);
    for (int f = 0; f < model.encodedWidth; ++f) {
      const float* const from = strips.out.values + f * StripSize;
      float* const to = strips.in.values + f * StripSize + first * places;
      for (int row = 0; row < some; ++row) {
        std::memcpy(to + row * places, from + row * PieceWidth,
                    static_cast<std::size_t>(places) * sizeof(float));
      }
    }
  }
  for (int f = 0; f < model.encodedWidth; ++f) {
    float* const samples = strips.in.values + f * StripSize;
    for (int k = rows * places; k % LaneCount != 0; ++k) {
      samples[k] = samples[k - 1];
    }
  }
}

/// `count` samples of each row of a layer, from `first` on; `layer` is the layer's values.
void EvaluatePiece(const ModelView& model, const LatticeAxis& y, std::int64_t first, int count,
                   std::int64_t width, LevelPiece* pieces, StripPair& strips, float* layer)
{
  const int places = PlacesFor(count);
  const bool isThin = places < PieceWidth;
  const int height = StripSize / places;
  const int tiles = HiddenTiles(model);
  const int units = HasFarLevels(model) ? model.levelCount : 0;
  Coordinates heights;
  LoadCoordinates(y.u, RowsFrom(y, 0, StripHeight), heights);
  for (std::int64_t j = 0; j < y.count; j += height) {
    const int rows = RowsFrom(y, j, height);
    const int next = isThin ? 0 : RowsFrom(y, j + height, height);
    if (isThin) {
      EncodeThinStrip(model, y.u + j, rows, places, pieces, strips);
    } else {
      EncodeStrip(model, heights, WholeRows(rows), pieces, strips.in.values);
    }
    if (next > 0) {
      LoadCoordinates(y.u + j + height, next, heights);
    }
    auto fetch = [&](int level) { PrefetchRows(model, level, heights, next, pieces[level]); };
    Evenly between(fetch, next > 0 ? units : 0, tiles);
    float outputs[StripSize];
    RunStrip(model, strips, rows * places, outputs, between);
    for (int row = 0; row < rows; ++row) {
      std::memcpy(layer + (j + row) * width + first, outputs + row * places,
                  static_cast<std::size_t>(count) * sizeof(float));
    }
  }
}

void EvaluateGrid(const ModelView& model, const LatticeAxis (&axes)[3], float* values,
                  void* workspace)
{
  const Batch batch;
  auto* const pieces = AlignToLine(static_cast<LevelPiece*>(workspace));
  StripPair strips = MakeStrips(model, reinterpret_cast<float*>(pieces + model.levelCount));
  const std::int64_t width = axes[0].count;
  for (std::int64_t first = 0; first < width; first += PieceWidth) {
    const int count = width - first < PieceWidth ? static_cast<int>(width - first) : PieceWidth;
    Coordinates x;
    LoadCoordinates(axes[0].u + first, count, x);
    for (int l = 0; l < model.levelCount; ++l) {
      LocatePiece(model.levels[l], model.interpolation, x, pieces[l]);
    }
    for (std::int64_t k = 0; k < axes[2].count; ++k) {
      Coordinates z;
      LoadCoordinates(axes[2].u + k, 1, z);
      for (int l = 0; l < model.levelCount; ++l) {
        BeginLayer(model.levels[l], model.interpolation, z, pieces[l]);
      }
      EvaluatePiece(model, axes[1], first, count, width, pieces, strips,
                    values + k * axes[1].count * width);
    }
  }
}

} // namespace

const GridKernel Grid = {Workspace, EvaluateGrid};

} // namespace INR_ISA
} // namespace inr

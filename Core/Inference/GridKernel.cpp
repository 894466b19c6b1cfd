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

/// Fetches what a piece needs of one level for the next strip.
struct FetchRows
{
  const ModelView& model;
  const Coordinates& heights;
  int rows;
  const LevelPiece* pieces;

  void operator()(int level) const
  {
    PrefetchRows(this->model, level, this->heights, this->rows, this->pieces[level]);
  }
};

/// Rows of a layer, `count` samples of each: `samples` has them one after the other.
void StoreRows(const float* samples, int rows, std::int64_t count, std::int64_t width, float* layer)
{
  for (int row = 0; row < rows; ++row) {
    std::memcpy(layer + row * width, samples + row * count,
                static_cast<std::size_t>(count) * sizeof(float));
  }
}

/// A whole piece in the rows of a layer, which is `width` wide; its values there are from `layer`
/// on.
void EvaluatePiece(const ModelView& model, const LatticeAxis& y, std::int64_t width,
                   LevelPiece* pieces, StripPair& strips, float* layer)
{
  const int tiles = HiddenTiles(model);
  const int units = HasFarLevels(model) ? model.levelCount : 0;
  Coordinates heights;
  LoadCoordinates(y.u, RowsFrom(y, 0, StripHeight), heights);
  for (std::int64_t j = 0; j < y.count; j += StripHeight) {
    const int rows = RowsFrom(y, j, StripHeight);
    EncodeStrip(model, heights, WholeRows(rows), pieces, strips.in.values);
    const int next = RowsFrom(y, j + StripHeight, StripHeight);
    if (next > 0) {
      LoadCoordinates(y.u + j + StripHeight, next, heights);
    }
    const FetchRows fetch{model, heights, next, pieces};
    Evenly between(fetch, next > 0 ? units : 0, tiles);
    float outputs[StripSize];
    RunStrip(model, strips, rows * PieceWidth, outputs, between);
    StoreRows(outputs, rows, PieceWidth, width, layer + j * width);
  }
}

/// Encodes `rows` rows of a piece and moves the first `count` samples of each, one row after the
/// other, into strips.in; the last one is repeated up to a whole vector. strips.out is scratch.
void EncodeThinStrip(const ModelView& model, const float* y, int rows, int count,
                     LevelPiece* pieces, StripPair& strips)
{
  for (int begin = 0; begin < rows; begin += StripHeight) {
    const int some = rows - begin < StripHeight ? rows - begin : StripHeight;
    Coordinates heights;
    LoadCoordinates(y + begin, some, heights);
    EncodeStrip(model, heights, some, pieces, strips.out.values);
    for (int f = 0; f < model.encodedWidth; ++f) {
      const float* const from = strips.out.values + f * StripSize;
      float* const to = strips.in.values + f * StripSize + begin * count;
      for (int row = 0; row < some; ++row) {
        for (int k = 0; k < count; ++k) {
          to[row * count + k] = from[row * PieceWidth + k];
        }
      }
    }
  }
  for (int f = 0; f < model.encodedWidth; ++f) {
    float* const samples = strips.in.values + f * StripSize;
    for (int k = rows * count; k % LaneCount != 0; ++k) {
      samples[k] = samples[k - 1];
    }
  }
}

/// The same of a piece of which only the first `count` samples of a row are wanted: the network,
/// which is most of the work, is asked for no others. What these few need of the grid, they share;
/// nothing is fetched ahead.
void EvaluateThinPiece(const ModelView& model, const LatticeAxis& y, int count, std::int64_t width,
                       LevelPiece* pieces, StripPair& strips, float* layer)
{
  const int height = StripSize / count;
  for (std::int64_t j = 0; j < y.count; j += height) {
    const int rows = RowsFrom(y, j, height);
    EncodeThinStrip(model, y.u + j, rows, count, pieces, strips);
    const Coordinates none{};
    const FetchRows fetch{model, none, 0, pieces};
    Evenly between(fetch, 0, HiddenTiles(model));
    float outputs[StripSize];
    RunStrip(model, strips, rows * count, outputs, between);
    StoreRows(outputs, rows, count, width, layer + j * width);
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
      float* const layer = values + k * axes[1].count * width + first;
      if (count == PieceWidth) {
        EvaluatePiece(model, axes[1], width, pieces, strips, layer);
      } else {
        EvaluateThinPiece(model, axes[1], count, width, pieces, strips, layer);
      }
    }
  }
}

} // namespace

const GridKernel Grid = {Workspace, EvaluateGrid};

} // namespace INR_ISA
} // namespace inr

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

/// Rows of a piece that go through the network together, of one layer or of several.
struct PackedRows
{
  explicit PackedRows(int samplesOfRow) : samples(samplesOfRow) {}

  int samples; ///< of a row: as many of the piece's as are wanted
  int rows = 0;
  float* values[StripSize]; ///< where those of each row go

  /// Rows that may be added.
  int room() const { return StripSize / this->samples - this->rows; }
};

/// Rows from j on that are encoded next, as many as a strip of whole pieces holds at most.
int RowsFrom(const LatticeAxis& y, std::int64_t j, int most)
{
  const std::int64_t left = y.count - j;
  most = most < StripHeight ? most : StripHeight;
  return static_cast<int>(left < most ? left : most);
}

/// Adds `rows` rows to those whose encoding is in strips.in. Of a piece that is not wanted as a
/// whole, the samples that are move together: the network, which is most of the work, is asked for
/// no others. strips.out is scratch.
void EncodeMore(const ModelView& model, const Coordinates& heights, int rows,
                const PackedRows& packed, LevelPiece* pieces, StripPair& strips)
{
  float* const begin = strips.in.values + packed.rows * packed.samples;
  if (packed.samples == PieceWidth) {
    EncodeStrip(model, heights, rows, pieces, begin);
    return;
  }
  EncodeStrip(model, heights, rows, pieces, strips.out.values);
  for (int f = 0; f < model.encodedWidth; ++f) {
    const float* const from = strips.out.values + f * StripSize;
    float* const to = begin + f * StripSize;
    for (int row = 0; row < rows; ++row) {
      for (int k = 0; k < packed.samples; ++k) {
        to[row * packed.samples + k] = from[row * PieceWidth + k];
      }
    }
  }
}

/// Repeats the last sample up to a whole vector, so that no number comes up that belongs to no
/// sample.
void FillVector(const ModelView& model, int samples, float* encoded)
{
  for (int f = 0; f < model.encodedWidth; ++f, encoded += StripSize) {
    for (int k = samples; k % LaneCount != 0; ++k) {
      encoded[k] = encoded[k - 1];
    }
  }
}

void BeginLayers(const ModelView& model, float z, LevelPiece* pieces)
{
  Coordinates coordinate;
  LoadCoordinates(&z, 1, coordinate);
  for (int l = 0; l < model.levelCount; ++l) {
    BeginLayer(model.levels[l], model.interpolation, coordinate, pieces[l]);
  }
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

/// Evaluates the rows and leaves none. Meanwhile, fetches what comes next.
void RunPacked(const ModelView& model, const FetchRows& next, StripPair& strips, PackedRows& packed)
{
  const int units = next.rows > 0 && HasFarLevels(model) ? model.levelCount : 0;
  Evenly between(next, units, HiddenTiles(model));
  FillVector(model, packed.rows * packed.samples, strips.in.values);
  float outputs[StripSize];
  RunStrip(model, strips, packed.rows * packed.samples, outputs, between);
  for (int row = 0; row < packed.rows; ++row) {
    std::memcpy(packed.values[row], outputs + row * packed.samples,
                static_cast<std::size_t>(packed.samples) * sizeof(float));
  }
  packed.rows = 0;
}

/// The first `samples` of each row of a piece, in all layers of the lattice, whose rows are `width`
/// long; `values` is the first one's place.
void EvaluatePiece(const ModelView& model, const LatticeAxis& y, const LatticeAxis& z, int samples,
                   std::int64_t width, LevelPiece* pieces, StripPair& strips, float* values)
{
  PackedRows packed(samples);
  for (std::int64_t k = 0; k < z.count; ++k) {
    BeginLayers(model, z.u[k], pieces);
    Coordinates heights;
    LoadCoordinates(y.u, RowsFrom(y, 0, StripHeight), heights);
    for (std::int64_t j = 0; j < y.count;) {
      const int rows = RowsFrom(y, j, packed.room());
      EncodeMore(model, heights, rows, packed, pieces, strips);
      for (int row = 0; row < rows; ++row, values += width) {
        packed.values[packed.rows++] = values;
      }
      j += rows;
      const int next = RowsFrom(y, j, StripHeight);
      if (next > 0) {
        LoadCoordinates(y.u + j, next, heights);
      }
      if (packed.room() == 0 || (j == y.count && k + 1 == z.count)) {
        RunPacked(model, {model, heights, next, pieces}, strips, packed);
      }
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
    EvaluatePiece(model, axes[1], axes[2], count, width, pieces, strips, values + first);
  }
}

} // namespace

const GridKernel Grid = {Workspace, EvaluateGrid};

} // namespace INR_ISA
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quality/Quality.h"

#include "Core/Error.h"
#include "Core/GridBox.h"
#include "Core/Training/Quality/Ssim.h"
#include "Core/Training/Volume/Scalars.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

/// Edge in voxels of the parts of a slice that are compared one after the other: SSIM keeps 430
/// bytes for each of their voxels.
constexpr std::int64_t LargestTile = 384;

std::int64_t TilesAlong(std::int64_t voxels) { return (voxels + LargestTile - 1) / LargestTile; }

/// One of `count` parts of a box, side by side along an axis.
GridBox Cut(const GridBox& box, int axis, std::int64_t part, std::int64_t count)
{
  GridBox cut = box;
  const std::int64_t begin = box.size[axis] * part / count;
  cut.first[axis] += begin;
  cut.size[axis] = box.size[axis] * (part + 1) / count - begin;
  return cut;
}

/// A part of a box with what the SSIM windows that begin in it reach beyond it.
GridBox WithWindows(const GridBox& part, const GridBox& box)
{
  if (!SliceSsim::HasWindows(box.size)) {
    return part;
  }
  const glm::i64vec3 reach(SliceSsim::Window - 1, SliceSsim::Window - 1, 0);
  return {part.first, glm::min(part.end() + reach, box.end()) - part.first};
}

/// One slice of a piece at a time: decoded and reference values in normalised units.
class SliceComparison
{
public:
  SliceComparison(const Evaluator& evaluator, const VolumePiece& piece, const GridBox& box,
                  const VolumeInfo& info, const Arena& arena, std::int64_t bandSize)
      : BandSize(bandSize), Source(evaluator), Piece(piece), Box(box), Info(info), Threads(arena),
        SliceSize(static_cast<std::size_t>(box.size.x * box.size.y)), Raw(this->SliceSize),
        Decoded(this->SliceSize), Reference(this->SliceSize)
  {}

  /// `check` receives the fraction done of the box and throws to stop.
  void load(std::int64_t z, const std::function<void(double)>& check)
  {
    const glm::i64vec3 size = this->Box.size;
    const std::int64_t rows = std::max<std::int64_t>(1, this->BandSize / size.x);
    for (std::int64_t y = 0; y < size.y; y += rows) {
      check((static_cast<double>(z) + static_cast<double>(y) / static_cast<double>(size.y)) /
            static_cast<double>(size.z));
      const std::int64_t height = std::min(rows, size.y - y);
      EvaluateLattice(this->Source, this->Threads,
                      VoxelLattice(this->Info.dims, this->Box.first + glm::i64vec3(0, y, z),
                                   {size.x, height, 1}),
                      this->Raw.data() + y * size.x);
    }
    for (std::size_t k = 0; k < this->SliceSize; ++k) {
      this->Raw[k] = NormalisedOutput(this->Raw[k]);
      this->Decoded[k] = this->Raw[k];
    }
    VisitScalars(this->Piece.data, [&](const auto* values) {
      for (std::int64_t y = 0; y < size.y; ++y) {
        this->loadRow(values, y, z);
      }
    });
  }

  /// Of the first `count` voxels of a row.
  QualityMeter::Errors rowErrors(std::int64_t y, std::int64_t count) const
  {
    QualityMeter::Errors errors;
    const std::int64_t begin = y * this->Box.size.x;
    for (std::int64_t k = begin; k < begin + count; ++k) {
      const double difference = std::abs(this->Reference[k] - this->Decoded[k]);
      if (std::isfinite(difference)) {
        errors.squared += difference * difference;
        errors.largest = std::max(errors.largest, difference);
        ++errors.voxels;
      }
    }
    return errors;
  }

  const std::vector<float>& raw() const { return this->Raw; }
  const std::vector<double>& decoded() const { return this->Decoded; }
  const std::vector<double>& reference() const { return this->Reference; }

private:
  template <class T> void loadRow(const T* values, std::int64_t y, std::int64_t z)
  {
    const glm::i64vec3 size = this->Piece.data.dims;
    const glm::i64vec3 at = this->Box.first - this->Piece.first + glm::i64vec3(0, y, z);
    const std::int64_t stride = this->Piece.data.stride;
    const T* const row = values + stride * GridNumber(at, size);
    const double range = this->Info.high - this->Info.low; // its inverse may be infinite
    for (std::int64_t x = 0; x < this->Box.size.x; ++x) {
      this->Reference[static_cast<std::size_t>(y * this->Box.size.x + x)] =
          Above(row[x * stride], this->Info.low) / range;
    }
  }

  std::int64_t BandSize;
  const Evaluator& Source;
  const VolumePiece& Piece;
  GridBox Box;
  const VolumeInfo& Info;
  const Arena& Threads;
  std::size_t SliceSize;
  std::vector<float> Raw;
  std::vector<double> Decoded;
  std::vector<double> Reference;
};

} // namespace

void QualityMeter::Errors::add(const Errors& other)
{
  this->squared += other.squared;
  this->largest = std::max(this->largest, other.largest);
  this->voxels += other.voxels;
}

void QualityMeter::gather(const TrainingGroup& group)
{
  struct Sums
  {
    Errors errors;
    double similarity;
    std::int64_t windows;
  };
  const std::vector<Sums> all = group.valuesOfAll(Sums{this->All, this->Similarity, this->Windows});
  this->All = Errors();
  this->Similarity = 0;
  this->Windows = 0;
  for (const Sums& sums : all) {
    this->All.add(sums.errors);
    this->Similarity += sums.similarity;
    this->Windows += sums.windows;
  }
}

void QualityMeter::add(const VolumePiece& piece, const GridBox& box, CellRanges* decoded,
                       const std::function<void(double)>& check)
{
  const std::int64_t columns = TilesAlong(box.size.x);
  const std::int64_t tiles = columns * TilesAlong(box.size.y);
  for (std::int64_t tile = 0; tile < tiles; ++tile) {
    const GridBox column = Cut(box, 0, tile % columns, columns);
    const GridBox own = Cut(column, 1, tile / columns, tiles / columns);
    this->addTile(piece, own, WithWindows(own, box), decoded, [&](double part) {
      check((static_cast<double>(tile) + part) / static_cast<double>(tiles));
    });
  }
}

/// Of the voxels of `box`, those of `own` count, and all windows.
void QualityMeter::addTile(const VolumePiece& piece, const GridBox& own, const GridBox& box,
                           CellRanges* decoded, const std::function<void(double)>& check)
{
  SliceComparison slice(this->Source, piece, box, this->Info, this->Threads, this->BandSize);
  SliceSsim windows(box.size, this->Threads);
  std::vector<Errors> rows(static_cast<std::size_t>(own.size.y));
  for (std::int64_t z = 0; z < own.size.z; ++z) {
    slice.load(z, check);
    this->Threads.forEachBlock(own.size.y, 16, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t y = begin; y < end; ++y) {
        rows[static_cast<std::size_t>(y)] = slice.rowErrors(y, own.size.x);
      }
    });
    for (const Errors& row : rows) { // in their order, so that threads cannot change the sum
      this->All.add(row);
    }
    windows.addSlice(slice.reference().data(), slice.decoded().data());
    if (decoded != nullptr) {
      const glm::i64vec3 first = own.first + glm::i64vec3(0, 0, z);
      const VolumePiece layer{
          {slice.raw().data(), ScalarType::Float32, {box.size.x, box.size.y, 1}}, first};
      decoded->add(layer, {first, {own.size.x, own.size.y, 1}}, this->Threads);
    }
  }
  this->Similarity += windows.total();
  this->Windows += windows.count();
}

Quality QualityMeter::quality() const
{
  Quality quality{std::numeric_limits<double>::quiet_NaN(),
                  std::numeric_limits<double>::quiet_NaN(),
                  std::numeric_limits<double>::quiet_NaN()};
  if (this->All.voxels > 0) {
    quality.psnr = -10.0 * std::log10(this->All.squared / static_cast<double>(this->All.voxels));
    quality.maxError = this->All.largest * (this->Info.high - this->Info.low);
  }
  if (this->Windows > 0) {
    quality.ssim = this->Similarity / static_cast<double>(this->Windows);
  }
  return quality;
}

DecodedReport MeasureQuality(const Evaluator& evaluator, const VolumeData& volume,
                             const VolumeInfo& info, int macroCellSize, const Arena& arena,
                             const std::function<bool(double)>& keepGoing, std::int64_t bandSize)
{
  VolumeInfo measured = info;
  measured.dims = volume.dims;
  QualityMeter meter(evaluator, measured, arena, bandSize);
  CellRanges cells(volume.dims, macroCellSize);
  meter.add({volume, glm::i64vec3(0)}, &cells, [&](double fraction) {
    if (keepGoing && !keepGoing(fraction)) {
      throw Error(ErrorCode::Cancelled, "stopped while measuring the quality");
    }
  });
  return {meter.quality(), cells.cells(0.0, 1.0, 0.0, MacroCellProvenance::Decoded)};
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quality.h"

#include "Core/Error.h"
#include "Core/Training/Scalars.h"
#include "Core/Training/Ssim.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

/// Sums over one row, added up in row order so that threads cannot change the result.
struct RowError
{
  double squared = 0;
  double largest = 0;
  std::int64_t finite = 0;
};

/// One slice at a time: decoded and reference values in normalised units.
class SliceComparison
{
public:
  SliceComparison(const Evaluator& evaluator, const VolumeData& volume, const VolumeInfo& info,
                  const Arena& arena, std::int64_t bandSize)
      : BandSize(bandSize), Source(evaluator), Volume(volume), Info(info), Threads(arena),
        SliceSize(static_cast<std::size_t>(volume.dims.x * volume.dims.y)), Raw(this->SliceSize),
        Decoded(this->SliceSize), Reference(this->SliceSize)
  {}

  /// `check` receives the fraction done and throws to stop.
  void load(std::int64_t z, const std::function<void(double)>& check)
  {
    const glm::i64vec3 dims = this->Volume.dims;
    const std::int64_t rows = std::max<std::int64_t>(1, this->BandSize / dims.x);
    for (std::int64_t y = 0; y < dims.y; y += rows) {
      check((static_cast<double>(z) + static_cast<double>(y) / static_cast<double>(dims.y)) /
            static_cast<double>(dims.z));
      const std::int64_t height = std::min(rows, dims.y - y);
      EvaluateLattice(this->Source, this->Threads,
                      VoxelLattice(dims, {0, y, z}, {dims.x, height, 1}),
                      this->Raw.data() + y * dims.x);
    }
    const double range = this->Info.high - this->Info.low; // its inverse may be infinite
    const auto count = static_cast<std::int64_t>(this->SliceSize);
    VisitScalars(this->Volume, [&](const auto* values) {
      const auto* slice = values + z * count * this->Volume.stride;
      for (std::int64_t k = 0; k < count; ++k) {
        const auto value = static_cast<double>(slice[k * this->Volume.stride]);
        this->Reference[k] = (value - this->Info.low) / range;
        this->Raw[k] = NormalisedOutput(this->Raw[k]);
        this->Decoded[k] = this->Raw[k];
      }
    });
  }

  RowError rowError(std::int64_t y) const
  {
    RowError error;
    for (std::int64_t k = y * this->Volume.dims.x; k < (y + 1) * this->Volume.dims.x; ++k) {
      const double difference = std::abs(this->Reference[k] - this->Decoded[k]);
      if (std::isfinite(difference)) {
        error.squared += difference * difference;
        error.largest = std::max(error.largest, difference);
        ++error.finite;
      }
    }
    return error;
  }

  const std::vector<float>& raw() const { return this->Raw; }
  const std::vector<double>& decoded() const { return this->Decoded; }
  const std::vector<double>& reference() const { return this->Reference; }

private:
  std::int64_t BandSize;
  const Evaluator& Source;
  const VolumeData& Volume;
  const VolumeInfo& Info;
  const Arena& Threads;
  std::size_t SliceSize;
  std::vector<float> Raw;
  std::vector<double> Decoded;
  std::vector<double> Reference;
};

/// First and one-past-last cell whose voxels or apron hold voxel v.
struct CellSpan
{
  std::int64_t begin;
  std::int64_t end;
};

CellSpan CellsTouching(std::int64_t voxel, std::int64_t edge, std::int64_t cells)
{
  const std::int64_t first = std::max<std::int64_t>(voxel - MacroCellApron, 0) / edge;
  const std::int64_t last = (voxel + MacroCellApron) / edge;
  return {first, std::min(last + 1, cells)};
}

/// Adds slice z to every cell that it or its apron touches; rows of cells in parallel.
void ExtendCells(MacroCells& cells, const std::vector<float>& slice, const glm::i64vec3& dims,
                 std::int64_t edge, std::int64_t z, const Arena& arena)
{
  const CellSpan layers = CellsTouching(z, edge, cells.dims.z);
  arena.forEachBlock(cells.dims.y, 1, [&](std::int64_t cellY, std::int64_t) {
    std::vector<ValueRange> row(static_cast<std::size_t>(cells.dims.x));
    const std::int64_t firstY = std::max<std::int64_t>(cellY * edge - MacroCellApron, 0);
    const std::int64_t lastY = std::min((cellY + 1) * edge + MacroCellApron, dims.y);
    for (std::int64_t y = firstY; y < lastY; ++y) {
      for (std::int64_t x = 0; x < dims.x; ++x) {
        const float value = slice[static_cast<std::size_t>(y * dims.x + x)];
        const CellSpan columns = CellsTouching(x, edge, cells.dims.x);
        for (std::int64_t cellX = columns.begin; cellX < columns.end; ++cellX) {
          row[static_cast<std::size_t>(cellX)].extend(value);
        }
      }
    }
    for (std::int64_t cellZ = layers.begin; cellZ < layers.end; ++cellZ) {
      for (std::int64_t cellX = 0; cellX < cells.dims.x; ++cellX) {
        ValueRange& range =
            cells.ranges[static_cast<std::size_t>(cells.index(cellX, cellY, cellZ))];
        range.extend(row[static_cast<std::size_t>(cellX)].low);
        range.extend(row[static_cast<std::size_t>(cellX)].high);
      }
    }
  });
}

} // namespace

DecodedReport MeasureQuality(const Evaluator& evaluator, const VolumeData& volume,
                             const VolumeInfo& info, int macroCellSize, const Arena& arena,
                             const std::function<bool(double)>& keepGoing, std::int64_t bandSize)
{
  const glm::i64vec3 dims = volume.dims;
  DecodedReport report;
  report.macroCells = MakeMacroCells(dims, macroCellSize);
  report.macroCells.provenance = MacroCellProvenance::Decoded;
  report.macroCells.apron = static_cast<double>(MacroCellApron) / glm::dvec3(dims);
  SliceComparison slice(evaluator, volume, info, arena, bandSize);
  SliceSsim ssim(dims.x, dims.y, arena);
  RowError all;
  std::vector<RowError> rows(static_cast<std::size_t>(dims.y));
  const auto check = [&](double fraction) {
    if (keepGoing && !keepGoing(fraction)) {
      throw Error(ErrorCode::Cancelled, "stopped while measuring the quality");
    }
  };
  for (std::int64_t z = 0; z < dims.z; ++z) {
    slice.load(z, check);
    arena.forEachBlock(dims.y, 16, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t y = begin; y < end; ++y) {
        rows[static_cast<std::size_t>(y)] = slice.rowError(y);
      }
    });
    for (const RowError& row : rows) {
      all.squared += row.squared;
      all.largest = std::max(all.largest, row.largest);
      all.finite += row.finite;
    }
    ssim.addSlice(slice.reference().data(), slice.decoded().data());
    ExtendCells(report.macroCells, slice.raw(), dims, macroCellSize, z, arena);
  }
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const double voxels = static_cast<double>(all.finite);
  report.quality.psnr = all.finite > 0 ? -10.0 * std::log10(all.squared / voxels) : unknown;
  report.quality.ssim = ssim.mean();
  report.quality.maxError = all.finite > 0 ? all.largest * (info.high - info.low) : unknown;
  return report;
}

} // namespace inr

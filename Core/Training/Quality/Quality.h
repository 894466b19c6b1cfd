// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"
#include "Core/Training/Quality/CellRanges.h"
#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Volume/Volume.h"

#include <cstdint>
#include <functional>

namespace inr {

/// Compares a volume with what an INR says of it, box by box.
class QualityMeter
{
public:
  /// `info` gives the dimensions and the value range, low < high.
  QualityMeter(const Evaluator& evaluator, const VolumeInfo& info, const Arena& arena,
               std::int64_t bandSize = 1 << 20)
      : Source(evaluator), Info(info), Threads(arena), BandSize(bandSize)
  {}

  /// Decodes the voxels of a piece and compares, a part of a slice at a time. `decoded`, if any,
  /// takes in their normalised values. `check` receives the fraction done of the piece, after so
  /// many voxels as `bandSize` says, in whole rows, and throws to stop; the last bit of a position
  /// may depend on that.
  void add(const VolumePiece& piece, CellRanges* decoded, const std::function<void(double)>& check)
  {
    this->add(piece, {piece.first, piece.data.dims}, decoded, check);
  }
  /// The same of a box within a piece.
  void add(const VolumePiece& piece, const GridBox& box, CellRanges* decoded,
           const std::function<void(double)>& check);

  /// Of all finite voxels, and of the SSIM windows that lie within one piece; see MeasureQuality.
  Quality quality() const;

  /// Takes in what others have compared, in their order.
  void gather(const TrainingGroup& group);

  /// Sums over voxels, in normalised units.
  struct Errors
  {
    double squared = 0;
    double largest = 0;
    std::int64_t voxels = 0; ///< that are finite

    void add(const Errors& other);
  };
  const Errors& errors() const { return this->All; }

private:
  void addTile(const VolumePiece& piece, const GridBox& own, const GridBox& box,
               CellRanges* decoded, const std::function<void(double)>& check);

  const Evaluator& Source;
  VolumeInfo Info;
  const Arena& Threads;
  std::int64_t BandSize;
  Errors All;
  double Similarity = 0;
  std::int64_t Windows = 0;
};

/// What one pass over all decoded voxels gives.
struct DecodedReport
{
  Quality quality;
  MacroCells macroCells; ///< of the decoded values, with an apron of MacroCellApron voxels
};

/// Decodes every voxel of `volume` and compares: PSNR with the range as peak; SSIM in 3D (uniform
/// 7^3 window fully inside, K1 0.01, K2 0.03, sample covariance: scikit-image's
/// `structural_similarity(win_size=7, data_range=1)`); the largest difference. Windows and voxels
/// that hold a NaN or infinity are left out; where none is left, the figure is NaN. `info` gives
/// the value range, low < high; `keepGoing` receives the fraction done and returns false to stop
/// (Error(Cancelled)).
DecodedReport MeasureQuality(const Evaluator& evaluator, const VolumeData& volume,
                             const VolumeInfo& info, int macroCellSize, const Arena& arena,
                             const std::function<bool(double)>& keepGoing,
                             std::int64_t bandSize = 1 << 20);

} // namespace inr

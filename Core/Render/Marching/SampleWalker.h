// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/CellWalker.h"
#include "Core/Render/MacroCells/SeenSpan.h"
#include "Core/Render/Marching/ClosedStretch.h"
#include "Core/Render/Marching/MarchSettings.h"
#include "Core/Render/Marching/OpenStretch.h"
#include "Core/Render/Marching/SampleStretch.h"
#include "Core/Render/Marching/StepLattice.h"
#include "Core/Render/Rays/LevelOfDetail.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstdint>

namespace inr {

/// Where the samples of a ray are: every 2^l steps where it deserves level l of the cache and the
/// one before; up to four such at once where little can be seen; nowhere in cells that are
/// invisible. Places count steps of t, and samples sit on a lattice of the ray's own: one that
/// stands for n steps from interval k on is at place k + jitter * n. So what is skipped does not
/// move what follows, and where a walk was interrupted makes no difference.
///
/// Where cells say where their samples come from, one that stands for n steps is in the middle of
/// the n that it takes the place of, at k + jitter + (n - 1)/2: those would add up to the same but
/// for what the field bends between them.
class SampleWalker
{
public:
  /// `scale` and `levels` are LevelOfDetail's; `jitter` is in [0, 1]. With 1, where samples are at
  /// the ends of what they stand for, there is one at t = 0, too.
  INR_HOST_DEVICE SampleWalker(const MajorantsView& majorants, const MarchSettings& settings,
                               const Ray& ray, double scale, int levels, double jitter)
      : Detail(ray, scale, levels), Cells(majorants, settings.dims, ray, scale, levels),
        Jitter(jitter), Shared(settings.projector.findsSurfaces()), End(ray.length / settings.step),
        PieceBegin(ray.pieceBegin / settings.step), PieceEnd(ray.pieceEnd / settings.step),
        Next(jitter < 1.0 || !(ray.length > 0) ? 0 : -1)
  {}

  /// Says, before anything else, that nothing can be seen of the ray but in a span of it.
  INR_HOST_DEVICE void confine(const SeenSpan& seen, const MarchSettings& settings)
  {
    this->SeenEnd = seen.end / settings.step;
    if (seen.empty()) {
      this->Next = static_cast<std::int64_t>(this->End) + 1;
      return;
    }
    this->moveDetail(settings);
    // Where pieces share samples, one may begin in this piece and be behind it, in cells that are.
    if (!this->Shared && this->firstPlace() * settings.step < seen.begin) {
      this->skipTo(seen.begin, settings);
    }
  }

  /// Moves on to the next sample of the ray's piece that may be seen; false when there is none.
  /// Where surfaces are looked for, the last one may be behind the piece.
  INR_HOST_DEVICE bool moveToVisible(const MarchSettings& settings)
  {
    while (this->moveAlongRay(settings)) {
      if (this->isInPiece()) {
        return true;
      }
      const AlikeSamples samples = this->alikeOnRay();
      if (this->belongsFrom(samples) >= this->PieceEnd) {
        return false;
      }
      if (static_cast<double>(this->Next) + this->offset(samples) >= this->PieceBegin) {
        return true;
      }
      const double first = static_cast<double>(this->Next) + this->offset(samples);
      this->pass(samples, CountOf(samples, this->PieceBegin - first));
    }
    return false;
  }

  /// The samples from here on, as far as they lie in the stretch and on the ray's piece; there is
  /// one.
  INR_HOST_DEVICE AlikeSamples alike() const
  {
    AlikeSamples samples = this->alikeOnRay();
    if (samples.count > 1 && this->Stretch.exit > this->PieceEnd) {
      samples.count = CountOf(samples, this->PieceEnd - this->belongsFrom(samples));
    }
    return samples;
  }

  /// Goes past `count` of such samples.
  INR_HOST_DEVICE void pass(const AlikeSamples& samples, int count)
  {
    this->Next += count * samples.steps();
  }

  /// From the first one's interval to the place of such samples.
  INR_HOST_DEVICE double offset(const AlikeSamples& samples) const
  {
    const double offset = this->offsetIn(samples.steps());
    return samples.last ? glm::min(offset, this->End - static_cast<double>(this->Next)) : offset;
  }
  /// Steps that the ray's last sample stands for.
  INR_HOST_DEVICE double rest() const { return this->End - static_cast<double>(this->Next); }

  INR_HOST_DEVICE std::int64_t next() const { return this->Next; } ///< lattice interval
  INR_HOST_DEVICE double end() const { return this->End; }         ///< place where the ray ends
  INR_HOST_DEVICE const SampleStretch& stretch() const { return this->Stretch; }
  INR_HOST_DEVICE const LevelOfDetail& detail() const { return this->Detail; }
  INR_HOST_DEVICE std::int64_t visited() const { return this->Cells.visited(); } ///< macro-cells

  /// Goes back to `interval` of a stretch, from where this walk came by when it was as it is.
  INR_HOST_DEVICE void resume(std::int64_t interval, const SampleStretch& stretch,
                              const MarchSettings& settings)
  {
    this->Next = interval;
    this->Stretch = stretch;
    if (stretch.closed) {
      this->Detail.fix(stretch.level);
    } else {
      this->Detail.moveTo(static_cast<double>(interval) * settings.step);
    }
  }

private:
  static constexpr double Plenty = 1024; ///< more samples than anybody asks for at once

  /// To the next sample of the whole ray that may be seen.
  INR_HOST_DEVICE bool moveAlongRay(const MarchSettings& settings)
  {
    while (static_cast<double>(this->Next) < this->End) {
      if (static_cast<double>(this->Next) < this->Stretch.levelEnd &&
          this->firstPlace() < this->Stretch.exit) {
        return true;
      }
      this->moveDetail(settings);
      this->Cells.moveTo(this->firstPlace() * settings.step);
      if (this->Cells.extinction() > 0.0f || this->isLeaving(settings)) {
        this->beginStretch(settings);
        return true;
      }
      const double last = glm::min(glm::min(this->End, this->PieceEnd), this->SeenEnd);
      if (!this->Cells.moveToVisible(last * settings.step)) {
        return false;
      }
      this->skipTo(this->Cells.enter(), settings);
    }
    return false;
  }

  INR_HOST_DEVICE void moveDetail(const MarchSettings& settings)
  {
    if (settings.cellSampling != nullptr) {
      this->Detail.fix(0); // until the cell is known
    }
    this->Detail.moveTo(static_cast<double>(this->Next) * settings.step);
  }

  /// The samples from here on, whichever piece they are in.
  INR_HOST_DEVICE AlikeSamples alikeOnRay() const
  {
    const int power = this->shortest();
    const double inverse = PowerOfTwo(-power);
    const auto begin = static_cast<double>(this->Next);
    const double onRay = (this->End - begin) * inverse;
    if (onRay < 1.0) {
      return {1, 1, power, true};
    }
    // Up to the next interval of so many; and what is in front of the ray counts for nothing.
    if (power < this->Stretch.power || (this->Next < 0 && this->Stretch.faint > 0)) {
      return {1, 1, power, false};
    }
    if (this->Stretch.closed && power > 0) {
      const double inside = glm::min(this->Stretch.exit, this->End) - begin;
      return {static_cast<int>(glm::min(inside * inverse, Plenty)), 1, power, false};
    }
    const double inCells = (this->Stretch.exit - begin) * inverse - this->Jitter;
    const double inLevel = (this->Stretch.levelEnd - begin) * inverse;
    const int count = glm::min(CountBelow(glm::min(inCells, inLevel), Plenty),
                               static_cast<int>(glm::min(onRay, Plenty)));
    const int joined = count >> this->Stretch.faint;
    return joined == 0 ? AlikeSamples{1, count, power, false}
                       : AlikeSamples{joined, 1 << this->Stretch.faint, power, false};
  }

  /// Whether that goes without counting.
  INR_HOST_DEVICE bool isInPiece() const
  {
    return static_cast<double>(this->Next) >= this->PieceBegin &&
           this->Stretch.exit <= this->PieceEnd;
  }

  /// Where a piece must not have ended for the first of such samples to belong to it: at its place.
  /// Where surfaces are looked for, all pieces take it that meet what it stands for.
  INR_HOST_DEVICE double belongsFrom(const AlikeSamples& samples) const
  {
    const auto begin = static_cast<double>(this->Next);
    return this->Shared ? begin : begin + this->offset(samples);
  }

  /// How many of these samples, the first of them in any case, begin on a way of `length`.
  INR_HOST_DEVICE static int CountOf(const AlikeSamples& samples, double length)
  {
    return CountBelow(length / static_cast<double>(samples.steps()), samples.count);
  }

  /// log2 of the steps that the next sample stands for at least: as many as others here, if the
  /// lattice has such an interval and a closed stretch has room for it.
  INR_HOST_DEVICE int shortest() const
  {
    constexpr int any = 62;
    const auto bits = static_cast<std::uint64_t>(this->Next);
    const int most = this->Stretch.closed ? this->Stretch.power : this->Detail.coarsest();
    int power = glm::min(most, bits == 0 ? any : LowestBit(bits));
    if (this->Stretch.closed) {
      const double room = glm::min(this->Stretch.exit, this->End) - static_cast<double>(this->Next);
      while (power > 0 && PowerOfTwo(power) > room) {
        --power;
      }
    }
    return power;
  }

  INR_HOST_DEVICE static int LowestBit(std::uint64_t bits)
  {
#ifdef __CUDA_ARCH__
    return __ffsll(static_cast<long long>(bits)) - 1;
#else
    return __builtin_ctzll(bits);
#endif
  }

  /// From the beginning of so many steps to the sample that stands for them.
  INR_HOST_DEVICE double offsetIn(std::int64_t steps) const
  {
    const auto length = static_cast<double>(steps);
    return this->Stretch.closed ? this->Jitter + 0.5 * (length - 1.0) : this->Jitter * length;
  }

  INR_HOST_DEVICE double firstPlace() const
  {
    const double place =
        static_cast<double>(this->Next) + this->offsetIn(std::int64_t{1} << this->shortest());
    return glm::min(place, this->End);
  }

  /// To the first sample at t or behind it.
  INR_HOST_DEVICE void skipTo(double t, const MarchSettings& settings)
  {
    this->Detail.moveTo(t);
    const double place = t / settings.step;
    const int level = this->Detail.coarsest();
    const auto first =
        static_cast<std::int64_t>(std::ceil(place * PowerOfTwo(-level) - this->Jitter));
    this->Next = glm::max(this->Next + 1, first * (std::int64_t{1} << level));
    // Between two levels' intervals the first sample may turn out to be a shorter one.
    this->Detail.moveTo(static_cast<double>(this->Next) * settings.step);
    while (this->firstPlace() < glm::min(place, this->End)) {
      this->Next += std::int64_t{1} << this->shortest();
      this->Detail.moveTo(static_cast<double>(this->Next) * settings.step);
    }
  }

  /// Whether the steps of the next sample, which is behind cells that matter, begin in one of them:
  /// where both ends of samples are looked at, it is the other one.
  INR_HOST_DEVICE bool isLeaving(const MarchSettings& settings) const
  {
    return settings.looksAtBothEnds() && static_cast<double>(this->Next) < this->Stretch.reach;
  }

  INR_HOST_DEVICE void beginStretch(const MarchSettings& settings)
  {
    const StretchStart start{static_cast<double>(this->Next), this->firstPlace(), this->End,
                             this->Stretch.reach};
    if (settings.cellSampling == nullptr) {
      this->Stretch = FindOpenStretch(this->Cells, this->Detail, start, settings);
      return;
    }
    this->Stretch = FindClosedStretch(this->Cells, start, settings);
    this->Detail.fix(this->Stretch.level);
    this->Stretch.levelEnd = this->Detail.exit();
  }

  LevelOfDetail Detail;
  CellWalker Cells;
  SampleStretch Stretch;
  double Jitter;
  bool Shared; ///< samples that stand for steps in several pieces, by all of these
  double End;
  double PieceBegin;
  double PieceEnd;
  double SeenEnd = Infinite; ///< behind it all cells are invisible
  std::int64_t Next;         ///< lattice interval that comes next
};

} // namespace inr

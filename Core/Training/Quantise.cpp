// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quantise.h"

#include "Core/GridBox.h"
#include "Core/Model/ModelFile.h"
#include "Core/Model/Quantised.h"
#include "Core/Training/ModelSize.h"

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// Of the output's range: an error of -100 dB is never too large, or an exact fit could not be
/// quantised at all.
constexpr double NegligibleError = 1e-10;
/// What a group seems to do to the output at least: less is lost in the arithmetic.
constexpr double SmallestEffect = 1e-16;
constexpr int StepsPerOctave = 8;
/// Voxels with fewer finite values say nothing of a tenth of a dB.
constexpr std::int64_t FewestKnown = 1000;
/// Beyond that a file cannot become small enough at all: its macro-cells are too many.
constexpr double MostCoarsening = 64.0;

/// Sets to 0 what the padding of a network multiplies: input columns that are 0, and all rows of
/// the last matrix but the first.
void ClearPadding(const Layout& layout, AlignedVector<float>& parameters)
{
  const LayerShape& first = layout.layers.front();
  for (int row = 0; row < first.rows; ++row) {
    float* weights = parameters.data() + first.offset +
                     static_cast<std::size_t>(row) * static_cast<std::size_t>(first.columns);
    std::fill(weights + layout.encodedWidth, weights + first.columns, 0.0f);
  }
  const LayerShape& last = layout.layers.back();
  float* weights = parameters.data() + last.offset;
  std::fill(weights + last.columns,
            weights + static_cast<std::size_t>(last.rows) * static_cast<std::size_t>(last.columns),
            0.0f);
}

/// One group's parameters, and how its step is found.
struct GroupShape
{
  ParameterGroup where;
  float largest = 0;      ///< magnitude
  double relative = 0;    ///< step over that of other groups
  std::uint64_t live = 0; ///< parameters that matter
};

/// Mean squared errors.
struct ErrorLimit
{
  double own;  ///< of the network as it was
  double most; ///< that quantising may leave

  double more() const { return this->most - this->own; }
};

class Quantiser
{
public:
  Quantiser(Model& model, const PsnrEstimate& estimate, const EvaluateKernel& kernel,
            const StopCheck& check)
      : Result(model), Estimate(estimate), Kernel(kernel), Check(check), Shape(model.description),
        Views(model.description, this->Shape, model.parameters.data()), Original(model.parameters),
        Exact(this->values())
  {
    for (const ParameterGroup& where : ParameterGroups(model.description)) {
      this->Groups.push_back(this->measure(where));
    }
  }

  /// The coarsest steps that cost so many dB at most; false when there are none.
  bool keepLoss(double decibels)
  {
    const PsnrEstimate few = this->Estimate.first(this->Estimate.voxels() / 8);
    const ErrorLimit limit = this->limitOn(this->Estimate, decibels);
    const ErrorLimit limitOnFew = this->limitOn(few, decibels);
    double live = 1;
    for (const GroupShape& group : this->Groups) {
      live += static_cast<double>(group.live);
    }
    // As if errors were independent of each other and of what the training left.
    const double expected = std::sqrt(limit.more() / live);
    constexpr int coarsest = 2 * StepsPerOctave;
    constexpr int finest = -16 * StepsPerOctave;
    for (int k = coarsest; k >= finest; --k) {
      this->apply(expected * std::exp2(static_cast<double>(k) / StepsPerOctave));
      // Most steps are so much too coarse that a part of the voxels is enough to see it.
      const bool isHopeless = this->error(few) > limitOnFew.own + 2 * limitOnFew.more();
      if (!isHopeless && this->error(this->Estimate) <= limit.most) {
        return true;
      }
    }
    return false;
  }

  /// Coarser steps until the file is small enough.
  void keepSize(std::int64_t largest)
  {
    const double wanted = this->Scale;
    const auto count = static_cast<double>(this->Original.size());
    for (std::int64_t size = ModelFileSize(this->Result); size > largest;
         size = ModelFileSize(this->Result)) {
      this->Check.goesOn(); // throws where it is to stop
      // A step twice as coarse saves a bit of each parameter, or less.
      const double excessBits = 8.0 * static_cast<double>(size - largest) / count;
      this->apply(this->Scale * std::exp2(std::max(excessBits, 1.0 / StepsPerOctave)));
      if (this->Scale > wanted * MostCoarsening) {
        this->apply(wanted);
        return;
      }
    }
  }

  void restore()
  {
    this->Result.parameters = this->Original;
    this->Result.steps.clear();
  }

private:
  std::vector<float> values() const
  {
    return this->Estimate.values(this->Views.view(), this->Kernel, this->Check);
  }

  double error(const PsnrEstimate& estimate) const
  {
    return estimate.squaredError(estimate.values(this->Views.view(), this->Kernel, this->Check));
  }

  /// While the network is as it was.
  ErrorLimit limitOn(const PsnrEstimate& estimate, double decibels) const
  {
    const double own = this->error(estimate);
    return {own, own * std::pow(10.0, decibels / 10.0) + NegligibleError};
  }

  float* parametersOf(const ParameterGroup& where)
  {
    return this->Result.parameters.data() + where.offset;
  }

  /// What a step that is moderate for the group does to the output.
  GroupShape measure(const ParameterGroup& where)
  {
    GroupShape group;
    group.where = where;
    float* parameters = this->parametersOf(where);
    double squares = 0;
    for (std::uint64_t k = 0; k < where.count; ++k) {
      group.largest = std::max(group.largest, std::abs(parameters[k]));
      squares += static_cast<double>(parameters[k]) * parameters[k];
    }
    const double size = std::sqrt(squares / static_cast<double>(where.count));
    const float step =
        std::clamp(static_cast<float>(size / 8), FinestStep(group.largest), LargestStep);
    RoundToStep(parameters, where.count, step);
    group.live = where.count -
                 static_cast<std::uint64_t>(std::count(parameters, parameters + where.count, 0.0f));
    const double effect =
        std::max(this->Estimate.squaredDifference(this->values(), this->Exact), SmallestEffect) /
        step / step;
    group.relative = std::sqrt(static_cast<double>(group.live) / effect);
    std::copy_n(this->Original.data() + where.offset, where.count, parameters);
    return group;
  }

  void apply(double scale)
  {
    this->Scale = scale;
    this->Result.steps.clear();
    for (const GroupShape& group : this->Groups) {
      // Anything beyond twice the largest parameter gives zeros, too.
      const double most = std::min<double>(4.0 * group.largest, LargestStep);
      const auto step = static_cast<float>(std::min(scale * group.relative, most));
      this->Result.steps.push_back(std::max(step, FinestStep(group.largest)));
      float* parameters = this->parametersOf(group.where);
      std::copy_n(this->Original.data() + group.where.offset, group.where.count, parameters);
      RoundToStep(parameters, group.where.count, this->Result.steps.back());
    }
  }

  Model& Result;
  const PsnrEstimate& Estimate;
  const EvaluateKernel& Kernel;
  const StopCheck& Check;
  Layout Shape;
  ModelViewStorage Views;
  AlignedVector<float> Original;
  std::vector<float> Exact; ///< values of the network as it was
  std::vector<GroupShape> Groups;
  double Scale = 0;
};

} // namespace

QuantiseLimits LimitsForRatio(const Model& model, double ratio)
{
  constexpr std::int64_t qualityBytes = 256; // in the file, but not in the model yet
  QuantiseLimits limits;
  if (ratio > 0) {
    const glm::dvec3 dims(model.volume.dims);
    const double bytes =
        GridCount(dims) * static_cast<double>(ScalarSize(model.volume.type)) / ratio;
    const auto cells = static_cast<std::int64_t>(model.macroCells.ranges.size());
    const double edge = model.macroCells.spacing.x * dims.x;
    const double others = ExpectedRangeBytes(edge, cells) + qualityBytes;
    limits.fileSize = static_cast<std::int64_t>(std::clamp(bytes - others, 1.0, 0x1p31));
  }
  return limits;
}

void Quantise(Model& model, const PsnrEstimate& estimate, const EvaluateKernel& kernel,
              const QuantiseLimits& limits, const StopCheck& check)
{
  model.storedAs = ParameterType::Quantised;
  ClearPadding(Layout(model.description), model.parameters);
  Quantiser quantiser(model, estimate, kernel, check);
  if (estimate.known() < FewestKnown || !quantiser.keepLoss(limits.loss)) {
    model.storedAs = ParameterType::Half;
    quantiser.restore();
  } else if (limits.fileSize > 0) {
    quantiser.keepSize(limits.fileSize);
  }
}

} // namespace inr

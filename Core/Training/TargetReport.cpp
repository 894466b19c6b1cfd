// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/TargetReport.h"

#include "Core/NumberText.h"

namespace inr {

namespace {

constexpr double Negligible = 0.1; // dB, which an estimate of ordinary data may be off

std::string Decibels(double value) { return DecimalText(value, 2) + " dB"; }

std::string Reason(const TrainingRecord& training, const TrainingOptions& options)
{
  if (options.maximumSteps > 0 && training.steps >= options.maximumSteps) {
    return "MaximumSteps ended the training before it was reached";
  }
  if (options.timeLimit > 0 && training.seconds >= options.timeLimit) {
    return "TimeLimit ended the training before it was reached";
  }
  if (options.targetRatio > 0) {
    return "it was reached before the parameters were packed to TargetRatio";
  }
  return "it was reached on random voxels, which miss a part of the error of these data; set it as "
         "much higher";
}

} // namespace

std::string ShortOfTarget(const Model& model, const TrainingOptions& options)
{
  if (options.targetPsnr <= 0 || !model.quality || !model.training) {
    return "";
  }
  const double missing = options.targetPsnr - model.quality->psnr;
  if (!(missing > Negligible)) {
    return "";
  }
  return "the PSNR is " + Decibels(model.quality->psnr) + ", " + Decibels(missing) +
         " below TargetPSNR: " + Reason(*model.training, options);
}

} // namespace inr

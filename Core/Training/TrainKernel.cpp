// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Inference/Lanes.h.
#include "Core/Training/TrainKernel.h"

#include "Core/Training/Backpropagate.h"

namespace inr {
namespace INR_ISA {

namespace {

template <int Features>
void ScatterLanes(const Corners& corners, const float* gradient, int lanes, float* table)
{
  for (int k = 0; k < lanes; ++k) {
    Row<Features> own;
    for (int f = 0; f < Features; ++f) {
      own[f] = gradient[f * TrainBlockSize + k];
    }
    for (int c = 0; c < 8; ++c) {
      float* entry = table + static_cast<std::uint64_t>(corners.entry[c][k]) * Features;
      Row<Features> row;
      std::memcpy(&row, entry, sizeof(row));
      row += corners.weight[c][k] * own;
      std::memcpy(entry, &row, sizeof(row));
    }
  }
}

template <int Features>
void ScatterLevel(const ModelView& model, int level, const float* xyz, std::int64_t count,
                  const float* encodedGradient, float* gridGradient)
{
  const LevelView& grid = model.levels[level];
  float* table = gridGradient + grid.offset;
  Corners corners;
  for (std::int64_t first = 0; first < count; first += LaneCount) {
    const std::int64_t block = first / TrainBlockSize;
    const float* gradient = encodedGradient + block * model.encodedWidth * TrainBlockSize +
                            level * Features * TrainBlockSize + first % TrainBlockSize;
    const std::int64_t left = count - first;
    FindCorners(grid, model.interpolation, LoadPositions(xyz + 3 * first, left), corners);
    ScatterLanes<Features>(corners, gradient, left < LaneCount ? static_cast<int>(left) : LaneCount,
                           table);
  }
}

void Scatter(const ModelView& model, int level, const float* xyz, std::int64_t count,
             const float* encodedGradient, float* gridGradient)
{
  switch (model.features) {
  case 1:
    return ScatterLevel<1>(model, level, xyz, count, encodedGradient, gridGradient);
  case 2:
    return ScatterLevel<2>(model, level, xyz, count, encodedGradient, gridGradient);
  case 4:
    return ScatterLevel<4>(model, level, xyz, count, encodedGradient, gridGradient);
  default:
    return ScatterLevel<8>(model, level, xyz, count, encodedGradient, gridGradient);
  }
}

inline void AdamUpdate(const AdamRun& run, std::int64_t k, float learningRate)
{
  const float gradient = run.gradients[k] + run.decay * run.parameters[k];
  const float first = run.beta1 * run.firstMoments[k] + (1.0f - run.beta1) * gradient;
  const float second = run.beta2 * run.secondMoments[k] + (1.0f - run.beta2) * gradient * gradient;
  run.firstMoments[k] = first;
  run.secondMoments[k] = second;
  run.parameters[k] -= learningRate * first / (__builtin_sqrtf(second) + run.epsilon);
}

void Adam(const AdamRun& run, std::int64_t count, float learningRate)
{
  for (std::int64_t k = 0; k < count; ++k) {
    AdamUpdate(run, k, learningRate);
  }
}

void AdamSparse(const AdamRun& run, std::int64_t entries, int features, float learningRate,
                std::uint32_t* steps, const float* corrections, std::uint32_t last)
{
  for (std::int64_t e = 0; e < entries; ++e) {
    bool touched = false;
    for (int f = 0; f < features; ++f) {
      touched |= run.gradients[e * features + f] != 0.0f;
    }
    if (!touched) {
      continue;
    }
    const std::uint32_t step = ++steps[e];
    const float corrected = learningRate * corrections[step < last ? step : last];
    for (int f = 0; f < features; ++f) {
      AdamUpdate(run, e * features + f, corrected);
    }
  }
}

std::int64_t Workspace(const ModelView& model) { return Activity::size(model); }

} // namespace

const TrainKernel Train = {Workspace, BackpropagateBlock, Scatter, Adam, AdamSparse};

} // namespace INR_ISA
} // namespace inr

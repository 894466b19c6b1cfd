// SPDX-License-Identifier: BSD-3-Clause
//
// Built once per instruction set; see Inference/Lanes.h.
#include "Core/Training/Descent/TrainKernel.h"

#include "Core/Training/Descent/AdamUpdate.h"
#include "Core/Training/Descent/Backpropagate.h"
#include "Core/Training/Descent/LevelPasses.h"
#include "Core/Training/Descent/OrthogonalUpdate.h"

namespace inr {
namespace INR_ISA {

namespace {

void Encode(const ModelView& model, int level, const float* xyz, std::int64_t count, float* encoded)
{
  switch (model.features) {
  case 1:
    return EncodeLevel<1>(model, level, xyz, count, encoded);
  case 2:
    return EncodeLevel<2>(model, level, xyz, count, encoded);
  case 4:
    return EncodeLevel<4>(model, level, xyz, count, encoded);
  default:
    return EncodeLevel<8>(model, level, xyz, count, encoded);
  }
}

void Scatter(const ModelView& model, int level, const float* xyz, std::int64_t count,
             const float* encodedGradient, const LevelGradient& gradient)
{
  switch (model.features) {
  case 1:
    return ScatterLevel<1>(model, level, xyz, count, encodedGradient, gradient);
  case 2:
    return ScatterLevel<2>(model, level, xyz, count, encodedGradient, gradient);
  case 4:
    return ScatterLevel<4>(model, level, xyz, count, encodedGradient, gradient);
  default:
    return ScatterLevel<8>(model, level, xyz, count, encodedGradient, gradient);
  }
}

std::int64_t Workspace(const ModelView& model)
{
  return Activity::size(model) + CacheLineFloats; // it need not begin at a line
}

} // namespace

const TrainKernel Train = {Workspace, Encode,     BackpropagateBlock,  Scatter,
                           AdamAll,   AdamSparse, OrthogonalWorkspace, UpdateOrthogonally};

} // namespace INR_ISA
} // namespace inr

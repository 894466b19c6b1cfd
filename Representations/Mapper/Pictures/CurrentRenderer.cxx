// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/CurrentRenderer.h"

#include "vtkINRDataArray.h"

namespace inr {

bool CurrentRenderer::update(const vtkINRDataArray& array, RendererOptions options)
{
  const ModelPointer& model = array.GetModel();
  // What has failed stays where bricks are that it brought.
  const bool isElsewhere = this->Input != model || !this->Options.accelerator;
  if (options.accelerator == this->GivenUp && isElsewhere) {
    options.accelerator = nullptr;
  }
  if (this->Caster && this->Input == model && this->Options == options) {
    return false;
  }
  this->Caster = std::make_unique<Renderer>(model, options);
  this->Input = model;
  this->Options = options;
  array.GetKeepsake()->Content = this->Caster->keepBricks();
  return true;
}

std::string CurrentRenderer::backendOf(const FrameStatistics& picture) const
{
  const int threads = this->Caster->threads();
  const std::string cpu = "CPU " + this->Caster->kernel() + ", " + std::to_string(threads) +
                          (threads == 1 ? " thread" : " threads");
  const std::string accelerator = this->Caster->accelerator();
  if (accelerator.empty()) {
    return cpu;
  }
  if (picture.accelerated) {
    return accelerator + "; beside it " + cpu;
  }
  return cpu + (this->Options.cached ? "; bricks by " : "; samples by ") + accelerator;
}

void CurrentRenderer::noteFailure()
{
  const auto failure = this->acceleratorFailure();
  if (failure && failure->atWork) {
    this->GivenUp = this->Options.accelerator;
  }
}

} // namespace inr

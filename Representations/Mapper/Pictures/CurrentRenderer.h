// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

class vtkINRDataArray;

namespace inr {

/// The renderer of a mapper's input with the mapper's options, made anew when one of them is
/// another.
class CurrentRenderer
{
public:
  /// Whether it was made anew. Throws what Renderer throws; the former one is there then.
  bool update(const vtkINRDataArray& array, RendererOptions options);

  Renderer* operator->() const { return this->Caster.get(); }
  const Model& model() const { return *this->Input; }
  const RendererOptions& options() const { return this->Options; }

  /// 0 before there is one.
  std::int64_t cacheBytes() const { return this->Caster ? this->Caster->cacheBytes() : 0; }
  std::optional<AcceleratedField::Failure> acceleratorFailure() const
  {
    return this->Caster ? this->Caster->acceleratorFailure() : std::nullopt;
  }
  /// What has computed a picture; see vtkINRVolumeMapper::GetBackendInUse.
  std::string backendOf(const FrameStatistics& picture) const;
  /// After each picture: an accelerator that has failed is not tried with every time step.
  void noteFailure();

private:
  std::unique_ptr<Renderer> Caster;
  ModelPointer Input;
  RendererOptions Options;
  std::shared_ptr<const Accelerator> GivenUp; ///< it has failed
};

} // namespace inr

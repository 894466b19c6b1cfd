// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Acceleration/Accelerator.h"

#include "Core/Render/Acceleration/AcceleratedField.h"

#include <algorithm>

namespace inr {

Accelerator::~Accelerator() = default;

std::shared_ptr<AcceleratedRenderer>
Accelerator::makeRenderer(const ModelPointer&, const glm::i64vec3&, const CacheOptions&) const
{
  return nullptr;
}

std::shared_ptr<AcceleratedRenderer> Accelerator::makeNetworkRenderer(const ModelPointer&) const
{
  return nullptr;
}

std::shared_ptr<AcceleratedField> Accelerator::findLocked(const ModelPointer& model) const
{
  for (const auto& entry : this->Open) {
    if (entry.first.lock() == model) {
      return entry.second.lock();
    }
  }
  return nullptr;
}

std::shared_ptr<AcceleratedField> Accelerator::find(const ModelPointer& model) const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->findLocked(model);
}

std::shared_ptr<AcceleratedField> Accelerator::open(const ModelPointer& model) const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  const auto isGone = [](const auto& entry) { return entry.second.expired(); };
  this->Open.erase(std::remove_if(this->Open.begin(), this->Open.end(), isGone), this->Open.end());
  std::shared_ptr<AcceleratedField> field = this->findLocked(model);
  if (!field) {
    field = std::make_shared<AcceleratedField>(this->shared_from_this(), model);
    this->Open.emplace_back(model, field);
  }
  return field;
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickSource.h"
#include "Core/Cache/CacheOptions.h"
#include "Core/Inference/Evaluator.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace inr {

class AcceleratedField;
class AcceleratedRenderer;

/// A processor beside the CPU that computes what networks give, such as a GPU. One object is for
/// all renderers, on any threads, that are to share models in its memory and the bricks that come
/// of them.
class Accelerator : public std::enable_shared_from_this<Accelerator>
{
public:
  Accelerator() = default;
  virtual ~Accelerator();
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;

  /// What it is and how it computes: "CUDA float32, NVIDIA H200".
  virtual std::string name() const = 0;

  /// Values at points and voxels of bricks, as Core's functions of that name give them to within
  /// float32's rounding. These and what they return throw Error(Device) where it fails, or has no
  /// memory.
  virtual std::shared_ptr<const Evaluator> makeEvaluator(const ModelPointer& model) const = 0;
  virtual std::shared_ptr<const BrickSource> makeBrickSource(const ModelPointer& model,
                                                             const Hierarchy& hierarchy) const = 0;

  /// What draws pictures of the model, shown with so many voxels, through a cache that stays with
  /// the accelerator; null, as by default, where it only infers.
  virtual std::shared_ptr<AcceleratedRenderer> makeRenderer(const ModelPointer& model,
                                                            const glm::i64vec3& dims,
                                                            const CacheOptions& options) const;
  /// The same straight from its network.
  virtual std::shared_ptr<AcceleratedRenderer> makeNetworkRenderer(const ModelPointer& model) const;

  /// For a renderer: the model is with the accelerator as long as somebody holds the result, which
  /// is the same for all who do.
  std::shared_ptr<AcceleratedField> open(const ModelPointer& model) const;
  /// That, or null where nobody holds it.
  std::shared_ptr<AcceleratedField> find(const ModelPointer& model) const;

  /// Whether it has failed with any model. Who wants it again makes another one.
  bool hasFailed() const { return this->Failed; }

private:
  friend class AcceleratedField;

  std::shared_ptr<AcceleratedField> findLocked(const ModelPointer& model) const;

  mutable std::atomic<bool> Failed{false};
  mutable std::mutex Mutex; ///< guards what follows
  mutable std::vector<std::pair<std::weak_ptr<const Model>, std::weak_ptr<AcceleratedField>>> Open;
};

} // namespace inr

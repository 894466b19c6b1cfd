// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Core/Render/Acceleration/Accelerator.h"

#include <optional>
#include <utility>
#include <vector>

namespace inr {

/// A model that an accelerator computes, until that fails: from then on all is left to the CPU, and
/// the accelerator's memory is given back. For any number of threads at once.
class AcceleratedField
{
public:
  AcceleratedField(std::shared_ptr<const Accelerator> accelerator, ModelPointer model);

  std::string name() const { return this->Owner->name(); }

  struct Failure
  {
    std::string reason;
    bool atWork; ///< else it did not get as far as that: there was no memory, for instance
  };
  /// Nothing while it works.
  std::optional<Failure> failure() const;

  /// What the accelerator makes of the model, at the first call, which compares some values with
  /// those of `cpu`; null where it fails or has failed.
  std::shared_ptr<const Evaluator> evaluator(const Evaluator& cpu);
  std::shared_ptr<const BrickSource> bricks(const BrickSource& cpu);
  /// What draws pictures of it; null where the accelerator does not, or fails or has failed.
  std::shared_ptr<AcceleratedRenderer> makeRenderer(const glm::i64vec3& dims,
                                                    const CacheOptions& options);
  std::shared_ptr<AcceleratedRenderer> makeNetworkRenderer();
  /// The same, but null where it is not made.
  std::shared_ptr<const BrickSource> madeBricks(const Hierarchy& hierarchy) const;

  void fail(const Error& error, bool atWork);

private:
  template <class Make> auto tryTo(const Make& make) -> decltype(make(std::declval<bool&>()));
  std::shared_ptr<const BrickSource> findBricks(const Hierarchy& hierarchy) const;

  const std::shared_ptr<const Accelerator> Owner;
  const ModelPointer Source;

  mutable std::mutex Mutex; ///< guards what follows; held while that is made, not at its work
  std::optional<Failure> Failed;
  std::shared_ptr<const Evaluator> Points;
  std::vector<std::shared_ptr<const BrickSource>> Bricks; ///< the latest two
};

/// Values at points by the accelerator and, where that fails and from then on, by `cpu`: no call
/// fails because of it.
std::shared_ptr<const Evaluator> MakeEvaluator(std::shared_ptr<AcceleratedField> field,
                                               std::shared_ptr<const Evaluator> cpu);

/// The same for bricks of `model`; it keeps nothing in the accelerator's memory, and while nobody
/// has the model open there, `cpu` infers.
std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const Accelerator> accelerator,
                                                   ModelPointer model,
                                                   std::shared_ptr<const BrickSource> cpu);

} // namespace inr

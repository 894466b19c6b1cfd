// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InferencePrecision.h"
#include "Core/Model/Model.h"
#include "Core/Parallel.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace inr {

struct InferenceKernels;

/// Values of an INR at scattered points. Immutable: any number of threads may use one at once.
class Evaluator
{
public:
  virtual ~Evaluator() = default;

  /// Normalised values y at `count` positions in the unit cube, on the calling thread. Positions
  /// are clamped to [0, 1], a NaN is 0; y is the network's output, not clamped. A value does not
  /// depend on its neighbours in the batch. Best in batches of 64 or more.
  ///
  /// float32 arithmetic with gradual underflow: what a sum of n products loses is at most (n + 2)
  /// 2^-24 of the sum of their magnitudes and n 2^-149, whatever the kernel. A sample for which a
  /// number leaves float's range is done again in float64, up to a hundred times slower, and y
  /// saturates at +-the largest float: it is always finite, and every kernel gives the same.
  /// Denormal numbers cost what others do on processors that compute with them in hardware (AMD's
  /// since Zen); on others a model that consists of them is many times slower. Floating-point modes
  /// and flags of the thread stay as they are.
  virtual void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const = 0;

  /// Values y at all points of a lattice, x fastest in `values`, on the calling thread. The axes'
  /// coordinates are in [0, 1] and rise. Equal to `evaluate` but for the order of summation; a
  /// value does not depend on the lattice around it.
  virtual void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const;

  /// Places along each axis of the unit cube that the field tells apart: between them it is smooth.
  /// 0: not known. Of a model see ResolutionOf.
  virtual glm::i64vec3 resolution() const { return glm::i64vec3(0); }

  /// Points that a call should have where there are as many: a device is far away. 0: any number.
  virtual std::int64_t pointsAtOnce() const { return 0; }

  /// The instruction set in use: "avx512", "avx2" or "baseline"; "avx512 bfloat16", "amx
  /// bfloat16" (tile registers) or "amx split bfloat16" where products are made of that.
  virtual std::string kernel() const = 0;
};

/// With BFloat16, weights and what goes into a layer are off by up to 2^-8 of themselves, which
/// adds at most (2^-7 + 2^-16) of the sum of the products' magnitudes to what a sum loses, and
/// numbers below 2^-126 count as zero, which loses at most 2^-30 of y. With SplitBFloat16 they are
/// off by up to 2^-16 of themselves, which adds at most (3 * 2^-16 + 2^-32) of the products'
/// magnitudes, and each product becomes three: 3n of them in the bound above. Where the kernel
/// cannot do that here, or the model's numbers might leave float's range, it is Float32; so it is
/// instead of SplitBFloat16 where that is off, in the root of the mean square at 2048 points, by
/// more than what values are when they are rounded to 16 bits.
///
/// The fastest kernel that this processor runs; `kernel` asks for one by name ("avx512", "avx2",
/// "baseline", or "amx" for tile registers; for tests) and Error(Unsupported) says that
/// it is not to be had here. Kernels for bfloat16 sum up in different orders, each within the
/// bound; the fastest one is the same throughout a process. Throws Error(InvalidArgument) without a
/// model and Error(InvalidModel) when the parameter count does not fit the description or a
/// parameter is NaN or infinite.
std::shared_ptr<const Evaluator>
MakeEvaluator(ModelPointer model, const std::string& kernel = "",
              InferencePrecision precision = InferencePrecision::Float32);

/// The same with kernels that this processor must run; those for bfloat16 are for models whose
/// numbers stay in range.
std::shared_ptr<const Evaluator> MakeEvaluator(ModelPointer model, const InferenceKernels& kernels);

/// `evaluate` with the batch spread over `arena`.
void EvaluateParallel(const Evaluator& evaluator, const Arena& arena, const glm::vec3* positions,
                      std::int64_t count, float* values);

/// Values at the points of a regular lattice: point (i, j, k) of `points` sits at
/// u = first + (i, j, k) * step, clamped to [0, 1], and steps are not negative; x fastest in
/// `values`. A value is that of evaluateGrid, whatever the lattice around it. The grid is
/// interpolated for eight points along x at a time, whether or not all of them are wanted.
struct Lattice
{
  glm::dvec3 first{0.0};
  glm::dvec3 step{0.0};
  glm::i64vec3 points{0};
};
void EvaluateLattice(const Evaluator& evaluator, const Arena& arena, const Lattice& lattice,
                     float* values);

/// The lattice of voxel centres [begin, begin + size) of a grid with `dims` voxels.
Lattice VoxelLattice(const glm::i64vec3& dims, const glm::i64vec3& begin, const glm::i64vec3& size);

} // namespace inr

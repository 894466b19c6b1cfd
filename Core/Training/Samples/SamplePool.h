// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"
#include "Core/Training/Samples/BatchSource.h"
#include "Core/Training/Samples/BlockGrid.h"
#include "Core/Training/Samples/BlockShare.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

namespace inr {

/// How many pairs of values are further apart than `tolerance`; NaNs are alike.
std::int64_t CountDifferences(const double* a, const double* b, std::int64_t count,
                              double tolerance);

/// Samples of a volume that does not fit in memory: one in each of many equal boxes, the same
/// number in every block, so that no region is ever seen more than another. While the training
/// goes on, blocks are read again, one after the other, and their samples drawn anew.
///
/// One process of several has those of its share of the blocks. With n processes a mini-batch is n
/// of those that one process would draw, one after the other.
///
/// Two threads share it: one reads and calls sample(), put(), wanted() and offer(); the other
/// trains. What a mini-batch holds depends on seed, step, plan and `rereads` alone, not on how fast
/// either is; but that of a step which is taken again, as an accelerator was lost behind it, is of
/// blocks that were read again since.
class SamplePool : public BatchSource
{
public:
  /// At least `blocks.count()` and BatchSize samples, of 8 bytes each, and as near to `mostSamples`
  /// as a power of two comes. All numbers are those of all processes together; blocks are named by
  /// their numbers in `blocks`.
  SamplePool(const BlockGrid& blocks, std::int64_t mostSamples, std::uint64_t seed,
             const BlockShare& share);

  std::int64_t samples() const { return this->Blocks.count() * this->Boxes.count(); }

  /// What is subtracted from all values, see SamplePiece: to be set before the first sample, and to
  /// the same in all processes. 0 until then.
  void setOrigin(double origin) { this->Origin = origin; }
  double origin() const { return this->Origin; }
  StateArray originState() { return {"origin", &this->Origin, sizeof(this->Origin)}; }

  /// Values, above the origin, of a block's samples when it is read for the first time (`round` 0)
  /// or again (1), of a piece that holds blocks.voxels(block).
  std::vector<double> sample(std::int64_t block, std::uint32_t round, const VolumePiece& piece,
                             const Arena& arena) const;

  /// The first reading of a block, before the training.
  void put(std::int64_t block, const std::vector<double>& values);

  /// Where the samples lie in memory, and what says which they are. After other bytes were put
  /// there: resume(), which says whether they can be those of a pool like this one.
  StateArrays state();
  bool resume();

  /// How many of the pool's samples of a block are not what the piece, which holds
  /// blocks.voxels(block), says, but off by more than `tolerance`.
  std::int64_t differences(std::int64_t block, const VolumePiece& piece, double tolerance,
                           const Arena& arena) const;

  /// Before the training: what is target 0 and 1, and the share of blocks, 0 to 1, to read again
  /// while the learning rate falls.
  void begin(double low, double high, double rereads);

  /// The next block to read again, whose samples of round 1 are to be offered; none as long as
  /// enough of them wait to be used. Waits a moment for one to be wanted.
  std::optional<std::int64_t> wanted();
  void offer(std::int64_t block, std::vector<double> values);

  /// For one thread that does both: before prepare() of a step, each block that it would wait for;
  /// as many in all processes. NoBlock, which is to be offered, too, in those that have fewer.
  std::optional<std::int64_t> owed(const TrainingStep& step);
  static constexpr std::int64_t NoBlock = -1;

  std::string name() const override;
  TrainingPipeline pipeline() const override { return TrainingPipeline::Storage; }
  void prepare(const TrainingStep& step, const StopCheck& check) override;
  std::int64_t count() const override { return this->Share.processes * this->Share.items(); }
  std::int64_t total() const override { return this->Share.processes * BatchSize; }
  void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override;

private:
  struct Offer
  {
    std::int64_t block;
    std::vector<double> values;
  };

  glm::vec3 position(std::int64_t block, std::uint32_t round, std::int64_t sample) const;
  /// Where a block's samples begin.
  std::size_t place(std::int64_t block) const
  {
    return static_cast<std::size_t>((block - this->Share.firstBlock) * this->Boxes.count());
  }
  std::int64_t due(const TrainingStep& step) const;
  void use(const Offer& offer);

  const BlockGrid& Blocks;
  std::uint64_t Seed;
  BlockShare Share;
  HalvedCube Boxes; ///< of a block, in units of the block
  std::vector<double> Values;
  std::vector<std::uint32_t> Rounds; ///< of the values of each block of the share
  double Origin = 0;
  double Low = 0; ///< above the origin
  double High = 1;

  std::vector<std::int64_t> Order; ///< in which blocks are read again
  std::int64_t Used = 0;           ///< of them

  std::mutex Mutex;
  std::condition_variable Changed;
  std::deque<Offer> Waiting;
  std::int64_t Asked = 0; ///< of Order
  std::int64_t Due = 0;   ///< that the present step must have used
};

} // namespace inr

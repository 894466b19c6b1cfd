// SPDX-License-Identifier: BSD-3-Clause
//
// A cache of bricks that lives in a device's memory: it is filled there, by kernels, from what
// kernels ask for. The host orders and is told a few numbers.
#pragma once

#include "CUDA/Cache/CacheLayout.h"
#include "CUDA/Cache/Kernels/CacheTables.h"
#include "CUDA/Cache/Kernels/StoreBricks.h"
#include "CUDA/Cache/Selector.h"
#include "CUDA/Inference/Overflow.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace inr {
namespace cuda {

/// `Machine`: see CUDA/Device/Machine.h. `Inference` computes voxels on it; see DeviceInference.
///
/// As with Core's BrickCache, time runs in frames: during one, kernels find, view, touch and
/// request; between frames load changes what is mapped. What is done is done in the machine's
/// order, and only load and finishLoad wait for it. After an Error(Device) it is of no use any
/// more.
template <class Machine, class Inference> class DeviceCache
{
public:
  /// Everything stays within `bytes`; the coarsest brick comes in for good. By the ranges of
  /// `cells`, where there are any and they hold, integers divide values, as in Core's BrickStore.
  /// Throws what LayOutCache throws, and what the machine does, which must live longer.
  DeviceCache(Machine& machine, Inference inference, const Hierarchy& hierarchy,
              CachePrecision precision, std::int64_t bytes, const MacroCells& cells = {})
      : Where(machine), Infer(std::move(inference)), Levels(hierarchy), Precision(precision),
        Needs(needs(this->Infer, precision, cells)),
        LevelTable(machine.template allocate<HierarchyLevel>(hierarchy.levels())),
        Ranges(machine.template allocate<ValueRange>(this->Needs.cells))
  {
    const CacheLayout layout = LayOutCache(hierarchy, precision, bytes, this->Needs);
    // What infers and these have their memory already.
    const std::int64_t taken =
        this->Needs.inference +
        this->LevelTable.size() * static_cast<std::int64_t>(sizeof(HierarchyLevel)) +
        this->Ranges.size() * static_cast<std::int64_t>(sizeof(ValueRange));
    machine.requireFree(layout.bytes - taken, "the cache of bricks");
    machine.toMachine(this->LevelTable.data(), &hierarchy.view().level(0), hierarchy.levels());
    this->putRanges(cells);
    this->allocate(layout);
  }

  /// Of one with these.
  static CacheNeeds needs(const Inference& inference, CachePrecision precision,
                          const MacroCells& cells)
  {
    // Floats are stored as they are.
    const bool divides = precision != CachePrecision::Float32 && cells.rangesHold();
    return {inference.bytes(), divides ? static_cast<std::int64_t>(cells.ranges.size()) : 0};
  }

  DeviceCache(const DeviceCache&) = delete;
  DeviceCache& operator=(const DeviceCache&) = delete;
  /// Waits for what was begun beside: it uses memory that is about to go.
  ~DeviceCache()
  {
    try {
      this->isLoading() ? this->Beside->wait() : void();
    } catch (const std::exception&) { // it is lost, and nothing is on its way any more
    }
  }

  const Hierarchy& hierarchy() const { return this->Levels; }
  CachePrecision precision() const { return this->Precision; }
  std::int64_t capacity() const { return this->Layout.capacity; } ///< bricks
  std::int64_t mapped() const { return this->Mapped; }
  std::int64_t bytes() const { return this->Layout.bytes; } ///< of the machine's memory

  /// What kernels of the present frame are passed.
  CacheView view() const
  {
    const glm::ivec3& dims = this->Levels.brickDims();
    CacheView view{};
    view.hierarchy = {this->LevelTable.data(), this->Levels.levels(), dims};
    view.precision = this->Precision;
    view.bytesPerBrick = this->Levels.voxelsPerBrick() * BytesPerVoxel(this->Precision);
    view.rowStride = dims.x;
    view.layerStride = std::int64_t{dims.x} * dims.y;
    view.frame = this->Frame;
    view.capacity = this->Layout.capacity;
    view.pages = this->Tables->pages.data();
    view.pageMask = static_cast<std::uint32_t>(this->Layout.pages - 1);
    view.voxels = this->Tables->voxels.data();
    view.scales = this->Tables->scales.data();
    view.owners = this->Tables->owners.data();
    view.uses = this->Tables->uses.data();
    view.requests = {this->Tables->requests.data(),
                     static_cast<std::uint32_t>(this->Layout.requests - 1),
                     &this->Tables->counts.data()->requests};
    return view;
  }

  /// Bricks touched or loaded from here on keep their slots until the next call.
  void beginFrame() { ++this->Frame; }

  struct Loaded
  {
    std::int64_t requested;  ///< different bricks, since the last call
    std::int64_t overflowed; ///< more than 0: there were others, for which there was no room
    std::int64_t loaded;     ///< bricks
    std::int64_t repaired;   ///< voxels of them that Core had to compute
    bool full;               ///< there were more than fitted beside what the present frame uses

    /// The cache has no room for any that is still wanted.
    bool isHopeless() const { return this->full && this->loaded == 0; }
  };
  /// Infers and maps at most `most` of the bricks that were requested since the last call, and
  /// forgets the others: those of the greatest contribution first, or the coarsest.
  ///
  /// Core's other order is that in which bricks were first wanted, which threads of a GPU do not
  /// have. Waits once for each CacheLayout::atOnce bricks: only then the host knows whether there
  /// are more to begin with, and that no voxel is left for Core to compute. Then `goesOn`, which
  /// may be empty, says whether there shall be more.
  Loaded load(std::int64_t most, bool byContribution, const std::function<bool()>& goesOn = {})
  {
    this->finishLoad();
    Loaded all{};
    for (bool more = true; more;) {
      const std::int64_t wanted = std::min(most - all.loaded, this->Layout.atOnce);
      this->list(wanted, byContribution);
      this->infer(this->Where);
      const Loaded some = this->storeListed(wanted);
      more = some.loaded == wanted && all.loaded + wanted < most && (!goesOn || goesOn());
      all = {some.requested, some.overflowed, all.loaded + some.loaded,
             all.repaired + some.repaired, some.full};
    }
    this->forgetRequests();
    return all;
  }

  /// Those since the last call of load or beginLoad.
  void forgetRequests()
  {
    this->Where.run(ClearRequests{this->view().requests}, this->Layout.requests);
  }

  /// The same, of at most CacheLayout::atOnce bricks, in two steps: `beside`, another machine with
  /// the same memory, infers while this one goes on with frames. Nothing is waited for. Bricks
  /// that are on their way are not known to be: who still wants them asks for them again, which
  /// does no harm.
  void beginLoad(Machine& beside, std::int64_t most, bool byContribution)
  {
    this->finishLoad();
    this->Listed = std::min(most, this->Layout.atOnce);
    this->list(this->Listed, byContribution);
    this->forgetRequests();
    beside.after(this->Where);
    this->Beside = &beside;
    this->infer(beside);
  }
  bool isLoading() const { return this->Beside != nullptr; } ///< begun and not finished
  /// Whether finishLoad would not wait for bricks to be inferred.
  bool hasInferred() const { return !this->isLoading() || this->Beside->isIdle(); }
  /// Maps what was begun, if anything was, in the place of nothing that the present frame uses.
  /// Waits for it, as load does.
  Loaded finishLoad()
  {
    if (!this->isLoading()) {
      return {};
    }
    this->Where.after(*std::exchange(this->Beside, nullptr));
    this->findSlots(this->Listed); // others than they were: frames have used some since
    return this->storeListed(this->Listed);
  }

  /// Bricks that it would have room for within so many bytes.
  std::int64_t capacityWithin(std::int64_t bytes) const
  {
    return LayOutCache(this->Levels, this->Precision, bytes, this->Needs).capacity;
  }
  /// Throws where the machine has no memory for what that takes more than it has now.
  void requireFree(std::int64_t bytes) const
  {
    const std::int64_t more =
        LayOutCache(this->Levels, this->Precision, bytes, this->Needs).bytes - this->Layout.bytes;
    more > 0 ? this->Where.requireFree(more, "a larger cache of bricks") : void();
  }
  /// Stays within so many bytes from here on, and forgets all bricks but the coarsest, those of the
  /// present frame and what was begun included. Throws as the constructor does, but does not ask
  /// whether so much is free beside the machine's reserve: see requireFree. What is not
  /// Error(InvalidArgument) leaves a cache that is of no use until this has succeeded.
  void resize(std::int64_t bytes)
  {
    const CacheLayout layout = LayOutCache(this->Levels, this->Precision, bytes, this->Needs);
    if (this->isLoading()) {
      std::exchange(this->Beside, nullptr)->wait();
    }
    this->Where.wait();
    this->Mapped = 0;
    this->Layout = {};
    this->allocate(layout);
  }

  /// Forgets all bricks but the coarsest, those of the present frame included. What was begun still
  /// comes in.
  void clear()
  {
    this->Where.fill(this->Tables->uses.data() + Pinned, 0, this->Layout.capacity - Pinned);
    this->map();
    this->Mapped = Pinned;
  }

private:
  static constexpr std::int64_t Pinned = 1; ///< slots: the first one has the coarsest brick

  template <class T> using Array = typename Machine::template Array<T>;

  struct Storage
  {
    Storage(const Machine& machine, const CacheLayout& layout, const Hierarchy& hierarchy,
            CachePrecision precision)
        : voxels(machine.template allocate<unsigned char>(
              layout.capacity * hierarchy.voxelsPerBrick() * BytesPerVoxel(precision) +
              CacheLayout::BytesBehind)),
          scales(machine.template allocate<BrickScale>(layout.capacity)),
          owners(machine.template allocate<BrickKey>(layout.capacity)),
          uses(machine.template allocate<std::uint64_t>(layout.capacity)),
          pages(machine.template allocate<PageEntry>(layout.pages)),
          requests(machine.template allocate<RequestEntry>(layout.requests)),
          selector(machine, std::max(layout.capacity, layout.requests), layout.atOnce),
          bricks(machine.template allocate<RankEntry>(layout.atOnce)),
          slots(machine.template allocate<RankEntry>(layout.atOnce)),
          jobs(machine.template allocate<BrickJob>(layout.atOnce)),
          values(machine.template allocate<float>(layout.atOnce * hierarchy.voxelsPerBrick())),
          marked(machine.template allocate<std::uint32_t>(layout.atOnce)),
          counts(machine.template allocate<CacheCounts>(1))
    {}

    Array<unsigned char> voxels;
    Array<BrickScale> scales;
    Array<BrickKey> owners;
    Array<std::uint64_t> uses;
    Array<PageEntry> pages;
    Array<RequestEntry> requests;
    Selector<Machine> selector;
    Array<RankEntry> bricks;
    Array<RankEntry> slots;
    Array<BrickJob> jobs;
    Array<float> values;
    Array<std::uint32_t> marked;
    Array<CacheCounts> counts;
  };

  void allocate(const CacheLayout& layout)
  {
    // Where there are some, they go before others come: memory may be short.
    this->Tables.emplace(this->Where, layout, this->Levels, this->Precision);
    this->Layout = layout;
    this->Where.fill(this->Tables->uses.data(), 0, this->Layout.capacity);
    this->forgetRequests();
    this->map();
    this->loadCoarsest();
  }

  void putRanges(const MacroCells& cells)
  {
    if (this->Needs.cells == 0) {
      return;
    }
    std::vector<ValueRange> ranges(cells.ranges);
    for (ValueRange& range : ranges) {
      range = {NormalisedOutput(range.low), NormalisedOutput(range.high)};
    }
    this->Where.toMachine(this->Ranges.data(), ranges.data(), this->Needs.cells);
    this->Cells = {cells.dims, cells.spacing, this->Ranges.data()};
  }

  /// Slots that may take other bricks.
  void findSlots(std::int64_t most)
  {
    this->Tables->selector.select(this->Where,
                                  ReplaceableSlots{this->Tables->uses.data(), this->Frame, Pinned},
                                  this->Layout.capacity, most, this->Tables->slots.data());
  }

  /// The bricks that are to come in, as long as there are slots for them.
  void list(std::int64_t most, bool byContribution)
  {
    this->Tables->selector.select(this->Where, WantedBricks{this->view(), byContribution},
                                  this->Layout.requests, most, this->Tables->bricks.data());
    this->findSlots(most);
    this->listRanked(most);
  }

  void listRanked(std::int64_t most)
  {
    const ListBricks kernel{this->view().hierarchy,     this->Tables->bricks.data(),
                            this->Tables->slots.data(), most,
                            this->Tables->jobs.data(),  this->Tables->counts.data()};
    this->Where.run(kernel, ListBricks::Threads, ListBricks::SharedBytes);
  }

  void infer(Machine& machine)
  {
    this->Infer.infer(machine, this->Tables->jobs.data(), &this->Tables->counts.data()->end,
                      this->Tables->values.data());
  }

  Loaded storeListed(std::int64_t most)
  {
    this->store(most);
    this->map();
    CacheCounts counts{};
    this->Where.toHost(&counts, this->Tables->counts.data(), 1);
    const auto stored = static_cast<std::int64_t>(counts.stored);
    if (counts.marked > 0) {
      this->repair(stored);
      this->store(most);
    }
    this->Mapped = std::min(this->mapped() + stored, this->Layout.capacity);
    return {static_cast<std::int64_t>(counts.listed.bricks),
            static_cast<std::int64_t>(counts.listed.overflowed), stored,
            static_cast<std::int64_t>(counts.marked), stored < counts.wanted};
  }

  void store(std::int64_t most)
  {
    const StoreBricks kernel{this->view(),
                             this->Tables->bricks.data(),
                             this->Tables->slots.data(),
                             this->Tables->values.data(),
                             this->Tables->counts.data(),
                             this->Tables->marked.data(),
                             this->Cells};
    this->Where.run(kernel, most * StoreBricks::Threads, StoreBricks::SharedBytes);
  }

  void map()
  {
    this->Where.fill(this->Tables->pages.data(), 0xff, this->Layout.pages); // NoBrick, and -1
    this->Where.run(MapSlots{this->view()}, this->Layout.capacity);
  }

  /// Voxels that are no numbers, by Core: hardly ever.
  void repair(std::int64_t count)
  {
    if (!this->Core) {
      this->Core = MakeBrickSource(MakeEvaluator(this->Infer.source()), this->Levels);
    }
    std::vector<RankEntry> bricks(static_cast<std::size_t>(count));
    std::vector<std::uint32_t> marked(bricks.size());
    this->Where.toHost(bricks.data(), this->Tables->bricks.data(), count);
    this->Where.toHost(marked.data(), this->Tables->marked.data(), count);
    const std::int64_t voxels = this->Levels.voxelsPerBrick();
    std::vector<float> values(static_cast<std::size_t>(voxels));
    for (std::int64_t k = 0; k < count; ++k) {
      if (marked[static_cast<std::size_t>(k)] > 0) {
        float* const brick = this->Tables->values.data() + k * voxels;
        const BrickKey key = WantedBricks::KeyOf(bricks[static_cast<std::size_t>(k)]);
        this->Where.toHost(values.data(), brick, voxels);
        RepairLayers(*this->Core, key, 0, this->Levels.brickDims().z, values.data());
        this->Where.toMachine(brick, values.data(), voxels);
      }
    }
  }

  void loadCoarsest()
  {
    const RankEntry brick = WantedBricks::EntryOf(this->Levels.coarsest());
    const RankEntry slot{0, 0};
    this->Where.toMachine(this->Tables->bricks.data(), &brick, 1);
    this->Where.toMachine(this->Tables->slots.data(), &slot, 1);
    this->listRanked(1);
    this->infer(this->Where);
    this->storeListed(1);
  }

  Machine& Where;
  Inference Infer;
  Hierarchy Levels;
  CachePrecision Precision;
  CacheNeeds Needs;
  CacheLayout Layout{};
  Array<HierarchyLevel> LevelTable;
  Array<ValueRange> Ranges;
  CellTable Cells;
  std::optional<Storage> Tables; ///< none where there was no memory for other ones
  std::uint64_t Frame = 1;
  std::atomic<std::int64_t> Mapped{0};     ///< which others may ask for while it is used
  Machine* Beside = nullptr;               ///< that infers what was begun
  std::int64_t Listed = 0;                 ///< bricks of that, at most
  std::shared_ptr<const BrickSource> Core; ///< once it was needed
};

} // namespace cuda
} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickLoader.h"

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

#ifdef __linux__
#include <sched.h>
#endif

namespace inr {

namespace {

/// Of the calling thread: it never takes the processor from one that wakes up, as those do that
/// draw windows, but has its share of a busy machine.
void LowerPriority()
{
#ifdef __linux__
  const sched_param none{};
  sched_setscheduler(0, SCHED_BATCH, &none);
#endif
}

} // namespace

BrickLoader::BrickLoader(std::shared_ptr<const BrickSource> source, int threads, std::int64_t room)
    : Source(std::move(source)), Layers(this->Source->hierarchy().brickDims().z),
      ThreadCount(threads), Room(room)
{}

BrickLoader::~BrickLoader()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Ended = true;
  }
  this->Wake.notify_all();
  for (std::thread& thread : this->Threads) {
    thread.join();
  }
}

std::int64_t BrickLoader::bytesFor(const Hierarchy& hierarchy, std::int64_t room)
{
  return room * hierarchy.voxelsPerBrick() * static_cast<std::int64_t>(sizeof(float));
}

std::int64_t BrickLoader::begun()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return static_cast<std::int64_t>(this->InWork.size());
}

std::int64_t BrickLoader::held()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->holding();
}

void BrickLoader::allow(std::int64_t room)
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Room = std::max(this->Room, room);
  }
  this->Wake.notify_all();
}

void BrickLoader::giveUp()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Wanted.clear();
  this->Finished.clear();
  this->Spare.clear();
  this->Room = this->holding();
  this->Ready.notify_all(); // who waits may have nothing to wait for any more
}

void BrickLoader::start()
{
  try {
    while (static_cast<int>(this->Threads.size()) < this->ThreadCount) {
      this->Threads.emplace_back([this] { this->work(); });
    }
  } catch (const std::system_error&) { // no more threads to be had
  }
}

void BrickLoader::work()
{
  LowerPriority();
  std::unique_lock<std::mutex> lock(this->Mutex);
  while (!this->Ended) {
    if (this->isAtRest() || !this->tryToInferOne(lock)) {
      this->Wake.wait(lock);
    }
  }
}

/// The same where nobody would catch what it throws: no memory for another brick.
bool BrickLoader::tryToInferOne(std::unique_lock<std::mutex>& lock)
{
  try {
    return this->inferOne(lock);
  } catch (...) {
    if (!lock.owns_lock()) {
      lock.lock();
    }
    this->Failure = std::current_exception();
    this->Wanted.clear(); // or it would be tried for ever
    this->Ready.notify_all();
    return false;
  }
}

/// False when there is nothing to begin.
bool BrickLoader::inferOne(std::unique_lock<std::mutex>& lock)
{
  // What was begun in layers ends in layers, though the source infer whole bricks by now.
  Brick* brick = this->withLayersLeft();
  if (brick == nullptr && this->mayBegin()) {
    lock.unlock(); // an accelerator may be in the making, for seconds
    const std::int64_t atOnce = this->Source->bricksAtOnce(); // read once: it may change
    lock.lock();
    if (this->Ended || this->isAtRest() || this->withLayersLeft() != nullptr) {
      return true; // to look again
    }
    if (atOnce > 0) {
      return this->inferTogether(atOnce, lock);
    }
    brick = this->begin();
  }
  if (brick == nullptr) {
    return false;
  }
  const std::int64_t z = brick->begun++;
  ++this->LayersBegun;
  this->Ready.notify_all();
  this->inferLayer(*brick, z, lock);
  if (++brick->done == brick->layers) {
    if (!brick->failed) {
      this->Source->complete(brick->part, brick->values.data());
    }
    this->finish(*brick);
  }
  return true;
}

/// The first of the begun bricks of which nobody has begun some layer yet; null when there is none.
BrickLoader::Brick* BrickLoader::withLayersLeft() const
{
  const auto found = std::find_if(
      this->InWork.begin(), this->InWork.end(),
      [](const std::unique_ptr<Brick>& brick) { return brick->begun < brick->layers; });
  return found == this->InWork.end() ? nullptr : found->get();
}

/// Whether some brick is wanted, and there is room for it.
bool BrickLoader::mayBegin() const { return !this->Wanted.empty() && this->holding() < this->Room; }

/// The next such brick; null when there is none.
BrickLoader::Brick* BrickLoader::begin()
{
  if (!this->mayBegin()) {
    return nullptr;
  }
  const BrickPart& next = this->Wanted.front();
  auto brick = std::make_unique<Brick>(Brick{next, this->Source->layersInside(next.key)});
  this->InWork.reserve(this->InWork.size() + 1); // what takes memory comes first: all or nothing
  this->Finished.reserve(this->InWork.size() + this->Finished.size() + 1);
  this->Wanted.pop_front();
  if (!this->Spare.empty()) {
    brick->values = std::move(this->Spare.back());
    this->Spare.pop_back();
  }
  this->InWork.push_back(std::move(brick));
  return this->InWork.back().get();
}

/// As many bricks as the source infers at once; false when there is none.
bool BrickLoader::inferTogether(std::int64_t atOnce, std::unique_lock<std::mutex>& lock)
{
  std::vector<Brick*> bricks;
  bricks.reserve(static_cast<std::size_t>(atOnce));
  try {
    while (static_cast<std::int64_t>(bricks.size()) < atOnce) {
      Brick* const brick = this->begin();
      if (brick == nullptr) {
        break;
      }
      brick->begun = brick->layers; // none is left for other threads
      this->LayersBegun += brick->layers;
      bricks.push_back(brick);
    }
  } catch (const std::bad_alloc&) {
    if (bricks.empty()) {
      throw;
    } // else those that are begun have to be finished
  }
  if (bricks.empty()) {
    return false;
  }
  this->Ready.notify_all();
  this->inferBricks(bricks, lock);
  for (Brick* const brick : bricks) {
    this->finish(*brick);
  }
  return true;
}

void BrickLoader::inferBricks(const std::vector<Brick*>& bricks, std::unique_lock<std::mutex>& lock)
{
  const std::int64_t voxels = this->Source->hierarchy().voxelsPerBrick();
  const auto count = static_cast<std::int64_t>(bricks.size());
  try {
    std::vector<BrickKey> keys(bricks.size());
    std::transform(bricks.begin(), bricks.end(), keys.begin(),
                   [](const Brick* brick) { return brick->part.key; });
    Values values(static_cast<std::size_t>(count * voxels));
    lock.unlock();
    this->Source->infer(keys.data(), count, values.data(), Arena(1));
    for (std::int64_t k = 0; k < count; ++k) { // nobody else looks at them before they are finished
      const auto from = values.begin() + k * voxels;
      bricks[static_cast<std::size_t>(k)]->values.assign(from, from + voxels);
    }
    lock.lock();
  } catch (...) {
    if (!lock.owns_lock()) {
      lock.lock();
    }
    for (Brick* const brick : bricks) {
      brick->failed = true;
    }
    this->Failure = std::current_exception();
  }
}

void BrickLoader::inferLayer(Brick& brick, std::int64_t z, std::unique_lock<std::mutex>& lock)
{
  const std::int64_t voxels = this->Source->hierarchy().voxelsPerBrick();
  try {
    brick.values.resize(static_cast<std::size_t>(voxels));
    float* const layer = brick.values.data() + z * (voxels / this->Layers);
    lock.unlock();
    this->Source->inferLayerOf(brick.part, z, layer);
    lock.lock();
  } catch (...) {
    if (!lock.owns_lock()) {
      lock.lock();
    }
    brick.failed = true;
    this->Failure = std::current_exception();
  }
}

void BrickLoader::finish(Brick& brick)
{
  const auto place = std::find_if(this->InWork.begin(), this->InWork.end(),
                                  [&](const auto& other) { return other.get() == &brick; });
  if (!brick.failed) {
    this->Finished.push_back(std::move(*place));
  }
  this->InWork.erase(place);
  this->Ready.notify_all();
}

std::int64_t BrickLoader::holding() const
{
  return static_cast<std::int64_t>(this->InWork.size() + this->Finished.size() + this->HandingOver);
}

bool BrickLoader::isAtHand(BrickKey key) const
{
  const auto isIt = [&](const std::unique_ptr<Brick>& brick) { return brick->part.key == key; };
  return std::any_of(this->InWork.begin(), this->InWork.end(), isIt) ||
         std::any_of(this->Finished.begin(), this->Finished.end(), isIt);
}

void BrickLoader::request(const std::vector<BrickPart>& parts)
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Wanted.clear();
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(this->Wanted),
                 [this](const BrickPart& part) { return !this->isAtHand(part.key); });
  }
  this->Wake.notify_all();
  this->Ready.notify_all(); // as for giveUp
  if (!parts.empty() && this->Threads.empty()) {
    this->start();
  }
}

void BrickLoader::resume()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Paused = false;
  }
  this->Wake.notify_all();
}

void BrickLoader::pause()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Paused = true;
}

namespace {

/// Says that somebody waits.
class Waiting
{
public:
  explicit Waiting(bool& flag) : Flag(flag) { this->Flag = true; }
  ~Waiting() { this->Flag = false; }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

private:
  bool& Flag;
};

} // namespace

void BrickLoader::loadFor(double seconds)
{
  constexpr double longest = 1e6; // what a clock can be set forward by has an end
  const std::chrono::duration<double> time(std::min(seconds, longest));
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
  std::unique_lock<std::mutex> lock(this->Mutex);
  const Waiting waiting(this->Awaited);
  this->Wake.notify_all();
  if (this->Threads.empty()) {
    this->workFor(deadline, lock);
  } else {
    this->waitFor(deadline, lock);
  }
}

void BrickLoader::workFor(Clock::time_point deadline, std::unique_lock<std::mutex>& lock)
{
  while (this->inferOne(lock) && Clock::now() < deadline) {
  }
}

void BrickLoader::waitFor(Clock::time_point deadline, std::unique_lock<std::mutex>& lock)
{
  const std::int64_t before = this->LayersBegun;
  this->Ready.wait(lock, [&] { return this->LayersBegun > before || !this->hasWork(); });
  this->Ready.wait_until(lock, deadline, [this] { return !this->hasWork(); });
}

/// Whether the threads have something to finish or to begin.
bool BrickLoader::hasWork() const { return !this->InWork.empty() || this->mayBegin(); }

void BrickLoader::handOver(const std::function<void(const BrickPart&, const float*)>& receive)
{
  std::vector<std::unique_ptr<Brick>> bricks;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->Failure) {
      std::rethrow_exception(std::exchange(this->Failure, nullptr));
    }
    bricks.reserve(this->InWork.size() + this->Finished.size()); // which finish() relies on
    this->Spare.reserve(this->Spare.size() + this->Finished.size());
    bricks.swap(this->Finished);
    this->HandingOver = bricks.size();
  }
  for (const std::unique_ptr<Brick>& brick : bricks) {
    receive(brick->part, brick->values.data());
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    for (const std::unique_ptr<Brick>& brick : bricks) {
      this->Spare.push_back(std::move(brick->values));
    }
    this->HandingOver = 0;
  }
  this->Wake.notify_all(); // there is room again
}

} // namespace inr

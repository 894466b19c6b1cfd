// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickSource.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace inr {

/// Infers bricks on threads of its own while the application does something else.
///
/// Its threads work layer by layer, all of them on the first bricks that were asked for, at a low
/// priority, and begin none while it is paused: so it rests after the time of one layer at most.
/// Bricks of a source that infers several at once are begun together, and one call of that source
/// takes the place of the layer. Whoever ends it waits for that and, where the source is being made
/// ready (see BrickSource::bricksAtOnce), for that; nobody else does. It is made paused. What
/// requests bricks, waits for them and receives them is one thread at a time; others may pause it,
/// ask what it holds, and take from it what is wanted.
class BrickLoader
{
public:
  /// At most `room` bricks are begun and not yet handed over. The threads start with the first
  /// request; where none can be started, loadFor loads itself.
  BrickLoader(std::shared_ptr<const BrickSource> source, int threads, std::int64_t room);
  ~BrickLoader();
  BrickLoader(const BrickLoader&) = delete;
  BrickLoader& operator=(const BrickLoader&) = delete;

  static std::int64_t bytesFor(const Hierarchy& hierarchy, std::int64_t room);

  std::int64_t begun(); ///< bricks that are not finished
  std::int64_t held();  ///< and those that were not handed over
  /// Makes room for more.
  void allow(std::int64_t room);
  /// Forgets what is wanted and what is finished and gives back what that took: there is only room
  /// for what is begun.
  void giveUp();

  /// These parts of bricks, in this order, in place of what earlier requests wanted and nobody has
  /// begun.
  void request(const std::vector<BrickPart>& parts);
  void resume();
  void pause();
  /// Has the requests worked on for so many seconds, paused or not; until a layer is begun at
  /// least, and no longer than there is something to do. The calling thread waits for the time to
  /// be over: a layer of its own would keep it longer than it has.
  void loadFor(double seconds);

  /// Hands over all bricks that are finished, voxelsPerBrick() values each, to what must not throw.
  /// Throws what inferring threw since the last time.
  void handOver(const std::function<void(const BrickPart& part, const float* values)>& receive);

private:
  using Clock = std::chrono::steady_clock;
  using Values = std::vector<float>;

  struct Brick
  {
    BrickPart part;
    std::int64_t layers; ///< to infer
    Values values{};
    std::int64_t begun = 0; ///< of them
    std::int64_t done = 0;
    bool failed = false;
  };

  void start();
  void work();
  void workFor(Clock::time_point deadline, std::unique_lock<std::mutex>& lock);
  void waitFor(Clock::time_point deadline, std::unique_lock<std::mutex>& lock);
  bool hasWork() const;
  bool inferOne(std::unique_lock<std::mutex>& lock);
  bool tryToInferOne(std::unique_lock<std::mutex>& lock);
  bool inferTogether(std::int64_t atOnce, std::unique_lock<std::mutex>& lock);
  Brick* withLayersLeft() const;
  bool isAtRest() const { return this->Paused && !this->Awaited; }
  bool mayBegin() const;
  Brick* begin();
  void inferLayer(Brick& brick, std::int64_t z, std::unique_lock<std::mutex>& lock);
  void inferBricks(const std::vector<Brick*>& bricks, std::unique_lock<std::mutex>& lock);
  void finish(Brick& brick);
  bool isAtHand(BrickKey key) const;
  std::int64_t holding() const;

  const std::shared_ptr<const BrickSource> Source;
  const std::int64_t Layers; ///< of a brick, inside its level or not
  const int ThreadCount;

  std::mutex Mutex;              ///< guards what follows, except the threads
  std::condition_variable Wake;  ///< for the threads: there may be something to do
  std::condition_variable Ready; ///< a layer is begun, or a brick finished
  bool Paused = true;
  bool Awaited = false; ///< by loadFor, paused or not
  bool Ended = false;
  std::int64_t LayersBegun = 0;
  std::int64_t Room;
  std::deque<BrickPart> Wanted;
  std::vector<std::unique_ptr<Brick>> InWork;
  std::vector<std::unique_ptr<Brick>> Finished;
  std::size_t HandingOver = 0; ///< bricks
  std::vector<Values> Spare;   ///< of bricks that were handed over
  std::exception_ptr Failure;

  std::vector<std::thread> Threads;
};

} // namespace inr

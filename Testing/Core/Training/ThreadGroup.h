// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Runtime/TrainingGroup.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

/// Where the threads of a group meet.
class Meeting
{
public:
  explicit Meeting(int size) : Given(static_cast<std::size_t>(size)) {}

  std::vector<std::string> gather(int rank, const std::string& bytes)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Given[static_cast<std::size_t>(rank)] = bytes;
    const std::uint64_t round = this->Round;
    if (++this->Arrived == this->Given.size()) {
      this->Arrived = 0;
      this->Known = this->Given;
      ++this->Round;
      this->Changed.notify_all();
    }
    this->Changed.wait(lock, [&] { return this->Round != round; });
    return this->Known; // nobody comes to the end of the next round before all have left this one
  }

private:
  std::mutex Mutex;
  std::condition_variable Changed;
  std::vector<std::string> Given;
  std::vector<std::string> Known;
  std::size_t Arrived = 0;
  std::uint64_t Round = 0;
};

/// A thread of this process as a member of a group.
class ThreadGroup : public inr::TrainingGroup
{
public:
  ThreadGroup(Meeting& meeting, int rank, int size) : Place(meeting), Rank(rank), Size(size) {}

  int rank() const override { return this->Rank; }
  int size() const override { return this->Size; }
  std::vector<std::string> gather(const std::string& bytes) const override
  {
    return this->Place.gather(this->Rank, bytes);
  }

private:
  Meeting& Place;
  int Rank;
  int Size;
};

/// Does `work` in as many threads, each a member of the group.
inline void InGroup(int size, const std::function<void(const ThreadGroup&)>& work)
{
  Meeting meeting(size);
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(size));
  for (int rank = 0; rank < size; ++rank) {
    threads.emplace_back([&, rank] { work(ThreadGroup(meeting, rank, size)); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
}

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Parallel.h"

#include "Core/Random.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#include <unistd.h>
#endif

namespace inr {

int AvailableCores()
{
#ifdef __linux__
  cpu_set_t mask;
  CPU_ZERO(&mask);
  if (sched_getaffinity(0, sizeof(mask), &mask) == 0) {
    return std::max(1, CPU_COUNT(&mask));
  }
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

std::uint64_t KeyOf(std::uint64_t key, const void* bytes, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k) {
    key = RandomBits(key, static_cast<const unsigned char*>(bytes)[k]);
  }
  return key;
}

} // namespace

std::uint64_t MachineKey()
{
#ifdef __linux__
  char host[256] = {};
  gethostname(host, sizeof(host) - 1);
  return KeyOf(0, host, sizeof(host));
#else
  return 0;
#endif
}

std::uint64_t AvailableCoresKey()
{
#ifdef __linux__
  cpu_set_t mask;
  CPU_ZERO(&mask);
  // It fails on machines of more cores than the mask has: they all have one key then.
  sched_getaffinity(0, sizeof(mask), &mask);
  return KeyOf(MachineKey(), &mask, sizeof(mask));
#else
  return MachineKey();
#endif
}

#ifdef INR_SANITIZED_THREADS

namespace {

/// Takes TBB's place under ThreadSanitizer, which knows nothing of the order that the library keeps
/// and would either report races that are none or have to be told to overlook all of them.
void RunOnThreads(int threads, std::int64_t blocks, const std::function<void(std::int64_t)>& run)
{
  std::atomic<std::int64_t> next{0};
  std::mutex guard;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::int64_t k = next++; k < blocks; k = next++) {
        run(k);
      }
    } catch (...) {
      next = blocks;
      const std::lock_guard<std::mutex> lock(guard);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> team;
  for (std::int64_t k = 1; k < std::min<std::int64_t>(threads, blocks); ++k) {
    team.emplace_back(work);
  }
  work();
  for (std::thread& thread : team) {
    thread.join();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

} // namespace

#endif

struct Arena::Implementation
{
  explicit Implementation(int threads) : Tasks(threads) {}
  tbb::task_arena Tasks;
};

Arena::Arena(int threads)
    : Self(std::make_unique<Implementation>(threads > 0 ? threads : AvailableCores()))
{}

Arena::~Arena() = default;

int Arena::threads() const { return this->Self->Tasks.max_concurrency(); }

void Arena::forEachBlock(std::int64_t count, std::int64_t block,
                         const std::function<void(std::int64_t, std::int64_t)>& body) const
{
  if (count <= 0) {
    return;
  }
  const std::int64_t blocks = (count + block - 1) / block;
  const auto run = [&](std::int64_t k) { body(k * block, std::min((k + 1) * block, count)); };
#ifdef INR_SANITIZED_THREADS
  RunOnThreads(this->threads(), blocks, run);
#else
  this->Self->Tasks.execute([&] {
    // simple_partitioner with grain 1: stealing decides who runs a block, never what a block is.
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::int64_t>& range) {
          for (std::int64_t k = range.begin(); k != range.end(); ++k) {
            run(k);
          }
        },
        tbb::simple_partitioner());
  });
#endif
}

} // namespace inr

// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <thread>

#ifdef __linux__
#include <sched.h>
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

/// Debian's TBB is not built for ThreadSanitizer, which therefore does not see that a block comes
/// after what was done before the call and before what is done after it. This tells it.
class Order
{
public:
#ifdef __SANITIZE_THREAD__
  void mark() { this->Steps.fetch_add(1, std::memory_order_acq_rel); }

private:
  std::atomic<int> Steps{0};
#else
  void mark() {}
#endif
};

} // namespace

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
  Order order;
  order.mark();
  this->Self->Tasks.execute([&] {
    // simple_partitioner with grain 1: stealing decides who runs a block, never what a block is.
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::int64_t>& range) {
          for (std::int64_t k = range.begin(); k != range.end(); ++k) {
            order.mark();
            body(k * block, std::min((k + 1) * block, count));
            order.mark();
          }
        },
        tbb::simple_partitioner());
  });
  order.mark();
}

} // namespace inr

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/parallel.h"

#ifdef KINEMARK_SANITIZE_THREAD
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#else
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <thread>

#include "kinemark/core/check.h"

namespace kinemark {
namespace {

#ifdef KINEMARK_SANITIZE_THREAD
/// The thread sanitizer does not see how TBB's library, which is not instrumented, hands work from thread to
/// thread, and would call all of it a race: there, threads of our own take the chunks, and what it finds is
/// ours.
template <class RunChunk>
void run_chunks(std::int64_t chunks, int threads, const RunChunk& run_chunk) {
  std::atomic<std::int64_t> next{0};
  std::mutex guard;
  std::exception_ptr thrown;
  const auto work = [&] {
    for (std::int64_t chunk = next++; chunk < chunks; chunk = next++) try {
        run_chunk(chunk);
      } catch (...) {
        const std::scoped_lock lock(guard);
        if (!thrown) thrown = std::current_exception();
        next = chunks;
      }
  };
  {
    std::vector<std::jthread> workers;
    for (int i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  if (thrown) std::rethrow_exception(thrown);
}
#else
template <class RunChunk>
void run_chunks(std::int64_t chunks, int threads, const RunChunk& run_chunk) {
  tbb::task_arena arena(
      std::min(threads, tbb::info::default_concurrency()));  // more threads than cores only cost
  arena.execute([&] { tbb::parallel_for(std::int64_t{0}, chunks, run_chunk, tbb::simple_partitioner()); });
}
#endif

}  // namespace

int thread_count(int threads) {
  check(threads >= 0, "threads must be 0 (all cores) or more");
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::int64_t count, std::int64_t grain, int threads,
                  const std::function<void(std::int64_t begin, std::int64_t end)>& body) {
  check(count >= 0 && grain >= 1, "parallel_for needs count >= 0 and grain >= 1");
  const std::int64_t chunks = (count + grain - 1) / grain;
  const auto run_chunk = [&](std::int64_t chunk) {
    body(chunk * grain, std::min(count, (chunk + 1) * grain));
  };
  const int n = thread_count(threads);
  if (n == 1 || chunks <= 1) {
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) run_chunk(chunk);
    return;
  }
  run_chunks(chunks, n, run_chunk);
}

}  // namespace kinemark

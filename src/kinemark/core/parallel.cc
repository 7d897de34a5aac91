// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

#include "kinemark/core/check.h"

namespace kinemark {

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
  tbb::task_arena arena(std::min(n, tbb::info::default_concurrency()));  // more threads than cores only cost
  arena.execute([&] { tbb::parallel_for(std::int64_t{0}, chunks, run_chunk, tbb::simple_partitioner()); });
}

}  // namespace kinemark

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/each_seed.h"

#include <atomic>

#include "kinemark/core/parallel.h"

namespace kinemark::studies {

Status run_each(std::int64_t count, int threads, const Progress& progress,
                const std::function<void(std::size_t)>& work) {
  std::atomic<std::int64_t> done = 0;
  std::atomic<bool> stopped = false;
  parallel_for(count, 1, threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last && !stopped; ++i) {
      if (progress && !progress(done, count)) {
        stopped = true;
        break;
      }
      work(static_cast<std::size_t>(i));
      ++done;
    }
  });
  if (stopped) return fail(Code::cancelled, "the study was stopped");
  return {};
}

}  // namespace kinemark::studies

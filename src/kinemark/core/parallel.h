// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

namespace kinemark {

/// Run body(begin, end) over [0, count) in chunks of `grain`, on up to `threads` threads (0: all cores).
///
/// Chunk borders depend on count and grain only, never on the number of threads: a body that works only on
/// its own chunk gives the same bits for any number of threads. An exception in one chunk is rethrown to the
/// caller.
void parallel_for(std::int64_t count, std::int64_t grain, int threads,
                  const std::function<void(std::int64_t begin, std::int64_t end)>& body);

/// Number of threads that `threads` asks for: itself, or the number of cores when it is 0.
[[nodiscard]] int thread_count(int threads);

}  // namespace kinemark

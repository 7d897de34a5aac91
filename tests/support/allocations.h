// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinemark::testing_support {

/// Number of heap allocations (malloc, calloc, realloc, operator new) that this thread has made so far.
/// Linking this file wraps glibc's allocator. Under a sanitizer, which owns the allocator, there is no count:
/// counts_allocations() is false.
[[nodiscard]] std::int64_t allocations_on_this_thread();
[[nodiscard]] bool counts_allocations();

}  // namespace kinemark::testing_support

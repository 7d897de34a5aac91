// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"

namespace kinemark::studies {

/// Runs work(0) to work(count - 1), each once, in any order, on several threads (0: as many as the machine
/// has). `progress` is asked before each; the first no of it ends the run with Code::cancelled once what has
/// begun is done. Throws what `work` throws.
[[nodiscard]] Status run_each(std::int64_t count, int threads, const Progress& progress,
                              const std::function<void(std::size_t)>& work);

}  // namespace kinemark::studies

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

namespace kinemark {

/// Progress callback of long computations: called at intervals with the steps done and the steps in total.
/// Returning false stops the computation, which then ends with Code::cancelled. May be empty.
using Progress = std::function<bool(std::int64_t done, std::int64_t total)>;

}  // namespace kinemark

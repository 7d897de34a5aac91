// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

namespace kinemark {

/// Called now and then by long work with what is done of what there is to do; returns false to stop it (the
/// work then ends with Code::cancelled). May be empty.
using Progress = std::function<bool(std::int64_t done, std::int64_t total)>;

}  // namespace kinemark

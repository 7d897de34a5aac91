// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// Refuse what is there but no regular file, before anybody opens it: to open a pipe or a device may wait for
/// ever or do something. Code::bad_input, saying what it is. Links are followed; a file that is not there, or
/// cannot be asked about, is left to whoever opens it.
[[nodiscard]] Status check_regular(const std::filesystem::path& path);

}  // namespace kinemark::io

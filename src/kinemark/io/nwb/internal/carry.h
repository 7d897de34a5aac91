// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A result put into a copy of the file that it was made from, so that what is no movement goes along
// untouched.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/file.h"

namespace kinemark::io::internal {

/// What came of it.
struct Carried {
  std::vector<std::string> content;  ///< paths of what of the file is ours now
};

/// Put all results of `fresh`, a file of ours, into `copy`, in place of those that it has of us from before.
/// All else in the copy stays as it is, byte for byte: it is not even opened. Both files are ours alone. For
/// a process of its own. Code::bad_input where the copy is damaged, or has an object of others under a name
/// that a result needs; Code::io: the disk.
[[nodiscard]] Result<Carried> carry_here(const std::filesystem::path& copy,
                                         const std::filesystem::path& fresh);

/// Fill `out` with a copy of `source`, and have carry_here() put `fresh` into it, in a process of its own.
/// @param name  of what is written, for messages
[[nodiscard]] Status carry(const std::filesystem::path& source, const std::filesystem::path& fresh,
                           OutputFile& out, const std::string& name);

}  // namespace kinemark::io::internal

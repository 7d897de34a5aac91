// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How a finished file gets its name: never over another one unless that is wanted, and for good.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// Where an output of that name goes: symbolic links are followed, to what may not be there yet. Code::io,
/// naming `path`: something has the name and `force` is false (a link counts, wherever it leads); it is a
/// folder, a device or another thing that is no regular file; links that go in a circle.
[[nodiscard]] Result<std::filesystem::path> find_target(const std::filesystem::path& path, bool force);

/// A setup may come from anywhere, so what it names as output must lie in its own folder or below:
/// Code::usage otherwise. Links are followed. @param element  of the setup that names `output`:
/// "output_motion_file"
[[nodiscard]] Status check_below(const std::filesystem::path& setup, const std::filesystem::path& output,
                                 std::string_view element);

/// What was under the target's name before place_file().
enum class Replaced : std::uint8_t {
  nothing,    ///< there was none
  exchanged,  ///< it is now under the name that the new file had
  gone,       ///< it was replaced; the file system cannot exchange
};

/// Give the file `from` the name `target`, in the same file system. Without `force` a target that exists
/// stays: whoever comes first wins, and Code::io says so to the other. @param exchange  keep what is
/// replaced, for unplace_file()
[[nodiscard]] Result<Replaced> place_file(const std::filesystem::path& from,
                                          const std::filesystem::path& target, bool force,
                                          bool exchange = false);
/// Take that back, as far as can be.
void unplace_file(const std::filesystem::path& from, const std::filesystem::path& target, Replaced replaced);

/// Names in a folder survive a power cut from here on. A file system that cannot promise it is no failure.
[[nodiscard]] Status sync_folder(const std::filesystem::path& folder);

}  // namespace kinemark::io

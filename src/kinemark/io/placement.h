// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files that belong together get their names together, although a system gives one name at a time.
// docs/decisions/0037-one-transaction-for-a-command.md
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// What a hidden folder holds besides finished files while these get their names; no staged file has this
/// name.
inline constexpr std::string_view kPlacementRecord = ".kinemark-placement";

/// A finished file and the name that it is to get.
struct FileToPlace {
  std::filesystem::path staged;  ///< on the disk, in a Temporary::folder_for(target)
  std::filesystem::path
      target;  ///< in the folder that the hidden one is in; links followed, as find_target()
};

/// Give all of them their names for good, in this order, or none: what fails half-way is taken back, as far
/// as the file system can exchange files (place_file()), and so is what a kill or a power cut interrupts, by
/// the next program of ours that writes in one of the folders (remove_leftovers()). Waits for hold_end().
/// Code::io, naming the target, as place_file() and where the disk is full. Cost: two forced
/// writes for each folder.
/// @param made  folders that were made for these files, outermost first: they go again with them
[[nodiscard]] Status place_files(const std::vector<FileToPlace>& files, bool force,
                                 const std::vector<std::filesystem::path>& made = {});

/// The first part of it: what a later program needs to take it back is on the disk.
[[nodiscard]] Status record_placement(const std::vector<FileToPlace>& files,
                                      const std::vector<std::filesystem::path>& made);

/// Take back what a program that is no more began to place from a hidden folder; what had come to its end
/// stays. A file that was changed or replaced since stays as well, and where a folder of the set is not where
/// it was nothing is taken back.
/// @param hidden  a leftover that the caller has locked; it may be gone afterwards
/// @param in_use  a folder that stays, even when nothing is left in it
/// @return        whether the hidden folder may go: false while another program is at work on it
[[nodiscard]] bool take_back_placement(const std::filesystem::path& hidden,
                                       const std::filesystem::path& in_use);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Which files are trials. Browsers know them by number, never by path.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::server {

/// How a file is on the disk: another stamp, another content.
struct Stamp {
  std::int64_t bytes = 0;       ///< size
  std::int64_t changed_ns = 0;  ///< of the content (mtime), since 1970
  std::int64_t renewed_ns = 0;  ///< of the file (ctime), since 1970
  ino_t node = 0;               ///< which file it is
  friend bool operator==(const Stamp&, const Stamp&) = default;
};

/// Of a trial's file, of those that 'kinemark ik' writes beside one, and of its edits; nothing for a file
/// that is not there.
using Stamps = std::vector<std::optional<Stamp>>;

/// @return  at least one, the first being that of `trial` itself
[[nodiscard]] Stamps stamps_of(const std::filesystem::path& trial);

/// One file that is a trial.
struct TrialFile {
  std::uint32_t number = 0;    ///< from 1; its own for as long as the server runs
  std::filesystem::path path;  ///< as given, or in the folder given
};

/// What there is now.
struct TrialListing {
  std::vector<TrialFile> trials;   ///< in the order given, those of a folder by name
  std::vector<std::string> notes;  ///< why a folder has none, one sentence each
};

/// The files and folders that were given. Threads may ask at once.
class TrialFiles {
 public:
  explicit TrialFiles(std::vector<std::filesystem::path> given);  ///< opens nothing

  /// Look again: every file given, and those in the folders whose endings are known, without body models and
  /// without what belongs to another file there ("Q_sd.sto" beside "Q.mot"). A link that leads out of its
  /// folder, and a file beside which such a link stands for one of its own, is a note.
  [[nodiscard]] TrialListing list();
  /// The path of a number that list() gave out; the file may have gone. None where it is a link out of its
  /// folder by now.
  [[nodiscard]] std::optional<std::filesystem::path> path_of(std::uint32_t number) const;

 private:
  /// A file that has a number, and the folder that it must not leave; empty: it was given itself.
  struct Known {
    std::filesystem::path path, folder;
  };
  [[nodiscard]] std::uint32_t number_of(const std::filesystem::path& path,
                                        const std::filesystem::path& folder);

  std::vector<std::filesystem::path> given_;
  mutable std::mutex mutex_;  ///< of what follows
  std::vector<Known> known_;
  std::map<std::filesystem::path, std::uint32_t> numbers_;
};

/// Whether a file is a symbolic link to something outside of a folder, or to nothing that can be found.
[[nodiscard]] bool leads_out(const std::filesystem::path& folder, const std::filesystem::path& file);

/// One sentence (Code::io) on the first of the paths that is not there; as for list(), a folder without
/// trials is an error when it is all there is.
[[nodiscard]] Status check_given(const std::vector<std::filesystem::path>& given);

}  // namespace kinemark::server

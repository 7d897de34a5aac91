// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What lies on the disk before it has its name, and must go with the program, however that ends.
#pragma once

#include <filesystem>
#include <list>
#include <mutex>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// A hidden file or folder, `.kinemark-PID-NUMBER`, in the folder of what it will become. It goes with its
/// object, by end_process() where a signal ends the program, and after a `kill -9` as soon as a program of
/// ours writes in that folder: a lock that the system drops with the process (flock) shows whether its writer
/// lives. Where the file system has no such locks, nothing of others is removed.
class Temporary {
 public:
  /// An empty file beside `target`, open for writing, with the rights that a new file gets. Leftovers in that
  /// folder are removed first. Code::io, naming the target, when it cannot be made.
  static Result<Temporary> file_for(const std::filesystem::path& target);
  /// A folder beside `target`, likewise, that only its owner can read.
  static Result<Temporary> folder_for(const std::filesystem::path& target);
  /// Watches over an empty folder that the caller made for results: it goes again, unless something is in it.
  static Temporary watch_folder(const std::filesystem::path& folder);

  Temporary(Temporary&& other) noexcept;             ///< takes the file over
  Temporary& operator=(Temporary&& other) noexcept;  ///< removes its own and takes the other over
  ~Temporary();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }  ///< as long as it is there
  [[nodiscard]] int fd() const {
    return fd_;
  }  ///< of the open file or folder; -1 of a folder that is watched
  /// It has another name now and stays; its descriptor is closed. The caller holds hold_end().
  void release();

 private:
  Temporary(std::filesystem::path path, int fd);
  void remove();

  std::filesystem::path path_;
  int fd_ = -1;
  std::list<std::filesystem::path>::iterator entry_;  ///< in the list of the process
  bool listed_ = false;
};

/// Whether a path ends in a name of a Temporary: what lies in such a folder has no name yet.
[[nodiscard]] bool is_temporary(const std::filesystem::path& path);

/// Held while files of a set get their names: end_process() waits for it.
[[nodiscard]] std::unique_lock<std::mutex> hold_end();

/// Remove every Temporary of this process and end it without running anything else (`_exit`). For programs
/// that a signal ends, from a thread that waits for signals: not from a signal handler.
[[noreturn]] void end_process(int status);

/// Remove what killed writers left in a folder. Never what a living one needs.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/io/temporary.h"

struct XXH3_state_s;

namespace kinemark::io {

/// A file opened for reading at any offset. Missing or unreadable: Code::io, not a regular file:
/// Code::bad_input (check_regular()), each with one sentence that names the file.
class InputFile {
 public:
  /// Open for reading; Code::io with the system's reason when that cannot be done.
  static Result<InputFile> open(const std::filesystem::path& path);
  InputFile(InputFile&& other) noexcept;             ///< takes the open file over
  InputFile& operator=(InputFile&& other) noexcept;  ///< closes its own and takes the other over
  ~InputFile();

  [[nodiscard]] std::size_t size() const { return size_; }         ///< bytes
  [[nodiscard]] const std::string& name() const { return name_; }  ///< the path as given, for messages
  /// Fill `out` from `offset`; returns the number of bytes there were (less than asked only at the end of the
  /// file).
  [[nodiscard]] Result<std::size_t> read_at(std::size_t offset, std::span<std::byte> out) const;

 private:
  InputFile(int fd, std::size_t size, std::string name) : fd_(fd), size_(size), name_(std::move(name)) {}
  int fd_ = -1;
  std::size_t size_ = 0;
  std::string name_;
};

/// The first 16 KiB of a file or all that there is: enough to tell its format, also by the labels of a table.
[[nodiscard]] Result<std::string> read_begin(const std::filesystem::path& path);

/// The whole file as text. Files over `max_bytes` are refused with Code::bad_input.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& path,
                                            std::size_t max_bytes = 4UL << 30);

/// A file that appears whole or not at all: bytes go to a hidden file in the same folder (Temporary);
/// commit() forces it to the disk, gives it its name and forces that to the disk. Without commit() nothing
/// stays. A target that exists is refused (Code::io) unless `force` is set, also one that came while this one
/// was written: of two writers one wins. With `force` a symbolic link is followed, not replaced.
class OutputFile {
 public:
  /// Begin a file. Code::io when it exists and `force` is false, is not a regular file, or the folder cannot
  /// be written.
  static Result<OutputFile> create(const std::filesystem::path& path, bool force);

  /// Append bytes. A full disk is reported here or by commit().
  [[nodiscard]] Status write(std::span<const std::byte> bytes);
  /// Append text, byte by byte as it is.
  [[nodiscard]] Status write(std::string_view text);
  /// The first text of a file, which holds the place of a sum (kSumKey and kNoSum, io/seal.h): commit() puts
  /// the checksum of the whole file there.
  [[nodiscard]] Status write_sealed(std::string_view text);
  /// Make the file appear under its name, on the disk for good. Code::io when that fails: then there is none.
  [[nodiscard]] Status commit();
  /// The file as it is called until commit(), for libraries that must open it by name. They may change its
  /// content, not replace it.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_.path(); }

 private:
  OutputFile(std::filesystem::path name, std::filesystem::path target, bool force, Temporary temporary);
  std::filesystem::path name_;    ///< as given, for messages
  std::filesystem::path target_;  ///< with links followed
  bool force_ = false;
  Temporary temporary_;
  std::size_t sum_at_ = 0;  ///< where its digits go
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> sum_;  ///< of all that was written; none: it is not sealed
};

/// create(), write() and commit() in one call.
[[nodiscard]] Status write_text(const std::filesystem::path& path, std::string_view text, bool force);

/// The same with write_sealed().
[[nodiscard]] Status write_sealed_text(const std::filesystem::path& path, std::string_view text, bool force);

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The program kinemark-nwb, which does with HDF5 what may crash or never end (docs/decisions/0013).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// What the program is asked to do.
struct ApartJob {
  std::filesystem::path file;     ///< that it opens
  std::string name;               ///< of the file, for messages
  std::vector<std::string> what;  ///< arguments behind its limits
  std::string undone;             ///< what a message ends with: "Nothing was read."
};

/// What the process may use: docs/formats/nwb.md.
struct ApartLimits {
  std::size_t seconds, bytes;

  explicit ApartLimits(std::size_t file_bytes)
      : seconds(5 + 2 * (file_bytes >> 20)), bytes((1UL << 30) + 256 * file_bytes) {}
};

/// The program while it runs.
class Apart {
 public:
  /// Code::io where the file cannot be opened or the program not started, Code::not_supported where it is not
  /// there.
  static Result<Apart> start(ApartJob job);
  Apart(Apart&& other) noexcept;
  Apart& operator=(Apart&&) = delete;
  ~Apart();

  /// What it sends, and how much of that is taken.
  [[nodiscard]] int input() const { return input_; }
  [[nodiscard]] std::size_t most_bytes() const { return limits_.bytes; }
  /// Wait for its end. Code::bad_input, one sentence on how it ended, where it sent nothing of use.
  [[nodiscard]] Status end(bool received);

 private:
  Apart(ApartJob job, ApartLimits limits, pid_t child, int input)
      : job_(std::move(job)), limits_(limits), child_(child), input_(input) {}
  ApartJob job_;
  ApartLimits limits_;
  pid_t child_ = -1;
  int input_ = -1;
};

/// What the program sends, as `receive` takes it.
template <class T>
Result<T> run_apart(ApartJob job, std::optional<Result<T>> (*receive)(int, std::size_t)) {
  auto run = Apart::start(std::move(job));
  if (!run) return std::unexpected(run.error());
  auto received = receive(run->input(), run->most_bytes());
  auto ended = run->end(received.has_value());
  if (!received) return std::unexpected(std::move(ended.error()));
  return std::move(*received);
}

}  // namespace kinemark::io::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// Writes several files that appear together or not at all: they are written into a hidden folder beside each
/// target (one per folder) and moved into place by commit(). Without commit() nothing stays.
class Staging {
 public:
  /// Fails when a target exists (unless `force`), is given twice, or its folder cannot be written.
  static Result<Staging> create(std::vector<std::filesystem::path> targets, bool force);
  Staging(Staging&& other) noexcept;  ///< takes the targets over
  Staging& operator=(Staging&&) = delete;
  ~Staging();

  /// Where to write what will become targets[i].
  [[nodiscard]] std::filesystem::path path(std::size_t i) const;
  /// As given.
  [[nodiscard]] const std::vector<std::filesystem::path>& targets() const { return targets_; }
  /// A failure of writing path(i), reported for targets[i].
  [[nodiscard]] std::unexpected<Error> failure(Error error) const;
  /// Move every file that was written into place.
  [[nodiscard]] Status commit();

 private:
  Staging() = default;
  std::map<std::filesystem::path, std::filesystem::path> folders_;  ///< hidden one in each parent folder
  std::vector<std::filesystem::path> targets_;
};

}  // namespace kinemark::pipeline

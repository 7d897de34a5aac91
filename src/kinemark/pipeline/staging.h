// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// Several files that appear together or not at all: they are written into a hidden folder beside the first
/// target and moved into place by commit(). Without commit() nothing stays.
class Staging {
 public:
  /// Fails when a target exists (unless `force`) or its folder cannot be written.
  static Result<Staging> create(std::vector<std::filesystem::path> targets, bool force);
  Staging(Staging&& other) noexcept;
  Staging& operator=(Staging&&) = delete;
  ~Staging();

  /// Where to write what will become targets[i].
  [[nodiscard]] std::filesystem::path path(std::size_t i) const;
  [[nodiscard]] const std::vector<std::filesystem::path>& targets() const { return targets_; }
  /// Move every file that was written into place.
  [[nodiscard]] Status commit();

 private:
  Staging() = default;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> targets_;
};

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

class NewFolder;

/// Several files that appear together or not at all: they are written into a hidden folder beside each target
/// (one per folder) and moved into place by commit(). Without commit() nothing stays.
class Staging {
 public:
  /// Fails when a target exists (unless `force`), is given twice, or its folder cannot be written.
  static Result<Staging> create(std::vector<std::filesystem::path> targets, bool force);
  /// The same for files of one folder, which is made when absent, and goes again when no file came.
  /// @param names  of the files in it
  static Result<Staging> create_in(const std::filesystem::path& folder, const std::vector<std::string>& names,
                                   bool force);
  Staging(Staging&& other) noexcept;  ///< takes the targets over
  Staging& operator=(Staging&&) = delete;
  ~Staging();

  /// Where to write what will become targets[i].
  [[nodiscard]] std::filesystem::path path(std::size_t i) const;
  /// Where to write what will become `target`, which must be one of the targets.
  [[nodiscard]] std::filesystem::path path_of(const std::filesystem::path& target) const;
  /// As given.
  [[nodiscard]] const std::vector<std::filesystem::path>& targets() const { return targets_; }
  /// The targets whose files have been written, in their order; to be asked before commit().
  [[nodiscard]] std::vector<std::filesystem::path> written() const;
  /// A failure of writing path(i), told of targets[i].
  [[nodiscard]] std::unexpected<Error> failure(Error error) const;
  /// Move every file that was written into place.
  [[nodiscard]] Status commit();

 private:
  Staging();
  std::unique_ptr<NewFolder> made_;                                 ///< goes last
  std::map<std::filesystem::path, std::filesystem::path> folders_;  ///< hidden one in each parent folder
  std::vector<std::filesystem::path> targets_;
};

}  // namespace kinemark::pipeline

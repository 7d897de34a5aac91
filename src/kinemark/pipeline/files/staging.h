// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/io/temporary.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

class NewFolder;

/// All files of a job, which appear together or not at all: they are written into a hidden folder beside each
/// target (one per folder) and moved into place by commit(). Without commit() nothing stays, and what a kill
/// leaves half-way is taken back by the next run that writes there (io::place_files()).
class Staging {
 public:
  /// Fails when a target exists (unless `job.force`), is one of the inputs or of `job.kept` (in any case), is
  /// given twice, or its folder cannot be written.
  /// @param inputs  all files that the job reads, as far as they are known by now; see add_inputs()
  static Result<Staging> create(const std::vector<std::filesystem::path>& targets, const JobSettings& job,
                                const std::vector<std::filesystem::path>& inputs);
  /// The same for files of one folder, which is made when absent, and goes again when no file came.
  /// @param names  of the files in it
  static Result<Staging> create_in(const std::filesystem::path& folder, const std::vector<std::string>& names,
                                   const JobSettings& job, const std::vector<std::filesystem::path>& inputs);
  /// More files of the job, behind the targets that there are; fails as create().
  [[nodiscard]] Status add(const std::vector<std::filesystem::path>& targets);
  /// The same in a folder of their own; fails as create_in().
  [[nodiscard]] Status add_in(const std::filesystem::path& folder, const std::vector<std::string>& names);
  /// The page of the job, beside its results; an empty path is none. Code::usage for one that does not end in
  /// .html; else as add().
  [[nodiscard]] Status add_page(const std::filesystem::path& page);
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
  /// Files that the job has read meanwhile: those that lie beside others, or that others name.
  void add_inputs(const std::vector<std::filesystem::path>& inputs);
  void add_inputs(const std::vector<data::InputFile>& inputs);  ///< the same, as they stand in a record
  /// Move every file that was written into place, one directly after the other, the first target last, as all
  /// of them are on the disk by then. Without force a target that came in the meantime is a failure, and with
  /// it one that is an input, as in create(). After a
  /// failure all is as it was before, where the file system can exchange files.
  [[nodiscard]] Status commit();

 private:
  Staging();
  /// Where a target goes, whose folder gets its hidden one. Fails as create().
  [[nodiscard]] Status add_target(const std::filesystem::path& target);

  /// One of the files.
  struct StagedFile {
    std::filesystem::path target;  ///< with links followed
    std::filesystem::path staged;  ///< in the hidden folder beside it
  };
  bool force_ = false;
  std::vector<std::filesystem::path> inputs_;               ///< that no target may be
  std::vector<std::unique_ptr<NewFolder>> made_;            ///< go last
  std::map<std::filesystem::path, io::Temporary> folders_;  ///< hidden one in each parent folder
  std::vector<std::filesystem::path> targets_;              ///< as given
  std::vector<StagedFile> files_;                           ///< one a target
};

}  // namespace kinemark::pipeline

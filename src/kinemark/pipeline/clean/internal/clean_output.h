// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where the cleaned markers go, one after the other: an .nwb file that is written as they come, or a trial in
// memory and a table of derivatives.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/table.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/pipeline/clean/clean_job.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::pipeline::internal {

// What is said of a run beside the account that the verb gives.

/// What was asked of a run, for the record.
[[nodiscard]] report::CleanRun describe_run(const CleanJob& job, const data::Trial& trial);

/// One marker's result as trajectories and derivatives of one marker. Bridged samples get the filter's name,
/// filled ones keep the method of `from`, measured ones tell that they were smoothed (hand_on()).
struct MarkerPiece {
  data::Trajectories markers;
  data::Derivatives derivatives;

  MarkerPiece(trajectory::MarkerResult result, const data::Trajectories& from);
};

/// Columns NAME_vx, NAME_vx_sd, NAME_vy, ... NAME_jz_sd; m/s, m/s^2, m/s^3.
class DerivativesTable {
 public:
  explicit DerivativesTable(const data::Trajectories& markers);
  void add(const data::Derivatives& derivatives, std::int64_t marker);
  [[nodiscard]] const data::Table& table() const { return table_; }

 private:
  data::Table table_;
};

class CleanOutput {
 public:
  /// `file` is where the recording is written, `smoothed` what the results are made from.
  static Result<CleanOutput> create(const CleanJob& job, const std::filesystem::path& file,
                                    const data::Trial& smoothed, const report::CleanRun& run);
  /// Each marker once, in any order.
  [[nodiscard]] Status take(MarkerPiece piece, std::int64_t marker);
  /// Write the recording, with all else that `trial` holds, and the table if there is one. `trial` gets the
  /// cleaned markers. @param set  that both name  @param lost  gets what the format cannot hold
  [[nodiscard]] Status finish(data::Trial& trial, const std::filesystem::path& derivatives,
                              const std::string& set, std::vector<std::string>& lost);
  /// The cleaned markers, before finish().
  [[nodiscard]] const data::Trajectories& cleaned() const { return cleaned_; }

 private:
  CleanOutput(const CleanJob& job, std::filesystem::path file, const data::Trajectories& smoothed);
  Status finish_nwb(const data::Trial& trial, const std::string& set, std::vector<std::string>& lost);
  bool derivatives_, unfiltered_;
  std::filesystem::path file_;
  data::Trajectories cleaned_;
  std::optional<io::NwbWriter> nwb_;
  std::optional<DerivativesTable> table_;
};

/// Whether a path ends in .nwb, in any case of letters.
[[nodiscard]] bool is_nwb(const std::filesystem::path& path);

}  // namespace kinemark::pipeline::internal

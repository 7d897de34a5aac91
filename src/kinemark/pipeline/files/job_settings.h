// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What all jobs share: how each is asked (`XJob : JobSettings`) and what each answers (`XOutcome :
// JobOutcome`).
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/data/run_record.h"

namespace kinemark::pipeline {

/// What every job is told besides its own task. A job that has no use for a field passes it over.
struct JobSettings {
  int threads = 1;         ///< 0: all cores. Any number gives the same bits.
  std::uint64_t seed = 1;  ///< of everything random
  bool force = false;      ///< replace files that exist
  /// Files that stay as they are whatever the job writes, `force` or not: all that the caller gives to be
  /// read. Staging and check_apart() ask for them besides what the job itself names.
  std::vector<std::filesystem::path> kept;
  std::string command_line;  ///< as typed, for the record
  Progress progress;         ///< may be empty; each run_x() says what it counts
};

/// What every job answers besides its own results.
struct JobOutcome {
  std::vector<std::string> warnings;           ///< what was odd or left out, one sentence each
  std::vector<data::Gate> gates;               ///< bounds that the result had to meet
  std::vector<std::filesystem::path> written;  ///< files that are there now

  /// 0, or 1 when a gate was missed.
  [[nodiscard]] int exit_status() const { return std::ranges::all_of(gates, &data::Gate::passed) ? 0 : 1; }
};

/// A file beside another that takes its name: beside("a/q.mot", "_sd.sto") is a/q_sd.sto.
[[nodiscard]] inline std::filesystem::path beside(const std::filesystem::path& file,
                                                  const std::string& suffix) {
  return file.parent_path() / (file.stem().string() + suffix);
}

/// The ending in lower case, with its dot: ".c3d" of a/B.C3D.
[[nodiscard]] std::string ending_of(const std::filesystem::path& path);

}  // namespace kinemark::pipeline

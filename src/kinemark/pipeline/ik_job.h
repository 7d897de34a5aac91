// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/report/ik_summary.h"

namespace kinemark::pipeline {

/// How coordinates are found: frame by frame, or over the whole recording at once.
enum class Estimator : std::uint8_t { least_squares, smoother };

/// What `kinemark ik` is asked to do. Paths that are empty are not used.
struct IkJob {
  std::filesystem::path model, markers;
  std::filesystem::path
      setup;  ///< OpenSim InverseKinematicsTool file; fills what the other fields leave open
  std::filesystem::path tasks;   ///< OpenSim IKTaskSet file
  std::filesystem::path output;  ///< Q.mot; Q_sd.sto, Q_marker_errors.sto and Q_report.json go beside it
  std::filesystem::path report;  ///< page to write as well
  double rate_hz = 0.0;          ///< of a marker file that tells none (.v3d); 0: not given
  motion::IkOptions options;
  Estimator estimator = Estimator::least_squares;
  bool torques = false;        ///< also Q_torque.sto and Q_torque_sd.sto
  double max_rms_m = 0.05;     ///< quality gate: RMS distance of measured and model markers
  double max_offset_m = 0.05;  ///< quality gate: length of the mean distance vector
  bool force = false;
  std::string command_line;  ///< for the record
};

struct IkOutcome {
  motion::IkResult result;
  report::IkSummary summary;  ///< gates and findings included
  std::vector<std::filesystem::path> written;
  int exit_status = 0;  ///< 0, or 1 when a gate failed
};

/// Read, solve, check and write. Either all files appear or, on a failure, none.
[[nodiscard]] Result<IkOutcome> run_ik(IkJob job, const Progress& progress = {});

/// Files that go beside Q.mot: "Q_sd.sto" and so on.
[[nodiscard]] std::filesystem::path beside(const std::filesystem::path& output, const std::string& suffix);

}  // namespace kinemark::pipeline

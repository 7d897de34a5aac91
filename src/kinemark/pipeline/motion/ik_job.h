// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/pipeline/motion/sensor_settings.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/workflow/motion/ik.h"

namespace kinemark::pipeline {

/// What `kinemark ik` is asked to do. Paths that are empty are not used. Writes Q.mot, Q_sd.sto,
/// Q_marker_errors.sto and Q_report.json.
struct IkJob : MotionJob {
  std::filesystem::path
      setup;  ///< OpenSim InverseKinematicsTool file; fills what the other fields leave open
  std::filesystem::path tasks;                     ///< OpenSim IKTaskSet file
  std::filesystem::path coordinates;               ///< values for its tasks; the setup's, filled by run_ik()
  std::vector<std::string> setup_notes;            ///< where files of the setup were found; by run_ik()
  std::vector<std::filesystem::path> setup_parts;  ///< files that the setup is put together from; likewise
  std::filesystem::path report;                    ///< page to write as well
  motion::IkOptions options;                       ///< of the least squares
  workflow::Estimator estimator = workflow::Estimator::least_squares;  ///< which estimator
  bool marker_locations =
      false;               ///< also Q_marker_locations.sto; a setup's report_marker_locations implies it
  SensorSettings sensors;  ///< besides the markers, on their clock; also Q_orientation_errors.sto
  bool torques = false;    ///< also Q_tau.sto and Q_tau_sd.sto; a file of forces implies it
};

/// What `kinemark ik` did.
struct IkOutcome : MotionOutcome {
  motion::IkResult result;                           ///< motion and fit
  std::optional<motion::OrientationFit> sensor_fit;  ///< of the sensors, where there are any
};

/// Read, solve, judge and write. Either all files appear or, on a failure, none. Threads and seed of the
/// options are the job's. Progress counts frames.
[[nodiscard]] Result<IkOutcome> run_ik(IkJob job);

/// A solution that is on no disk: its page, and what tells it from others.
struct IkPage {
  std::string html;           ///< as run_ik() writes to IkJob::report
  report::IkSummary summary;  ///< findings included
  std::string set;            ///< that the files of run_ik() would name: other numbers, another set
  std::size_t edits = 0;      ///< operations in force that were applied
  std::string digest;         ///< of what they do, io::digest_of()
};

/// What run_ik() computes, with nothing written; output and report of the job are not used. Fails as
/// run_ik(), and with Code::not_supported for more than `most_samples` (frames times markers of the
/// recording).
[[nodiscard]] Result<IkPage> ik_page(IkJob job, std::int64_t most_samples);

/// Fill what the job leaves open (files, time range) from its OpenSim setup file, if it has one.
[[nodiscard]] Status apply_setup(IkJob& job);

/// Add the marker weights and coordinate tasks of the setup and task files, and widen the setup's time range
/// to the frames nearest to its ends, as OpenSim does. Weights already in the job take precedence. A manual
/// value is in radians or metres, as OpenSim takes it; from_file values are read from the coordinate file, in
/// degrees where that says so, and interpolated linearly at the recording's times.
[[nodiscard]] Status apply_tasks(IkJob& job, const model::Model& model, const data::Trajectories& markers);

}  // namespace kinemark::pipeline

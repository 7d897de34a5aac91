// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The steps of a MotionJob that do not depend on how the motion is found: read, name the files, judge, write.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/image_tracks.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/files/edit_input.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/pipeline/motion/torques.h"

namespace kinemark::pipeline::internal {

struct MotionInputs {
  model::Model model;
  data::Trial trial;                        ///< in the model's axes
  data::EditsInForce edits;                 ///< what was applied to it before
  UsedJournal journal;                      ///< whose edits these are
  std::vector<std::string> notes;           ///< what was done to it
  workflow::Axes axes;                      ///< how it came there
  std::optional<data::ImageTracks> images;  ///< at the frames of the trial
  std::vector<data::InputFile> files;       ///< all that were read, for the record
};

/// What of a recording's options a solver has of its own: the range of time, and whether samples are judged.
template <class Options>
void take_recording_options(const RecordingOptions& recording, Options& options) {
  if (std::isfinite(recording.selection.first_time_s))
    options.first_time_s = recording.selection.first_time_s;
  if (std::isfinite(recording.selection.last_time_s)) options.last_time_s = recording.selection.last_time_s;
  options.judge_samples = recording.drops_doubtful(options.judge_samples);
}

/// Model and markers are named, images as they must be. `or_else` ends the advice: " or a --setup that names
/// one".
[[nodiscard]] Status check_named(const MotionJob& job, std::string_view or_else = "");
/// The output is named.
[[nodiscard]] Status check_output_named(const MotionJob& job, std::string_view or_else = "");
[[nodiscard]] Result<MotionInputs> read_inputs(const MotionJob& job);

/// What is known of a run before anything is solved; its options are those of the edits.
[[nodiscard]] report::IkRun begin_run(const MotionJob& job, const MotionInputs& inputs);
/// Files of forces, and what there is to tell of the torques.
[[nodiscard]] Status add_torque_account(report::IkRun& run, const TorqueAccount& account);
/// No value when the path is empty.
[[nodiscard]] Status add_input(report::IkRun& run, const char* role, const std::filesystem::path& path);

/// The fit of the estimate; its warnings and what it found, in words, behind the warnings that are there.
/// @param time  of the estimated motion
void add_fit(report::IkRun& run, data::MarkerFit fit, const TimeBase& time);

/// A gate on the share of `bad` frames: 0.1 %, so that a few of 100,000 do not spoil a trial.
/// @param what  that they did, for the sentence: "did not converge"
void add_frames_gate(report::IkRun& run, std::string name, std::int64_t bad, std::int64_t all,
                     std::string_view what);

/// A gate on the share of samples that were left out, where samples were judged: 5 %.
void add_left_out_gate(report::IkRun& run, const data::JointMotion& motion);

/// A gate that `value` passes when it is at most `bound`. One that fails ends the run with status 1.
void add_gate(report::IkRun& run, std::string name, double value, double bound, std::string unit,
              std::string sentence);
/// The gates that all have: length of the mean marker error, described by `offset_sentence`, and marker RMS;
/// NaN where no marker is seen, which is said instead.
void add_marker_gates(report::IkRun& run, const MotionJob& job, double offset_m, std::string offset_sentence,
                      double rms_m);

/// The job's output, files beside it by their suffixes, and further ones: refused where they exist, and where
/// they are files that the job reads.
/// @param also_read  besides those that every MotionJob names
[[nodiscard]] Result<Staging> stage(const MotionJob& job, const std::vector<std::string>& suffixes,
                                    const std::vector<std::filesystem::path>& further = {},
                                    const std::vector<std::filesystem::path>& also_read = {});
/// Summary, gates and warnings of the outcome. @param markers  as for report::summarize()
[[nodiscard]] Status judge(report::IkRun run, const data::JointMotion& motion,
                           const data::Trajectories* markers, MotionOutcome& outcome);
/// A table for each thing that the motion holds, and Q_report.json. All three must live until they are
/// written.
[[nodiscard]] std::vector<ResultFile> motion_files(const MotionJob& job, const data::JointMotion& motion,
                                                   const report::IkSummary& summary);
/// Name of the set of files of a motion.
[[nodiscard]] std::string name_set(const data::JointMotion& motion, const report::IkRun& run);
/// Write the files and let them appear, unless the caller stops `what` in the last moment. Refused where one
/// of them is a file that was read.
[[nodiscard]] Status write(const MotionJob& job, Staging& staging, const std::vector<ResultFile>& files,
                           std::string_view what, const data::JointMotion& motion, MotionOutcome& outcome);

}  // namespace kinemark::pipeline::internal

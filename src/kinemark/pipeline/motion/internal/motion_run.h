// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The steps of a MotionJob that do not depend on how the motion is found: read, name the files, judge, write.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
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
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/workflow/motion/torques.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::pipeline::internal {

inline constexpr const char* kAnglesFile = "_angles.nwb";  ///< its suffix

struct MotionInputs {
  model::Model model;
  Recording recording;                      ///< in the model's axes, with forces where the job names some
  std::optional<data::ImageTracks> images;  ///< at the frames of the recording
  std::vector<data::InputFile> files;       ///< all that were read, for the record

  [[nodiscard]] const data::ImageTracks* image_tracks() const { return images ? &*images : nullptr; }
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
/// No value when the path is empty.
[[nodiscard]] Status add_input(report::IkRun& run, const char* role, const std::filesystem::path& path);

/// What a verb found, for the record: its fit, facts of its torques, gates; its warnings behind those that
/// are there. A gate that failed ends the run with status 1.
void add_found(report::IkRun& run, const data::MarkerFit& fit, const workflow::TorqueAccount& torques,
               const workflow::Remarks& remarks);

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
/// @param more  members of the report behind those of the summary; an object, or null
[[nodiscard]] std::vector<ResultFile> motion_files(const MotionJob& job, const data::JointMotion& motion,
                                                   const report::IkSummary& summary,
                                                   const nlohmann::ordered_json& more = {});
/// Q_angles.nwb, where the job asks for it: angles with their standard deviations in a copy of the
/// recording's file. All of them must live until it is written.
void add_nwb_file(const MotionJob& job, const data::JointMotion& motion, const report::IkSummary& summary,
                  const data::Beside& beside, std::vector<ResultFile>& files);
/// Name of the set of files of a motion.
[[nodiscard]] std::string name_set(const data::JointMotion& motion, const report::IkRun& run);
/// Write the files and let them appear, unless the caller stops `what` in the last moment. Refused where one
/// of them is a file that was read.
[[nodiscard]] Status write(const MotionJob& job, Staging& staging, const std::vector<ResultFile>& files,
                           std::string_view what, const data::JointMotion& motion, MotionOutcome& outcome);

}  // namespace kinemark::pipeline::internal

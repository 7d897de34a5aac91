// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres and axes of a recording of markers: what to do with the recorder's own samples and with
// defects, segments from a file or from the data, one of several methods, files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/slip.h"
#include "kinemark/stages/skeleton/plausibility/plausibility.h"
#include "kinemark/stages/skeleton/topology/segmentation.h"
#include "kinemark/stages/skeleton/topology/topology.h"

namespace kinemark::pipeline {

/// What `kinemark joints` is asked to do. Paths that are empty are not used. Doubtful samples are dropped
/// unless they are to be kept.
struct JointsJob : JobSettings, RecordingOptions {
  std::filesystem::path input;     ///< .c3d, .trc, .csv, .nwb or .v3d
  std::filesystem::path segments;  ///< TOML, see read_segments(), or the .vsk of a Vicon subject, see
                                   ///< layout_of(); empty: by the markers' names or from the data
  /// A folder (no ending, or there already): centres.csv, centres.c3d, segments.toml and skeleton.json. A
  /// file: the centres in its format, and NAME_skeleton.json beside it. Where no joint is determined, the
  /// JSON alone.
  std::filesystem::path output;
  std::filesystem::path report;        ///< page to write as well, .html
  std::string method = "articulated";  ///< that, or a name of parse_functional_method()
  /// for functional methods: in which segments the centre is held still
  skeleton::Sides sides = skeleton::Sides::both;
  data::JointChoice kind = data::JointChoice::automatic;  ///< of all joints
  double noise_sd_m = 0.0;                                ///< per axis; 0: found
  bool continuity = true;                                 ///< articulated: smooth in time and bridge
  bool soft_tissue = false;     ///< articulated alone: every marker has a noise of its own
  bool keep_upsampled = false;  ///< use the samples that the recorder made as well
};

/// Warnings: what was done before and after, and what is odd. Gates: nothing had to be left out as no body's,
/// every joint was placed in some frame; without a file of segments, every joint that was looked for is
/// determined. The skeleton holds those that are, and no others.
struct JointsOutcome : JobOutcome {
  data::InputFile input;                               ///< the recording
  data::SegmentLayout layout;                          ///< as used; the skeleton's markers are its numbers
  std::vector<std::string> markers;                    ///< names of the recording's markers
  data::Skeleton skeleton;                             ///< segments, joints, centres
  std::optional<skeleton::Segmentation> segmentation;  ///< without a file of segments: what is known, why not
  std::optional<skeleton::Topology> topology;          ///< when the segments were found in the data
  std::vector<data::Finding> slips;                    ///< markers that moved on their segment
  std::vector<double> marker_noise_sd_m;  ///< M, with soft_tissue; NaN where unknown; empty otherwise
  std::vector<skeleton::Implausible>
      left_out;           ///< segments and joints that are no body's: not in the skeleton
  std::string next_step;  ///< what to do about them, one sentence; empty: nothing
};

/// Read, find, write. Either all files appear or, on a failure, none. Segments and joints that cannot be a
/// body's (skeleton::judge_layout(), judge_skeleton()) are left out and reported; Code::bad_input where none
/// is left. Progress counts frames.
[[nodiscard]] Result<JointsOutcome> run_joints(const JointsJob& job);

/// The centres as trajectories, one a joint. States: model_filled where the joint was placed by its frame,
/// interpolated where with the help of others; the method's name ends in ": determined", ": bridged" or
/// ": ambiguous".
[[nodiscard]] data::Trajectories centre_trajectories(const data::Skeleton& skeleton);

}  // namespace kinemark::pipeline

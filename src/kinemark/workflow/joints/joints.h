// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres and axes of a recording of markers: what to do with the recorder's own samples and with
// defects, segments that are given or found, one of several methods.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/plausibility/plausibility.h"
#include "kinemark/stages/skeleton/topology/segmentation.h"
#include "kinemark/stages/skeleton/topology/topology.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// How joints are found.
struct JointsMethod {
  std::string method = "articulated";  ///< that, or a name of skeleton::parse_functional_method()
  /// for functional methods: in which segments the centre is held still
  skeleton::Sides sides = skeleton::Sides::both;
  data::JointChoice kind = data::JointChoice::automatic;  ///< of all joints
  double noise_sd_m = 0.0;                                ///< per axis; 0: found
  bool continuity = true;                                 ///< articulated: smooth in time and bridge
  bool soft_tissue = false;     ///< articulated alone: every marker has a noise of its own
  bool keep_upsampled = false;  ///< use the samples that the recorder made as well

  /// Code::usage for a method that does not exist, a noise that is none, soft tissue of another method.
  [[nodiscard]] Status check() const;
};

/// What is asked of joints().
struct JointsOptions : JointsMethod {
  /// Segments and joints, of the recording's markers by their numbers; none: by the markers' names or from
  /// the data.
  std::optional<data::SegmentLayout> segments;
  bool of_subject = false;    ///< the segments are all that a subject has: joints among them that cannot be
                              ///< found are left out, and what is not joined is solved apart
  bool drop_doubtful = true;  ///< samples that are surely swapped, stuck or false are not used
  int threads = 1;            ///< 0: all cores. Any number gives the same bits.
  Progress progress;          ///< frames
};

/// Remarks: what was done before and after, and what is odd. Gates: nothing had to be left out as no body's,
/// every joint was placed in some frame; without segments that are given, every joint that was looked for is
/// determined. The skeleton holds those that are, and no others.
struct JointsFound {
  data::SegmentLayout layout;        ///< as used; the skeleton's markers are its numbers
  std::vector<std::string> markers;  ///< names of the recording's markers
  data::Skeleton skeleton;           ///< segments, joints, centres
  data::Trajectories used;           ///< markers as they were used, without what was left out
  std::optional<skeleton::Segmentation>
      segmentation;                            ///< without segments that are given: what is known, why not
  std::optional<skeleton::Topology> topology;  ///< when the segments were found in the data
  std::vector<data::Finding> slips;            ///< markers that moved on their segment
  std::vector<double> marker_noise_sd_m;       ///< M, with soft_tissue; NaN where unknown; empty otherwise
  std::vector<skeleton::Implausible>
      left_out;           ///< segments and joints that are no body's: not in the skeleton
  std::string next_step;  ///< what to do about them, one sentence; empty: nothing
  Remarks remarks;        ///< what was odd, and what had to hold
};

/// Screen, lay out, solve, judge. Segments and joints that cannot be a body's (skeleton::judge_layout(),
/// judge_skeleton()) are left out and reported; Code::bad_input where none is left. Frames in words are the
/// recording's own. Fails as JointsMethod::check(), screen_markers(), skeleton::fit_articulated() or
/// find_joints(); Code::cancelled when progress says so.
[[nodiscard]] Result<JointsFound> joints(const data::Recording& recording, const JointsOptions& options = {});

/// The centres as trajectories, one a joint, then fixed joints and ends. States: model_filled where the joint
/// was placed by its frame, interpolated where with the help of others; the method's name ends in ":
/// determined", ": bridged" or
/// ": ambiguous".
[[nodiscard]] data::Trajectories centre_trajectories(const data::Skeleton& skeleton);

/// "Segments from the names of Plug-in Gait and CAST: ..." or from the data, one sentence.
[[nodiscard]] std::string describe_origin(const skeleton::Segmentation& found);

}  // namespace kinemark::workflow

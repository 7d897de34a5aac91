// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segments, joint centres, joint angles and loads of a recording by a definition, without a body model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/recording.h"
#include "kinemark/stages/analysis/kinetics/joint_loads.h"
#include "kinemark/stages/analysis/segments/cross_talk.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/workflow/remarks.h"
#include "kinemark/workflow/segments/output_comparison.h"

namespace kinemark::workflow {

/// A recording in which landmarks of a definition were shown.
struct LandmarkTrial {
  std::string name;                            ///< as the definition calls it
  const data::Recording* recording = nullptr;  ///< not null
};

/// What is asked of segments(), and what is known of the subject.
struct SegmentsOptions {
  /// Of the same subject; null: none; the recording itself: it is its own static trial.
  const data::Recording* static_trial = nullptr;
  std::vector<LandmarkTrial> trials;             ///< of one name the last counts
  std::vector<analysis::SubjectValue> given;     ///< measures of the subject, SI; taken first
  std::vector<analysis::SubjectValue> known;     ///< of a file of the subject; before those of recordings
  std::string name = "the recording";            ///< what sentences call the recording by
  std::string where = {};                        ///< in front of errors of the recording; empty: the name
  std::string static_name = "the static trial";  ///< what sentences call the static trial by
  double noise_sd_m = 0.0;    ///< per axis; 0: the markers' covariance, else found from the samples
  bool drop_doubtful = true;  ///< samples that are surely swapped, stuck or false are not used
  std::int64_t refits = 99;   ///< behind deviations of loads; 0: none
  std::uint64_t seed = 1;     ///< of the refits
  int threads = 1;            ///< 0: all cores. Any number gives the same bits.
};

/// What screening did to the recordings, one sentence each.
struct SegmentsScreening {
  std::vector<std::string> recording;            ///< that is measured
  std::vector<std::string> static_trial;         ///< unless it is the recording
  std::vector<std::vector<std::string>> trials;  ///< of each, in the order of the options
};

/// Gates: static_trial; recording, where pairs are exchanged in it. Remarks: what the static trial is worth,
/// measures in other units, what could not be computed and why, noise, cross-talk, what explains a difference
/// from the recording's own outputs.
struct SegmentsFound {
  std::optional<motion::FoundationJudgement> static_trial;  ///< as it was judged, where one is built on
  analysis::SegmentMotion motion;                           ///< angles, values, points, measures
  analysis::JointLoads loads;  ///< where the definition has joints and the recording plates
  std::vector<std::pair<std::string, analysis::CrossTalk>> cross_talk;  ///< of knees that flex
  OutputComparison comparison;  ///< beside angles and centres that the recording holds; empty: it holds none
  data::Recording used;         ///< as it was measured: doubtful samples are rejected
  SegmentsScreening screening;  ///< what was left out before
  Remarks remarks;              ///< of all that came after
};

/// Screen, judge the static trial, compute segments, compare with outputs of a model that the recording
/// holds, find loads. Points of such a model stand in for markers of which there is no sample.
///
/// Up is Recording::up, else as the plates or the file have it, else z. Static trials have no loads. Edits
/// of the recordings that swap markers stay (leave_out_defects()).
///
/// Code::usage and Code::bad_input as analysis::compute_segments() and find_joint_loads(), naming the
/// recording that they are of. Cost: that of compute_segments(), a few times where outputs differ and causes
/// are tried.
[[nodiscard]] Result<SegmentsFound> segments(const analysis::SegmentDefinition& definition,
                                             const data::Recording& recording,
                                             const SegmentsOptions& options = {});

}  // namespace kinemark::workflow

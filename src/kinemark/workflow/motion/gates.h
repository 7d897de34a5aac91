// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bounds that a motion has to meet which was solved from markers. A gate that is not passed says by how much.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/run_record.h"

namespace kinemark::workflow {

/// How far measured and model markers may lie apart.
struct MarkerBounds {
  double max_rms_m = 0.05;     ///< RMS distance of measured and model markers
  double max_offset_m = 0.05;  ///< length of the mean distance vector
};

using Gates = std::vector<data::Gate>;  ///< in the order in which they were asked

/// A gate that `value` passes when it is at most `bound`; NaN does not pass.
void add_gate(Gates& gates, std::string name, double value, double bound, std::string unit,
              std::string sentence);

/// A gate on the share of `bad` frames: 0.1 %, so that a few of 100,000 do not spoil a trial.
/// @param what  that they did, for the sentence: "did not converge"
void add_frames_gate(Gates& gates, std::string name, std::int64_t bad, std::int64_t all,
                     std::string_view what);

/// A gate on the share of samples that were left out, where samples were judged: 5 %.
void add_left_out_gate(Gates& gates, const data::JointMotion& motion);

/// Length of the mean marker error (m), described by `offset_sentence`, and marker RMS (m); NaN where no
/// marker is seen, which is said instead.
void add_marker_gates(Gates& gates, const MarkerBounds& bounds, double offset_m, std::string offset_sentence,
                      double rms_m);

}  // namespace kinemark::workflow

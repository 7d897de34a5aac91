// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Angles and centres that a file holds beside those that were computed, and what explains a difference.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::workflow {

/// An angle or a centre beside the file's own, over the frames that have both; of its components the worst.
struct ComparedOutput {
  std::string name;         ///< of the definition
  std::string theirs;       ///< as the file has it
  bool angle = true;        ///< rad; false: a centre, m
  double median = 0.0;      ///< of the difference's size
  double p95 = 0.0;         ///< 95 % of frames are below
  double largest = 0.0;     ///< of all frames
  std::int64_t frames = 0;  ///< that have both
};

/// Why outputs differ.
struct Explanation {
  std::vector<analysis::ShownParameter> parameters;  ///< whose value is another in the file's outputs
  std::vector<std::string> points;                   ///< centres by another regression
  double angle_rad = 0.0;  ///< what differs in 95 % of frames with these values, the worst angle
  double point_m = 0.0;    ///< and the worst centre
};

/// What a file's own outputs say about those that were computed.
struct OutputComparison {
  std::vector<ComparedOutput> outputs;            ///< in the order of the definition
  Explanation explanation;                        ///< empty where they agree, and where nothing explains it
  std::vector<analysis::ShownParameter> varying;  ///< of a moving trial: markers changed since the model ran
  bool static_outputs =
      false;  ///< the file's bones are those of a static trial, and this was not taken for one

  [[nodiscard]] bool empty() const { return outputs.empty(); }  ///< the file holds none
  /// Nothing differs by more than 0.1 deg or 0.1 mm in any frame.
  [[nodiscard]] bool agrees() const;
  /// "agrees with the file's own 10 angles to 0.0002 deg and 6 centres to 0.0012 mm", or what differs most.
  [[nodiscard]] std::string summary() const;
  /// Why, one sentence each; empty where they agree.
  [[nodiscard]] std::vector<std::string> findings() const;
};

/// Compare, read the parameters back, and try which of them explain a difference beyond 0.1 deg or 0.1 mm: a
/// parameter is named where its value by the file's outputs is another and the difference grows without it.
/// @param motion  what `input` gave
/// Fails as analysis::compute_segments().
[[nodiscard]] Result<OutputComparison> compare_outputs(const analysis::SegmentDefinition& definition,
                                                       const analysis::SegmentInput& input,
                                                       const analysis::SegmentOptions& options,
                                                       const analysis::SegmentMotion& motion,
                                                       const data::Trial& recording);

}  // namespace kinemark::workflow

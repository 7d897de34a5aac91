// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a formula comes to over the frames of a trial.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/analysis/segments/internal/subject.h"
#include "kinemark/stages/analysis/segments/segment_graph.h"

namespace kinemark::analysis::internal {

/// A formula's mean over the frames that give it, and the standard deviation of that mean.
struct TrialMean {
  /// Over frames, and its deviation.
  Eigen::Vector3d mean = Eigen::Vector3d::Constant(kNaN), sd = Eigen::Vector3d::Constant(kNaN);
  /// In the first and the last of them.
  Eigen::Vector3d first = Eigen::Vector3d::Constant(kNaN), last = Eigen::Vector3d::Constant(kNaN);
  std::int64_t frames = 0;  ///< that give a value
};

/// Values in the frames that give one, a number as the first of three; none where the trial lacks what the
/// formula needs.
[[nodiscard]] Result<std::vector<Eigen::Vector3d>> values_over(const SegmentDefinition& definition,
                                                               const GraphOutput& output,
                                                               const GraphNames& names,
                                                               const Subject& subject,
                                                               const TrialMarkers& trial);

/// Their mean; without any, NaN of no frames.
[[nodiscard]] TrialMean trial_mean(const std::vector<Eigen::Vector3d>& values);

}  // namespace kinemark::analysis::internal

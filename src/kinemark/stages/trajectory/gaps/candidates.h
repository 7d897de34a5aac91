// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/gaps/gap_options.h"

namespace kinemark::trajectory {

/// The fill of one candidate method.
struct CandidateFill {
  std::string name;            ///< "cubic", "walk", "regression, untied", ...
  Eigen::MatrixXd x_in_world;  ///< L x 3, m
  double rms_m = 0.0;          ///< 3D, leave-gap-out, on the windows; infinity without any
  double weight = 0.0;         ///< in the combination
  bool guarded = false;        ///< excluded from it because it deviates from the others
};

/// All candidates for one gap, and their combination: what `automatic` fills in.
struct GapCandidates {
  std::vector<CandidateFill> candidates;  ///< all that were tried
  Eigen::MatrixXd x_in_world;             ///< L x 3, m
  Eigen::VectorXd sd_m;                   ///< L, per axis, with the noise of a sample; NaN without windows
  int windows = 0;                        ///< artificial gaps that weights come from
  std::int64_t window_frames = 0;         ///< their length
  std::vector<std::int64_t> predictors;   ///< markers, most rigid first
  std::vector<std::int64_t> dropped;      ///< markers at wrong positions
};

/// Compare all candidates for one stretch of missing samples, as a whole (not in pieces) and whatever the
/// bounds in the options. For studies of gap filling; fill_gaps() is made of the same parts.
///
/// Frames first to last, both included, of the marker are missing; there is a usable sample on a side or a
/// marker to predict from. Fails as fill_gaps() does, and with usage when the stretch is not such a gap.
[[nodiscard]] Result<GapCandidates> compare_candidates(const data::Trajectories& in, std::int64_t marker,
                                                       std::int64_t first_frame, std::int64_t last_frame,
                                                       const GapOptions& options = {});

}  // namespace kinemark::trajectory

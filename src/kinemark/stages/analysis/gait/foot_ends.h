// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Whether the names of heel and toe of a foot are exchanged: by pelvis, ankle, how far each end rises, and
// the other foot.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"

namespace kinemark::analysis {

struct Progress;

/// What tells the heel of a foot from its toe; NaN: not seen.
struct FootEvidence {
  double pelvis = kNaN;       ///< cosine between the foot and the pelvis, each from back to front; median
  double way = kNaN;          ///< the same with where the body goes
  double heel_m = kNaN;       ///< from the ankle, median, m
  double toe_m = kNaN;        ///< the same of the toe
  double heel_rise_m = kNaN;  ///< from 5 to 95 % of its heights, m
  double toe_rise_m = kNaN;   ///< the same of the toe

  /// Above 0 where the names are right, below 0 where they are exchanged: the pelvis counts 2, the others 1.
  [[nodiscard]] int score() const;
};

/// What is found of both feet; left, right.
struct FootEnds {
  std::array<FootEvidence, 2> evidence;  ///< with heel and toe as they are named
  double between = kNaN;                 ///< cosine between the feet, median
  std::array<bool, 2> exchanged{};       ///< heel is toe, and toe heel
  bool doubtful = false;          ///< backward, or heel and toe exchanged on every foot: nothing tells which
  bool pelvis_exchanged = false;  ///< its front points against every foot, and more speaks for the feet

  /// Why a foot's names are exchanged: "the left foot points against the front of the pelvis, ...".
  /// @param heel, toe  as they are named
  [[nodiscard]] std::string why(data::Side side, const std::string& heel, const std::string& toe) const;
};

/// Judge both feet. A foot is exchanged where its score is -2 or less, and where it points against the other
/// foot and has the lower score, or as high a one and points against the way.
[[nodiscard]] FootEnds judge_foot_ends(const GaitPaths& paths, const Progress& progress);

}  // namespace kinemark::analysis

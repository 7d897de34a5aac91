// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How to turn the cameras, while somebody turns them: the tree held still here and there, live.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"
#include "kinemark/stages/calibration/alignment.h"
#include "kinemark/stages/calibration/still_poses.h"

namespace kinemark::workflow {

inline constexpr int kFewestPoses = 4;  ///< of the tree, before anything is said of the cameras

/// Collects poses of the orientation tree from counts as they come: a second in which all its LEDs are seen
/// by all cameras and none moves is a pose, unless it is where the last one was. From four poses on it says
/// the next adjustment, by align_by_tree(). After a camera was turned, restart().
class AlignmentGuide {
 public:
  /// @param layout   of the counts: three LEDs, the rate and cameras of the rig
  /// @param wanted   the rig as it is to stand  @param sides_m  of the tree: LEDs 1-2, 1-3, 2-3
  /// Code::usage where the layout does not show a tree before this rig.
  [[nodiscard]] static Result<AlignmentGuide> create(const data::Counts& layout, data::Rig wanted,
                                                     const std::vector<double>& sides_m);
  /// The next frame; shapes are a contract. From the fourth pose on, some 0.1 s with each new one.
  void push(std::span<const std::int16_t> counts, std::span<const std::uint8_t> flags);
  /// Forget all poses.
  void restart();
  [[nodiscard]] int poses() const { return poses_.poses(); }  ///< so far
  /// What to do next, one sentence.
  [[nodiscard]] std::string sentence() const;
  /// Of the poses so far; nothing before there are enough, and where they fail to fix the cameras.
  [[nodiscard]] const std::optional<calibration::Alignment>& alignment() const { return alignment_; }

 private:
  AlignmentGuide(data::Counts second, data::Rig wanted, std::vector<Eigen::Vector3d> tree);
  [[nodiscard]] bool is_new(const std::vector<calibration::StillObservation>& pose) const;
  void take_second();

  data::Counts second_;      // that is being filled
  std::int64_t filled_ = 0;  // frames of it
  data::Rig wanted_;
  calibration::StillPoses poses_;
  std::optional<calibration::Alignment> alignment_;
  std::string trouble_;
};

}  // namespace kinemark::workflow

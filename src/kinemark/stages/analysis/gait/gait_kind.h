// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What kind of gait a recording holds: walk, run or sprint, on ground or belt, which way; or none.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/gait_event.h"

namespace kinemark::analysis {

struct GaitPaths;
struct Ground;
struct Progress;
struct Steps;

/// How somebody goes.
enum class GaitManner : std::uint8_t { walk, run, sprint };
/// "walk", "run" or "sprint".
[[nodiscard]] std::string_view to_string(GaitManner manner);

/// Where the feet point against where the body goes.
enum class GaitDirection : std::uint8_t {
  unknown,  ///< no foot and no pelvis of which front and back are named, or none whose names are believed
  forward,
  backward,
  sideways,
};
/// "unknown", "forward", "backward" or "sideways".
[[nodiscard]] std::string_view to_string(GaitDirection direction);

/// The kind of gait, and what it was told from.
struct GaitKind {
  GaitManner manner = GaitManner::walk;              ///< of the whole recording
  GaitDirection direction = GaitDirection::unknown;  ///< while the feet stand
  bool belt = false;                                 ///< the ground moves: a treadmill
  bool turning = false;                              ///< by more than 45 deg
  bool brief = false;                                ///< less than two steps: the kind is about so
  double speed_m_per_s = 0.0;  ///< median of the pelvis over the ground or belt; in Gait of all strides
  double belt_m_per_s = 0.0;   ///< of the ground that stands under the feet
  double belt_least_m_per_s = kNaN, belt_most_m_per_s = kNaN;  ///< of one whose speed changes; NaN: even
  double stride_s = 0.0;                                       ///< usual; in Gait the mean of all strides
  double longer_than_s = kNaN;  ///< no stride was seen whole, each lasts longer than this; NaN: one was
  double turn_rad = 0.0;        ///< range of the headings of stances
  double flight_share = 0.0;    ///< of the frames in which both feet swing
  double bounce_m = kNaN;  ///< pelvis in the middle of a stance above a quarter of a stride before and after
  double arc = kNaN;  ///< turns a stride, at least, of the velocity of a foot in the middle of its stance:
                      ///< none on ground and belt, about one on pedals; NaN: no stance was seen whole
  double left_of_right_m = kNaN;         ///< left foot to the left of the right one, median; NaN: not seen
  double pelvis_left_of_right_m = kNaN;  ///< the same of the two front markers of the pelvis
  double knees_left_of_right_m = kNaN;   ///< the same of the knees
  double ankles_outward_m = kNaN;  ///< outer ankles from their feet's lines to the named sides, the lesser;
                                   ///< NaN: not seen of both feet, or one each way
  bool direction_doubted = false;  ///< unknown, as names of heel and toe contradict the rest
  std::string not_gait;            ///< why it is no locomotion; empty: it is

  /// "walking over ground, forward, 1.11 m/s, strides of 1.20 s", "running on a treadmill, ...".
  [[nodiscard]] std::string sentence() const;
};

/// Whether the feet run: both swing at once for 3 % of the time or more, and the body is lowest, not highest,
/// over a foot that stands. Where no stance is seen whole, a stance of less than 45 % of a stride decides, or
/// a body that is faster than 2.2 m/s, at which people no longer walk.
struct RunEvidence {
  double flight_share = 0.0;   ///< see GaitKind
  double bounce_m = kNaN;      ///< see GaitKind
  double stance_share = kNaN;  ///< of a stride
  double speed_m_per_s =
      0.0;  ///< of the pelvis over the ground, from the first to the last frame that it is known in
  /// The verdict.
  [[nodiscard]] bool runs() const;
};
/// From swings and the pelvis.
[[nodiscard]] RunEvidence run_evidence(const GaitPaths& paths, const Steps& steps,
                                       const Eigen::RowVector2d& ground);

/// Judge the kind.
/// @param events  of the markers, ascending in time
[[nodiscard]] GaitKind judge_kind(const GaitPaths& paths, const Ground& ground, const Steps& steps,
                                  const Progress& progress, const std::vector<data::GaitEvent>& events);

}  // namespace kinemark::analysis

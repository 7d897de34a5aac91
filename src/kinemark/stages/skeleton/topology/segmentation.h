// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segments that nobody named, and which joints between them are known: from the names of known marker sets,
// or from rival segmentations of the data. Theory: docs/theory/joint-centres-unnamed.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/topology/topology.h"

namespace kinemark::skeleton {

/// Rules by which a joint between segments that nobody named is known.
struct SegmentationOptions {
  double least_turn_rad = 0.14;  ///< > 0; SD of the turn about its main axis: 8 degrees
  double most_gap_m = 0.012;     ///< > 0; RMS distance of the places that the two segments give the joint
  double most_spread_m = 0.010;  ///< > 0; RMS distance of the places that rivals give it
  double least_weight = 0.5;     ///< share of the rivals that have the joint, 0 to 1
  double most_rival_weight = 1.0 / 3.0;  ///< share of those that have another one near instead, below this
  double most_sd_m = 0.020;  ///< > 0; SD for each axis of the estimate that follows, across a hinge's axis
  double most_distance_sd_m = 0.015;  ///< > 0; median SD of a marker's distances to the others of its segment
  double skin_sd_m = 0.003;  ///< > 0; noise that skin is reckoned with where a cluster's width is judged

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// One of the segmentations that disagree about a joint: its two clusters and where they place it.
struct RivalJoint {
  std::vector<int> parent, child;  ///< markers
  double weight = 0.0;             ///< share of the rivals that have these two clusters
  double distance_m = 0.0;         ///< from where the joint's own clusters place it
};

/// A joint that was looked for.
struct JudgedJoint {
  std::string name;  ///< "hip_l"; from the data "segment1-segment2", or by its first markers
  std::string parent_name, child_name;  ///< of the segments; empty where they are in no layout
  std::vector<int> parent, child;       ///< markers
  bool known = false;                   ///< its place may be used; false: `reason` says why not
  bool hinge = false;                   ///< turns about one axis; false: ball, or nothing could be measured
  double gap_m = 0.0, turn_rad = 0.0, spread_m = 0.0;  ///< NaN where nothing could be measured
  double weight = 0.0, rival_weight = 0.0;  ///< shares of the rivals that have it, that have another instead
  std::vector<RivalJoint> rivals;           ///< other clusters that place it, or another joint near it
  std::string reason;  ///< why it is not known, begun in lower case, without full stop; empty when it is

  /// "Not determined: joint 'hip_l' between ... : reason."
  [[nodiscard]] std::string sentence(const std::vector<std::string>& markers) const;
};

/// A marker whose distances contradict the segment that its name says.
struct MarkerAside {
  int marker = 0;              ///< its number
  std::string segment;         ///< that its name says
  double distance_sd_m = 0.0;  ///< median over the others there
};

/// Segments and joints of a recording without named segments.
struct Segmentation {
  bool from_names = false;          ///< of known marker sets; false: from the data
  std::vector<std::string> sets;    ///< whose names were used, by number of markers
  data::SegmentLayout layout;       ///< the known joints and their segments, nothing else
  std::vector<double> spread_m;     ///< of each joint of the layout: between rivals
  std::vector<JudgedJoint> joints;  ///< all that were looked for, the known ones as in the layout first
  std::vector<MarkerAside> aside;   ///< from names alone
  std::vector<int> model_outputs;   ///< points that no marker is
  std::vector<int> over_joints;     ///< markers over a joint: on neither side
  std::vector<int> unplaced;        ///< markers on no segment that was looked at
  int rivals = 0;                   ///< different segmentations of the data that were compared
};

/// Segments by the names of known marker sets. Nothing where fewer than half of the markers have such names,
/// or no two neighbouring parts of a body. O(F M^2) in 600 frames.
///
/// A marker whose median distance SD to its segment is above the bound is put aside. Joints lie between
/// anatomical neighbours alone (hip, knee, ankle, shoulder, elbow, wrist), of which both have a pose. Rivals:
/// each half of the recording, and each marker left out.
[[nodiscard]] Result<std::optional<Segmentation>> segment_by_names(const data::Trajectories& markers,
                                                                   const SegmentationOptions& options = {});

/// Segments by how the markers move. Rivals: average linkage of the SD of distances at six thresholds beyond
/// noise, in the whole recording and in each half, and find_topology()'s segments. In each, joints lie
/// between clusters with a pose (three markers or more, not in a line) that turn against each other; places
/// are matched in space. A joint is known when rivals enough have it, agree where it is, its gap is small and
/// few have another joint near it instead.
/// @param topology  of the same markers, without model outputs
[[nodiscard]] Result<Segmentation> segment_by_data(const data::Trajectories& markers,
                                                   const Topology& topology,
                                                   const SegmentationOptions& options = {});

}  // namespace kinemark::skeleton

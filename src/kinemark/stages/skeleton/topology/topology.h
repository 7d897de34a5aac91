// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which markers share a segment and which segments share a joint, from the markers' paths alone.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// Options of find_topology().
struct TopologyOptions {
  double noise_sd_m = 0.0;        ///< of the markers, per axis; 0: found from the steadiest distances
  double least_motion_m = 0.002;  ///< > 0; segments that move less against each other cannot be distinguished
  double most_motion_m = 0.1;     ///< > least_motion_m; spread of distances between segments, at most
  std::int64_t least_frames = 20;   ///< >= 6; pairs seen together in fewer count as never seen together
  std::int64_t most_frames = 4000;  ///< >= 100; of longer recordings so many evenly spaced frames are used
  double doubtful_nats = 6.0;    ///< >= 0; markers with less evidence for their segment, or so much against
                                 ///< one other marker there, are called doubtful
  double doubtful_margin = 2.0;  ///< >= 1; joints whose replacement is not so many times worse are, too
  Array<std::uint8_t> mask;      ///< F x M, 0: not used; empty: all are

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// Confidence in one marker's segment.
struct MarkerEvidence {
  double nats = 0.0;  ///< mean log odds of sharing its segment with the others there, less the best other's
  int second_segment = -1;  ///< that other, or -1
  bool doubtful = false;    ///< nats below the threshold of the options
};

/// Confidence in one joint.
struct JointEvidence {
  double residual_m = 0.0;  ///< of the point, or the distance, that the two segments share
  double margin = 0.0;      ///< residual of the best replacement over its own; infinite where there is none
  bool doubtful = false;    ///< margin below the threshold of the options
};

/// Segments and joints found, and the evidence for each.
struct Topology {
  data::SegmentLayout layout;           ///< segments by their first marker; joints away from the first
  std::vector<MarkerEvidence> markers;  ///< M
  std::vector<JointEvidence> joints;    ///< as layout.joints
  std::vector<std::pair<int, int>> never_together;  ///< pairs of markers seen together in too few frames
  std::vector<int> left_out;                        ///< markers seen in too few frames: on no segment
  double noise_sd_m = 0.0;                          ///< used
  double soft_sd_m = 0.0;  ///< motion of the markers of one segment against each other beyond noise; 0: none
  double independent = 1.0;  ///< effective independent frames per frame: slow changes carry less information
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Segments and joints (after Kirk, O'Brien & Forsyth 2005): markers of one segment keep their distance, two
/// segments with a joint share a point.
///
/// Evidence for each pair: the variance of its distance under "same segment" (noise, and soft tissue as far
/// as the recording shows it) against "another segment" (noise and motion of unknown size); average linkage
/// over the pairs that were seen. Joints: for each pair of segments the residual of the common point,
/// weighted by the precision of each frame's poses; minimum spanning tree. A doubtful marker or joint is
/// in the warnings. Where nothing moves there is one segment and a warning. Code::bad_input when fewer than
/// two markers were ever seen. O(F M^2 + M^3).
[[nodiscard]] Result<Topology> find_topology(const data::Trajectories& trajectories,
                                             const TopologyOptions& options = {});

}  // namespace kinemark::skeleton

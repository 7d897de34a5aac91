// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The markers of a segment as one rigid body: their shape, and its pose in every frame that shows enough of
// them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// Which samples a method may use: those present and, where there is a mask (F x M, 0 leaves out), allowed.
struct Samples {
  const data::Trajectories& trajectories;  ///< kept by the caller
  std::span<const std::uint8_t> mask;      ///< F x M, or empty

  /// Whether a sample may be used.
  [[nodiscard]] bool seen(std::int64_t frame, int marker) const {
    return trajectories.present(frame, marker) &&
           (mask.empty() || mask[trajectories.index(frame, marker)] != 0);
  }
  /// The sample, m.
  [[nodiscard]] Eigen::Vector3d x(std::int64_t frame, int marker) const {
    return trajectories.x(frame, marker);
  }
};

/// Shape and poses of a segment. Origin: mean of its markers; z: along their longest extent.
struct SegmentPoses {
  std::string name;               ///< as in the layout
  std::vector<int> markers;       ///< in the recording
  Eigen::Matrix3Xd x_in_segment;  ///< one column a marker, m; NaN for one that could not be placed
  data::SegmentKind kind =
      data::SegmentKind::line;  ///< line: the rotation about z is not determined, no poses
  double noise_sd_m =
      0.0;  ///< of the markers, per axis: as given, else about the rigid shape; NaN when unknown
  std::vector<std::uint8_t> known;                  ///< F: 1 where the pose is known
  std::vector<Eigen::Matrix3d> world_from_segment;  ///< F; identity where unknown
  std::vector<Eigen::Vector3d> origin;              ///< F, m; zero where unknown
  std::int64_t known_frames = 0;                    ///< of F
  /// Frames in which the markers keep their shape far worse than usual (labels swapped, a marker elsewhere):
  /// left out.
  std::int64_t odd_frames = 0, first_odd_frame = -1;
  /// distance from the shape, RMS, in those frames and in the others
  double odd_rms_m = 0.0, usual_rms_m = 0.0;

  /// A point of the segment, m, taken to the world in a frame whose pose is known.
  [[nodiscard]] Eigen::Vector3d to_world(std::int64_t frame, const Eigen::Vector3d& x) const {
    const auto f = static_cast<std::size_t>(frame);
    return world_from_segment[f] * x + origin[f];
  }
  /// A point of the world, m, taken to the segment in a frame whose pose is known.
  [[nodiscard]] Eigen::Vector3d to_segment(std::int64_t frame, const Eigen::Vector3d& x) const {
    const auto f = static_cast<std::size_t>(frame);
    return world_from_segment[f].transpose() * (x - origin[f]);
  }
};

/// Options of find_segment_poses() and pose_known_shape().
struct SegmentPoseOptions {
  double noise_sd_m = 0.0;            ///< per axis; 0: found from the shape's residuals
  double max_rotation_sd_rad = 0.35;  ///< a frame whose rotation is less certain has no pose
  double odd_factor = 8.0;            ///< a frame this many times worse than the median is odd
};

/// Generalised Procrustes analysis on whatever is visible: a frame that shows many markers starts the shape,
/// the others join it from frames that show three placed ones, then shape and poses are improved in turn.
/// Poses by Kabsch (1976) from three visible markers or more that are not on a line. O(F K), K markers.
[[nodiscard]] SegmentPoses find_segment_poses(const Samples& samples, const std::string& name,
                                              const std::vector<int>& markers,
                                              const SegmentPoseOptions& options = {});

/// Poses of a shape that is known already (one column a marker, NaN: not used).
[[nodiscard]] SegmentPoses pose_known_shape(const Samples& samples, const std::string& name,
                                            const std::vector<int>& markers,
                                            const Eigen::Matrix3Xd& x_in_segment,
                                            const SegmentPoseOptions& options = {});

/// Uncertainty of a segment's pose in a frame, from the noise of the markers (none where that is unknown).
struct PoseNoise {
  Eigen::Vector3d visible_mean = Eigen::Vector3d::Zero();  ///< of the visible markers, in the segment, m
  Eigen::Matrix3d rotation_covariance =
      Eigen::Matrix3d::Zero();  ///< covariance of the rotation error, in the segment, rad^2
  double mean_variance = 0.0;   ///< of the visible markers' mean, per axis, m^2

  /// Covariance in world of a point of the segment, m^2.
  [[nodiscard]] Eigen::Matrix3d at(const Eigen::Matrix3d& world_from_segment, const Eigen::Vector3d& x) const;
};
/// Of a frame whose pose is known.
[[nodiscard]] PoseNoise pose_noise(const Samples& samples, const SegmentPoses& poses, std::int64_t frame);

}  // namespace kinemark::skeleton

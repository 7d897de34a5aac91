// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A standing body that markers are expected on: rigid segments in ball joints, each number with the spread
// that it has among people, postures and laboratories. It is made of marker names alone, or of a model.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/stages/motion/foundations/landmarks.h"

namespace kinemark::motion {

/// Axes of every vector here: x forward, y up, z to the right of a body that stands, m.
struct StandingBody {
  /// A rigid segment, its joint to the one that carries it, and its size.
  struct Segment {
    std::string name;          ///< "right thigh", or the model's name
    int parent = -1;           ///< smaller than its own index; -1: the first
    int mirror = -1;           ///< the same segment of the other side; -1: none
    Side side = Side::middle;  ///< of the body
    Eigen::Vector3d joint_in_parent = Eigen::Vector3d::Zero();  ///< from the parent's joint
    Eigen::Vector3d turn_sd = Eigen::Vector3d::Constant(0.4);   ///< about x, y, z in the parent's axes, rad
    double joint_common_sd = 0.006, joint_own_sd = 0.004;       ///< per axis: both sides alike; by itself, m
    double joint_by_posture = 0.0;  ///< per axis, from one posture to another: spines have many joints, m
    int size = 0;                   ///< index into sizes: along the segment
    int width = -1;                 ///< index into sizes: along z; -1: as size
  };
  /// A size that segments share, as a factor.
  struct Size {
    std::string name;         ///< "thigh r"
    int mirror = -1;          ///< the other side's; -1: none
    double common_sd = 0.06;  ///< share, beside the whole body's size: both sides alike
    double own_sd = 0.02;     ///< share: by itself
  };
  /// A marker where it is expected.
  struct Marker {
    std::string name;                                        ///< as in the recording, or in the model
    int segment = 0;                                         ///< index into segments
    int mirror = -1;                                         ///< its partner on the other side; -1: none
    Eigen::Vector3d x_in_segment = Eigen::Vector3d::Zero();  ///< m, from the segment's joint
    PlaceSpread spread;                                      ///< along x, y, z
  };
  std::vector<Segment> segments;  ///< parents before children
  std::vector<Size> sizes;        ///< as segments use them
  std::vector<Marker> markers;    ///< each on a segment
  double size_sd = 0.20;          ///< of the whole body, share
};

/// The body that markers of these names are expected on; names that are no landmarks are left out, and so is
/// the side of a segment that no marker needs. Of several people ("Ann:LASI", "Bob:LASI") the one with most
/// landmarks, the first by name of those with as many.
[[nodiscard]] StandingBody body_of_names(const std::vector<std::string>& names);

/// A model in its default pose as such a body: every body with a coordinate of rotation is a segment, others
/// belong to the one that carries them. Its markers are where the model has them, with the spread of the
/// landmark that their names tell of. Fails for a model that cannot be compiled.
[[nodiscard]] Result<StandingBody> body_of_model(const data::ModelDescription& model);

}  // namespace kinemark::motion

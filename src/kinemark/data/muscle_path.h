// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The path of a muscle or ligament over the bodies of a model, as a file describes it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/math/scalar_function.h"
#include "kinemark/math/se3.h"

namespace kinemark::data {

/// A place that depends on a coordinate: one number of a moving point.
struct PlaceFunction {
  int coordinate_idx = -1;        ///< of the model; -1: constant f(0)
  math::ScalarFunction function;  ///< of rad or m, to m
};

/// One point of a path. It is fixed in its frame, or moves in it with coordinates.
struct PathPoint {
  std::string name;                                      ///< as the file says, may be empty
  int body_idx = kGround;                                ///< kGround: fixed in the world
  math::SE3 body_from_frame;                             ///< the frame that the place is given in, m
  Eigen::Vector3d x_in_frame = Eigen::Vector3d::Zero();  ///< m; of a moving point not used
  bool moves = false;                                    ///< the place is `place`, not `x_in_frame`
  std::array<PlaceFunction, 3> place;                    ///< x y z in the frame, m
  int condition_idx = -1;  ///< coordinate that must be in range for the point to count; -1: it always does
  double range_min = -std::numeric_limits<double>::infinity();  ///< rad or m
  double range_max = std::numeric_limits<double>::infinity();   ///< rad or m
};

/// A surface on a body that paths bend around.
struct WrapSurface {
  std::string name;              ///< as the file says
  bool is_cylinder = false;      ///< else a sphere, an ellipsoid or a torus, whose shape is not kept
  bool active = true;            ///< paths meet it
  int body_idx = kGround;        ///< kGround: fixed in the world
  math::SE3 body_from_frame;     ///< the frame that its pose is given in, m
  math::SE3 frame_from_surface;  ///< a cylinder lies along z of the surface, its middle in the origin, m
  double radius = 0.0;           ///< m, of a cylinder
  double length = 0.0;           ///< m, of a cylinder
  int side_axis = -1;            ///< 0 x, 1 y, 2 z of the surface: paths keep to one side of it; -1: to any
  int side_sign = 1;             ///< that side, 1 or -1
};

/// A surface and those points of a path between which the path may bend around it.
struct PathWrap {
  WrapSurface surface;   ///< by value: a model's surfaces are few
  int first_point = -1;  ///< of the path's points, from 0; -1: its first
  int last_point = -1;   ///< and the last of them; -1: its last
};

/// The way of a muscle, ligament or spring from one end to the other.
struct MusclePath {
  std::string name;               ///< of the muscle
  std::string kind;               ///< the file's word: "Thelen2003Muscle", "Ligament", ...
  std::vector<PathPoint> points;  ///< from origin to insertion
  std::vector<PathWrap> wraps;    ///< surfaces that the path bends around where it meets them
};

/// What became of the length of a path when a model was scaled.
struct PathScale {
  std::string name;       ///< of the muscle
  double ratio = 1.0;     ///< length after over length before, both in the default pose
  double before_m = 0.0;  ///< length before
  double after_m = 0.0;   ///< and after
  bool wraps =
      false;  ///< the path has surfaces to bend around, other than cylinders: the lengths leave them out
};

}  // namespace kinemark::data

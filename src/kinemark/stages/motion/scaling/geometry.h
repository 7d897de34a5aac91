// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The geometry parameters of a model: sizes of segments, positions of joints and of markers. The description
// is linear in each parameter, so that derivatives are exact and cheap.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/scale_recipe.h"

namespace kinemark::motion {

/// What a geometry parameter is.
enum class ParameterKind : std::uint8_t {
  body_scale,       ///< size of one or more segments, 1 as the model has it
  joint_offset,     ///< one coordinate of a joint's position in its parent, m
  marker_position,  ///< one coordinate of a marker's position in its body, m
};

/// What a parameter moves, per unit.
struct GeometryTerm {
  /// What it moves.
  enum class Moves : std::uint8_t {
    parent_frame,  ///< a joint's frame in the parent body, along `direction` (parent's axes)
    child_frame,   ///< a joint's frame in the child body, along `direction` (child's axes)
    translation,   ///< the function of translation axis `axis` of a joint is multiplied by 1 + rate x
    marker,        ///< a marker, along `direction` (axes of its body)
  };
  Moves moves = Moves::marker;                          ///< what it moves
  int idx = 0;                                          ///< joint or marker of the description
  int axis = 0;                                         ///< translation: which of the joint's axes
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< m per unit
  double rate = 0.0;                                    ///< translation: share per unit
};

/// One geometry parameter: its value in the model, its effect and its prior.
struct GeometryParameter {
  std::string name;                                     ///< in reports
  ParameterKind kind = ParameterKind::marker_position;  ///< what it scales or moves
  double initial = 0.0;             ///< value in the description: 1 for sizes, m for positions
  double prior_sd = 0.0;            ///< > 0; of value - initial, in the units of the value
  std::vector<GeometryTerm> terms;  ///< all that the number moves
};

/// Segments with a common size, each along the axes that are scaled.
struct ScaleGroup {
  std::string name;                     ///< in reports
  std::vector<data::ScaledBody> parts;  ///< bodies and their axes
};

/// Groups for a body whose segments are named as OpenSim's models name them: pelvis and trunk in height
/// (x and y) and width (z), head, and per side upper arm, forearm, hand, thigh, shank and foot: 17 for a
/// whole body. Clavicles and scapulae go with the trunk. Bodies with other names are groups of their own.
/// `symmetric`: both sides share one number.
[[nodiscard]] std::vector<ScaleGroup> default_scale_groups(const data::ModelDescription& model,
                                                           bool symmetric = false);

/// One size per group: joints in and of its bodies, translation functions of joints hung on them, markers.
/// Prior 0.3 means "30 %". Fails for a body that does not exist.
[[nodiscard]] Result<std::vector<GeometryParameter>> scale_parameters(const data::ModelDescription& model,
                                                                      std::span<const ScaleGroup> groups,
                                                                      double prior_sd = 0.3);

/// A marker that sits on a joint centre: it moves with the joint's frame in the parent.
struct MarkerOnJoint {
  std::string marker, joint;  ///< names in the model
};

/// Three offsets (parent's axes) per named joint; all joints but those to the ground when `joints` is empty.
/// Markers of `tied` whose body is the parent of their joint move along. Fails for names that do not exist, a
/// tie across bodies, a joint to the ground.
[[nodiscard]] Result<std::vector<GeometryParameter>> joint_parameters(
    const data::ModelDescription& model, std::span<const std::string> joints = {}, double prior_sd = 0.02,
    std::span<const MarkerOnJoint> tied = {});

/// Three coordinates (axes of its body) per named marker; all markers when `markers` is empty.
[[nodiscard]] Result<std::vector<GeometryParameter>> marker_parameters(
    const data::ModelDescription& model, std::span<const std::string> markers = {}, double prior_sd = 0.005);

/// The description with every parameter moved by change[k] (value - initial).
[[nodiscard]] data::ModelDescription apply_geometry(const data::ModelDescription& model,
                                                    std::span<const GeometryParameter> parameters,
                                                    const Eigen::VectorXd& change);

/// Distance from a body's own joint to one that hangs on it.
struct SegmentLength {
  std::string name;                       ///< "femur_r: hip_r to knee_r"
  int first_joint = 0, second_joint = 0;  ///< indices into the description's joints
  double length_m = 0.0;                  ///< in the description
};

/// All such distances above 10 mm, in the order of the joints; joints to the ground count as a body's own.
[[nodiscard]] std::vector<SegmentLength> segment_lengths(const data::ModelDescription& model);

}  // namespace kinemark::motion

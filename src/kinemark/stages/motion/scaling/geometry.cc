// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/geometry.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/scaling/internal/segments.h"

namespace kinemark::motion {
namespace {

using data::kGround;
using Eigen::Vector3d;

constexpr double kShortest_m = 0.01;

void add_part(std::vector<ScaleGroup>& groups, const std::string& name, const std::string& body,
              const Vector3d& axes) {
  auto it = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
  if (it == groups.end()) it = groups.insert(groups.end(), ScaleGroup{.name = name, .parts = {}});
  it->parts.push_back({.body = body, .axes = axes});
}

GeometryTerm frame_term(GeometryTerm::Moves moves, std::size_t joint, const Vector3d& direction) {
  return {.moves = moves, .idx = static_cast<int>(joint), .direction = direction};
}

/// True where a translation axis is a degree of freedom in metres: it is not part of the body's shape.
bool is_free_slide(const data::AxisDescription& axis) {
  return axis.function.is_identity() && axis.second_coordinate_idx < 0;
}

void add_terms_of_body(const data::ModelDescription& model, int body, const Vector3d& axes,
                       std::vector<GeometryTerm>& terms) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const auto& joint = model.joints[j];
    const auto add = [&](GeometryTerm::Moves moves, const Vector3d& offset) {
      const Vector3d direction = offset.cwiseProduct(axes);
      if (direction.norm() > 0.0) terms.push_back(frame_term(moves, j, direction));
    };
    if (joint.child_body_idx == body)
      add(GeometryTerm::Moves::child_frame, joint.child_from_joint.translation);
    if (joint.parent_body_idx != body) continue;
    add(GeometryTerm::Moves::parent_frame, joint.parent_from_joint.translation);
    for (std::size_t a = 0; a < joint.axes.size(); ++a) {
      const auto& axis = joint.axes[a];
      if (axis.is_rotation || is_free_slide(axis)) continue;
      const Vector3d along = axis.axis.normalized();  // as apply_factors()
      terms.push_back({.moves = GeometryTerm::Moves::translation,
                       .idx = static_cast<int>(j),
                       .axis = static_cast<int>(a),
                       .rate = along.cwiseAbs2().dot(axes)});
    }
  }
  for (std::size_t m = 0; m < model.markers.size(); ++m)
    if (model.markers[m].body_idx == body)
      terms.push_back({.moves = GeometryTerm::Moves::marker,
                       .idx = static_cast<int>(m),
                       .direction = model.markers[m].x_in_body.cwiseProduct(axes)});
}

Status check_prior(double prior_sd, const char* what) {
  if (prior_sd > 0.0) return {};
  return fail(Code::bad_input, fmt::format("the prior of the {} has a standard deviation of {}; need above 0",
                                           what, prior_sd));
}

Result<int> find_joint(const data::ModelDescription& model, const std::string& name) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    if (model.joints[j].name != name) continue;
    if (model.joints[j].parent_body_idx == kGround)
      return fail(
          Code::bad_input,
          fmt::format("joint '{}' is connected to the ground; its position is not a geometry parameter",
                      name));
    return static_cast<int>(j);
  }
  return fail(Code::bad_input, fmt::format("the model has no joint '{}'", name));
}

Result<int> find_marker(const data::ModelDescription& model, const std::string& name) {
  const int m = model.find_marker(name);
  if (m >= 0) return m;
  return fail(Code::bad_input, fmt::format("the model has no marker '{}'", name));
}

}  // namespace

std::vector<ScaleGroup> default_scale_groups(const data::ModelDescription& model, bool symmetric) {
  std::vector<ScaleGroup> groups;
  for (const auto& body : model.bodies) {
    const auto [stem, side] = internal::split_side(body.name);
    const std::string segment = internal::segment_of(stem);
    if (segment == "pelvis" || segment == "trunk") {
      add_part(groups, segment + " height", body.name, Vector3d(1, 1, 0));
      add_part(groups, segment == "trunk" ? "shoulder width" : "pelvis width", body.name, Vector3d(0, 0, 1));
    } else {
      const std::string name = segment.empty() ? stem : segment;
      add_part(groups, symmetric ? name : name + side, body.name, Vector3d::Ones());
    }
  }
  return groups;
}

Result<std::vector<GeometryParameter>> scale_parameters(const data::ModelDescription& model,
                                                        std::span<const ScaleGroup> groups, double prior_sd) {
  if (auto s = check_prior(prior_sd, "segment sizes"); !s) return std::unexpected(s.error());
  std::vector<GeometryParameter> parameters;
  for (const auto& group : groups) {
    GeometryParameter parameter{.name = group.name,
                                .kind = ParameterKind::body_scale,
                                .initial = 1.0,
                                .prior_sd = prior_sd,
                                .terms = {}};
    for (const auto& part : group.parts) {
      const int body = model.find_body(part.body);
      if (body < 0)
        return fail(Code::bad_input,
                    fmt::format("scale group '{}' names body '{}', which the model does not have", group.name,
                                part.body));
      add_terms_of_body(model, body, part.axes, parameter.terms);
    }
    if (!parameter.terms.empty()) parameters.push_back(std::move(parameter));
  }
  return parameters;
}

Result<std::vector<GeometryParameter>> joint_parameters(const data::ModelDescription& model,
                                                        std::span<const std::string> joints, double prior_sd,
                                                        std::span<const MarkerOnJoint> tied) {
  if (auto s = check_prior(prior_sd, "joint places"); !s) return std::unexpected(s.error());
  std::vector<int> chosen;
  for (const auto& name : joints) {
    const auto j = find_joint(model, name);
    if (!j) return std::unexpected(j.error());
    chosen.push_back(*j);
  }
  for (std::size_t j = 0; joints.empty() && j < model.joints.size(); ++j)
    if (model.joints[j].parent_body_idx != kGround) chosen.push_back(static_cast<int>(j));

  std::vector<std::pair<int, int>> ties;  // marker, joint
  for (const auto& [marker, joint] : tied) {
    const auto m = find_marker(model, marker);
    if (!m) return std::unexpected(m.error());
    const auto j = find_joint(model, joint);
    if (!j) return std::unexpected(j.error());
    if (model.markers[at(*m)].body_idx != model.joints[at(*j)].parent_body_idx)
      return fail(Code::bad_input,
                  fmt::format("marker '{}' cannot sit on joint '{}': it is not on the joint's parent body",
                              marker, joint));
    ties.emplace_back(*m, *j);
  }

  std::vector<GeometryParameter> parameters;
  for (const int j : chosen)
    for (int axis = 0; axis < 3; ++axis) {
      const auto& joint = model.joints[at(j)];
      GeometryParameter parameter{.name = fmt::format("{}.{}", joint.name, "xyz"[axis]),
                                  .kind = ParameterKind::joint_offset,
                                  .initial = joint.parent_from_joint.translation[axis],
                                  .prior_sd = prior_sd,
                                  .terms = {}};
      parameter.terms.push_back(frame_term(GeometryTerm::Moves::parent_frame, at(j), Vector3d::Unit(axis)));
      for (const auto& [marker, of_joint] : ties)
        if (of_joint == j)
          parameter.terms.push_back(
              {.moves = GeometryTerm::Moves::marker, .idx = marker, .direction = Vector3d::Unit(axis)});
      parameters.push_back(std::move(parameter));
    }
  return parameters;
}

Result<std::vector<GeometryParameter>> marker_parameters(const data::ModelDescription& model,
                                                         std::span<const std::string> markers,
                                                         double prior_sd) {
  if (auto s = check_prior(prior_sd, "marker positions"); !s) return std::unexpected(s.error());
  std::vector<int> chosen;
  for (const auto& name : markers) {
    const auto m = find_marker(model, name);
    if (!m) return std::unexpected(m.error());
    chosen.push_back(*m);
  }
  for (std::size_t m = 0; markers.empty() && m < model.markers.size(); ++m)
    chosen.push_back(static_cast<int>(m));
  std::vector<GeometryParameter> parameters;
  for (const int m : chosen)
    for (int axis = 0; axis < 3; ++axis)
      parameters.push_back(
          {.name = fmt::format("{}.{}", model.markers[at(m)].name, "xyz"[axis]),
           .kind = ParameterKind::marker_position,
           .initial = model.markers[at(m)].x_in_body[axis],
           .prior_sd = prior_sd,
           .terms = {{.moves = GeometryTerm::Moves::marker, .idx = m, .direction = Vector3d::Unit(axis)}}});
  return parameters;
}

data::ModelDescription apply_geometry(const data::ModelDescription& model,
                                      std::span<const GeometryParameter> parameters,
                                      const Eigen::VectorXd& change) {
  data::ModelDescription out = model;
  std::vector<std::vector<double>> stretch(model.joints.size());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double x = change[static_cast<Eigen::Index>(k)];
    for (const auto& term : parameters[k].terms) {
      if (term.moves == GeometryTerm::Moves::marker) {
        out.markers[at(term.idx)].x_in_body += x * term.direction;
        continue;
      }
      auto& joint = out.joints[at(term.idx)];
      if (term.moves == GeometryTerm::Moves::parent_frame) {
        joint.parent_from_joint.translation += x * term.direction;
      } else if (term.moves == GeometryTerm::Moves::child_frame) {
        joint.child_from_joint.translation += x * term.direction;
      } else {
        auto& factors = stretch[at(term.idx)];
        factors.resize(joint.axes.size(), 1.0);
        factors[at(term.axis)] += x * term.rate;
      }
    }
  }
  for (std::size_t j = 0; j < stretch.size(); ++j)
    for (std::size_t a = 0; a < stretch[j].size(); ++a)
      if (stretch[j][a] != 1.0)
        out.joints[j].axes[a].function = model.joints[j].axes[a].function.scaled(stretch[j][a]);
  return out;
}

std::vector<SegmentLength> segment_lengths(const data::ModelDescription& model) {
  std::vector<SegmentLength> lengths;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const auto& joint = model.joints[j];
    if (joint.parent_body_idx == kGround) continue;
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (model.joints[i].child_body_idx != joint.parent_body_idx) continue;
      const double length =
          (joint.parent_from_joint.translation - model.joints[i].child_from_joint.translation).norm();
      if (length < kShortest_m) continue;
      lengths.push_back({.name = fmt::format("{}: {} to {}", model.bodies[at(joint.parent_body_idx)].name,
                                             model.joints[i].name, joint.name),
                         .first_joint = static_cast<int>(i),
                         .second_joint = static_cast<int>(j),
                         .length_m = length});
    }
  }
  return lengths;
}

}  // namespace kinemark::motion

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/clavicles.h"

#include <fmt/core.h>

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/scaling/internal/segments.h"

namespace kinemark::motion {
namespace {

using data::JointDescription;
using data::ModelDescription;
using Eigen::Vector3d;

constexpr double kClavicle_kg = 0.3;
constexpr double kForward_m = 0.02, kSideways_m = 0.03;  // of the inner end, from the middle of the trunk
constexpr double kRange = 0.7;                           // rad

JointDescription* joint_to(ModelDescription& model, int body) {
  for (auto& joint : model.joints)
    if (joint.child_body_idx == body) return &joint;
  return nullptr;
}

/// Protraction, then elevation, about axes of the trunk.
void set_free(ModelDescription& model, JointDescription& joint, const std::string& side) {
  const double right = side == "_r" ? 1.0 : -1.0;
  joint.type = "CustomJoint";
  joint.parameters.clear();
  joint.axes.clear();
  const auto add_rotation = [&](const char* name, const Vector3d& axis) {
    joint.axes.push_back({.axis = axis, .coordinate_idx = static_cast<int>(model.coordinates.size())});
    model.coordinates.push_back({.name = name + side, .range_min = -kRange, .range_max = kRange});
  };
  add_rotation("clav_protraction", Vector3d(0.0, right, 0.0));
  add_rotation("clav_elevation", Vector3d(-right, 0.0, 0.0));
}

/// A clavicle between trunk and arm; the shoulder stays where it is.
void put_in(ModelDescription& model, int arm, const std::string& side) {
  JointDescription& shoulder = *joint_to(model, arm);
  const int trunk = shoulder.parent_body_idx;
  const int clavicle = static_cast<int>(model.bodies.size());
  const Vector3d end = shoulder.parent_from_joint.translation;
  const Vector3d start(kForward_m, end.y(), side == "_r" ? kSideways_m : -kSideways_m);
  shoulder.parent_body_idx = clavicle;
  shoulder.parent_from_joint.translation = end - start;

  auto& trunk_body = model.bodies[at(trunk)];
  data::BodyDescription body{.name = "clavicle" + side, .com_in_body = 0.5 * (end - start)};
  if (trunk_body.mass > 10.0 * kClavicle_kg) {
    trunk_body.mass -= kClavicle_kg;
    body.mass = kClavicle_kg;
    // A thin rod with a little girth.
    const Vector3d rod = end - start;
    body.inertia_about_com =
        kClavicle_kg / 12.0 * (rod.squaredNorm() * Eigen::Matrix3d::Identity() - rod * rod.transpose()) +
        1e-5 * Eigen::Matrix3d::Identity();
  }
  model.bodies.push_back(std::move(body));
  JointDescription joint{
      .name = "sternoclavicular" + side, .parent_body_idx = trunk, .child_body_idx = clavicle};
  joint.parent_from_joint.translation = start;
  set_free(model, joint, side);
  model.joints.push_back(std::move(joint));
}

}  // namespace

Result<std::vector<std::string>> add_clavicles(ModelDescription& model) {
  ModelDescription changed = model;
  std::vector<std::string> moving;
  bool any_arm = false;
  for (const std::string side : {"_r", "_l"}) {
    const int arm = changed.find_body("humerus" + side);
    if (arm < 0) continue;
    const JointDescription* shoulder = joint_to(changed, arm);
    if (shoulder == nullptr || shoulder->parent_body_idx < 0) continue;
    any_arm = true;
    const auto& parent = changed.bodies[at(shoulder->parent_body_idx)].name;
    const std::string stem = internal::split_side(parent).first;
    if (stem.starts_with("clavicle")) {
      JointDescription* joint = joint_to(changed, shoulder->parent_body_idx);
      if (joint == nullptr || !joint->axes.empty()) continue;
      moving.push_back(parent);
      set_free(changed, *joint, side);
    } else if (internal::segment_of(stem) == "trunk" && !stem.starts_with("scapula")) {
      put_in(changed, arm, side);
      moving.push_back("clavicle" + side);
    }
  }
  if (moving.empty() && any_arm)
    return fail(Code::bad_input,
                fmt::format("the shoulders of model '{}' move already; no clavicle to set free", model.name));
  if (moving.empty())
    return fail(Code::bad_input,
                fmt::format("model '{}' has no humerus_r or humerus_l to give a clavicle", model.name));
  if (auto s = changed.validate(); !s) return std::unexpected(s.error());
  model = std::move(changed);
  return moving;
}

}  // namespace kinemark::motion

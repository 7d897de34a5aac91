// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/testing/small_leg.h"

#include <cmath>
#include <string>
#include <utility>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion::testing_leg {

using Eigen::Vector3d;

namespace {
constexpr double kKneeBent = -0.6;  // about which it moves, rad
}

data::ModelDescription leg() {
  data::ModelDescription model;
  model.name = "leg";
  const auto add_rotation = [&](data::JointDescription& joint, const char* name, const Vector3d& axis) {
    joint.axes.push_back({.axis = axis, .coordinate_idx = static_cast<int>(model.coordinates.size())});
    model.coordinates.push_back({.name = name});
  };
  const auto body = [&](const char* name, double mass, const Vector3d& com) {
    model.bodies.push_back({.name = name, .mass = mass, .com_in_body = com});
    model.bodies.back().inertia_about_com = 0.01 * mass * Vector3d(1.0, 0.3, 0.9).asDiagonal();
  };
  const auto joint = [&](const char* name, int parent, const Vector3d& position) {
    data::JointDescription out{.name = name,
                               .type = "CustomJoint",
                               .parent_body_idx = parent,
                               .child_body_idx = static_cast<int>(model.joints.size())};
    out.parent_from_joint.translation = position;
    return out;
  };
  body("pelvis", 11.0, Vector3d(-0.07, 0.0, 0.0));
  body("femur_r", 9.0, Vector3d(0.0, -0.17, 0.0));
  body("tibia_r", 3.7, Vector3d(0.0, -0.19, 0.0));
  body("calcn_r", 1.2, Vector3d(0.1, 0.03, 0.0));

  auto root = joint("ground_pelvis", data::kGround, Vector3d::Zero());
  root.child_from_joint.translation = Vector3d(0.05, 0.0, 0.0);
  add_rotation(root, "tilt", Vector3d::UnitZ());
  add_rotation(root, "list", Vector3d::UnitX());
  add_rotation(root, "rotation", Vector3d::UnitY());
  for (const auto& [name, axis] :
       {std::pair{"tx", Vector3d(1, 0, 0)}, {"ty", Vector3d(0, 1, 0)}, {"tz", Vector3d(0, 0, 1)}}) {
    add_rotation(root, name, axis);
    root.axes.back().is_rotation = false;
    model.coordinates.back().is_rotation = false;
  }
  model.joints.push_back(root);
  auto hip = joint("hip_r", 0, Vector3d(-0.07, -0.066, 0.083));
  hip.child_from_joint.translation = Vector3d(0.0, 0.01, 0.0);
  add_rotation(hip, "hip_flexion", Vector3d::UnitZ());
  add_rotation(hip, "hip_adduction", Vector3d::UnitX());
  add_rotation(hip, "hip_rotation", Vector3d::UnitY());
  model.joints.push_back(hip);
  auto knee = joint("knee_r", 1, Vector3d(0.0, -0.4, 0.0));
  add_rotation(knee, "knee_angle", Vector3d::UnitZ());
  // The shank rolls forward on the thigh.
  knee.axes.push_back({.is_rotation = false,
                       .axis = Vector3d::UnitX(),
                       .coordinate_idx = static_cast<int>(model.coordinates.size()) - 1,
                       .function = math::ScalarFunction::linear(-0.01, 0.002)});
  model.joints.push_back(knee);
  auto ankle = joint("ankle_r", 2, Vector3d(0.0, -0.43, 0.0));
  add_rotation(ankle, "ankle_angle", Vector3d(0.1, 0.17, 0.98).normalized());
  model.joints.push_back(ankle);

  const auto marker = [&](const char* name, int on, double x, double y, double z) {
    model.markers.push_back({.name = name, .body_idx = on, .x_in_body = Vector3d(x, y, z)});
  };
  marker("RASI", 0, 0.02, 0.03, 0.13);
  marker("LASI", 0, 0.02, 0.03, -0.13);
  marker("SACR", 0, -0.16, 0.04, 0.0);
  marker("THI", 1, 0.02, -0.2, 0.08);
  marker("THA", 1, 0.09, -0.25, 0.0);
  marker("KNE", 1, 0.0, -0.39, 0.06);
  marker("KNM", 1, 0.0, -0.39, -0.05);
  marker("TIB", 2, 0.03, -0.15, 0.05);
  marker("ANK", 2, 0.0, -0.41, 0.05);
  marker("ANM", 2, 0.0, -0.40, -0.04);
  marker("HEE", 3, -0.02, 0.02, 0.0);
  marker("TOE", 3, 0.2, 0.0, 0.03);
  return model;
}

std::vector<GeometryParameter> sizes_and_hip(const data::ModelDescription& model, double size_prior_sd) {
  auto out = scale_parameters(model, default_scale_groups(model), size_prior_sd).value();
  const std::vector<std::string> hip{"hip_r"};
  const auto joints = joint_parameters(model, hip, 0.02).value();
  const auto markers = marker_parameters(model, {}, 0.005).value();
  out.insert(out.end(), joints.begin(), joints.end());
  out.insert(out.end(), markers.begin(), markers.end());
  return out;
}

data::Trajectories record(const data::ModelDescription& description, const Recording& how) {
  const auto model = model::Model::compile(description).value();
  std::vector<std::string> names;
  for (const auto& marker : description.markers) names.push_back(marker.name);
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 60.0, .t0_s = 0.0, .frames = how.frames});
  model::Workspace w(model);
  Random random(how.seed, 7);
  Eigen::VectorXd q(model.coordinate_count());
  for (std::int64_t f = 0; f < how.frames; ++f) {
    const double t = static_cast<double>(f) / 60.0;
    for (int c = 0; c < model.coordinate_count(); ++c) {
      const std::string& name = description.coordinates[static_cast<std::size_t>(c)].name;
      q[c] = how.amplitude *
             (0.3 * std::sin(2.0 * (1.3 + 0.37 * c) * t + c) + 0.15 * std::sin(5.1 * t + 2.0 * c));
      if (name == "knee_angle") q[c] += kKneeBent;
      if (how.knee_still && (name == "knee_angle" || name == "ankle_angle")) q[c] = -0.3;
      if (name.starts_with("t") && name.size() == 2) q[c] *= 0.3;
    }
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      Vector3d x = w.marker.col(m);
      const auto& marker = model.markers()[static_cast<std::size_t>(m)];
      if (how.slide_m != 0.0 && description.markers[static_cast<std::size_t>(m)].body_idx == 1) {
        const int knee = description.find_coordinate("knee_angle");
        const double phase = 1.0 + 2.0 * static_cast<double>(m);
        const Vector3d along(std::cos(phase), std::sin(phase), 0.4);
        x += w.rotation[static_cast<std::size_t>(marker.body)] *
             (how.slide_m * std::sin(3.0 * (q[knee] - kKneeBent)) * along);
      }
      for (int axis = 0; axis < 3; ++axis) x[axis] += how.noise_sd_m * random.gaussian();
      out.x(f, m) = x;
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

}  // namespace kinemark::motion::testing_leg

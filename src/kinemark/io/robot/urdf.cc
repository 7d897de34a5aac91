// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/io/robot/internal/robot_xml.h"
#include "kinemark/io/robot/legal_names.h"
#include "kinemark/io/robot/robot_file.h"
#include "kinemark/io/robot/simple_tree.h"

namespace kinemark::io {
namespace {

using robot::number;
using robot::numbers;
using robot::set;

constexpr const char* kGroundLink = "ground";
constexpr int kMimicDegree = 1;        // of a mimic
constexpr double kFarthest_m = 100.0;  // of a slide that the model does not limit; a URDF's must be limited

/// Roll, pitch and yaw of R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& r) {
  const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  if (std::hypot(r(0, 0), r(1, 0)) < 1e-9) return {std::atan2(-r(1, 2), r(1, 1)), pitch, 0.0};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

bool is_identity(const math::SE3& pose) {
  return pose.translation.isZero(0.0) && pose.rotation.isIdentity(0.0);
}

class Urdf {
 public:
  explicit Urdf(data::ModelDescription model) : model_(std::move(model)) {
    lost_ = make_names_legal(model_);
    tree_ = simplify(model_, kMimicDegree);
    lost_.insert(lost_.end(), tree_.lost.begin(), tree_.lost.end());
    for (const auto& body : model_.bodies) links_.insert(body.name);
    for (const auto& chain : tree_.chains)
      for (const auto& joint : chain.joints) joints_.insert(joint.name);
  }

  RobotText write() {
    root_ = document_.append_child("robot");
    set(root_, "name", model_.name.empty() ? "model" : model_.name);
    // Other programs pass over this element.
    auto compiler = root_.append_child("mujoco").append_child("compiler");
    set(compiler, "fusestatic", "false");
    robot::set_bounds(compiler, model_, lost_);
    set(root_.append_child("link"), "name", kGroundLink);
    for (const auto& chain : tree_.chains) add_chain(chain);
    if (!model_.markers.empty())
      lost_.push_back(
          fmt::format("{} cannot be stored in a .urdf file", counted(std::ssize(model_.markers), "marker")));
    lost_.emplace_back("gravity and the default posture cannot be stored in a .urdf file");
    lost_.emplace_back("muscles, ligaments, geometry, contact and controllers are not written");
    return {.text = robot::text_of(document_), .lost = std::move(lost_)};
  }

 private:
  void add_chain(const SimpleChain& chain) {
    const std::string& body = model_.bodies[at(chain.body_idx)].name;
    std::string parent =
        chain.parent_body_idx < 0 ? kGroundLink : model_.bodies[at(chain.parent_body_idx)].name;
    math::SE3 origin = chain.parent_from_chain;
    const bool ends_at_body = !chain.joints.empty() && is_identity(chain.chain_from_body);
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      const bool is_last = j + 1 == chain.joints.size();
      const std::string child =
          is_last && ends_at_body ? body : unused(fmt::format("{}_axis{}", body, j + 1), links_);
      add_moving(chain.joints[j], origin, parent, child);
      if (child != body) set(root_.append_child("link"), "name", child);
      parent = child;
      origin = {};
    }
    if (!ends_at_body)
      add_joint(unused(body + "_fixed", joints_), "fixed", origin * chain.chain_from_body, parent, body);
    add_link(model_.bodies[at(chain.body_idx)]);
  }

  /// The name, with "_" behind it until it is new among those.
  static std::string unused(std::string name, std::set<std::string>& taken) {
    while (!taken.insert(name).second) name += '_';
    return name;
  }

  pugi::xml_node add_joint(const std::string& name, const char* type, const math::SE3& origin,
                           const std::string& parent, const std::string& child) {
    auto joint = root_.append_child("joint");
    set(joint, "name", name);
    set(joint, "type", type);
    auto node = joint.append_child("origin");
    set(node, "xyz", numbers(origin.translation));
    set(node, "rpy", numbers(roll_pitch_yaw(origin.rotation)));
    set(joint.append_child("parent"), "link", parent);
    set(joint.append_child("child"), "link", child);
    return joint;
  }

  void add_moving(const SimpleJoint& joint, const math::SE3& origin, const std::string& parent,
                  const std::string& child) {
    const auto* coordinate =
        joint.coordinate_idx < 0 ? nullptr : &model_.coordinates[at(joint.coordinate_idx)];
    const bool limited =
        coordinate != nullptr && coordinate->clamped && coordinate->range_min < coordinate->range_max;
    const char* type = !joint.is_rotation ? "prismatic" : limited ? "revolute" : "continuous";
    auto node = add_joint(joint.name, type, origin, parent, child);
    set(node.append_child("axis"), "xyz", numbers(joint.axis));
    if (limited || !joint.is_rotation) {
      auto limit = node.append_child("limit");
      set(limit, "lower", number(limited ? coordinate->range_min : -kFarthest_m));
      set(limit, "upper", number(limited ? coordinate->range_max : kFarthest_m));
      set(limit, "effort", "1000");
      set(limit, "velocity", "100");
    }
    for (const auto& coupling : tree_.couplings)
      if (coupling.dependent == joint.name) {
        auto mimic = node.append_child("mimic");
        set(mimic, "joint", coupling.independent);
        set(mimic, "multiplier", number(coupling.function.coefficients[1]));
        set(mimic, "offset", number(coupling.function.coefficients[0]));
      }
  }

  void add_link(const data::BodyDescription& body) {
    auto link = root_.append_child("link");
    set(link, "name", body.name);
    if (!(body.mass > 0.0)) return;
    auto inertial = link.append_child("inertial");
    auto origin = inertial.append_child("origin");
    set(origin, "xyz", numbers(body.com_in_body));
    set(origin, "rpy", "0 0 0");
    set(inertial.append_child("mass"), "value", number(body.mass));
    const Eigen::Matrix3d values = robot::positive_inertia(body);
    auto inertia = inertial.append_child("inertia");
    constexpr std::array<std::tuple<const char*, int, int>, 6> kNames{
        {{"ixx", 0, 0}, {"ixy", 0, 1}, {"ixz", 0, 2}, {"iyy", 1, 1}, {"iyz", 1, 2}, {"izz", 2, 2}}};
    for (const auto& [name, i, j] : kNames) set(inertia, name, number(values(i, j)));
  }

  data::ModelDescription model_;
  SimpleTree tree_;
  std::vector<std::string> lost_;
  std::set<std::string> links_, joints_;  ///< names that are taken
  pugi::xml_document document_;
  pugi::xml_node root_;
};

}  // namespace

RobotText urdf_of(const data::ModelDescription& model) { return Urdf(model).write(); }

}  // namespace kinemark::io

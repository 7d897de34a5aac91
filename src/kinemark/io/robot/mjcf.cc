// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <map>
#include <pugixml.hpp>
#include <utility>

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

constexpr int kEqualityDegree = 4;  // of the polynomials of a joint equality

class Mjcf {
 public:
  explicit Mjcf(data::ModelDescription model) : model_(std::move(model)) {
    lost_ = make_names_legal(model_);
    tree_ = simplify(model_, kEqualityDegree);
    lost_.insert(lost_.end(), tree_.lost.begin(), tree_.lost.end());
  }

  RobotText write() {
    auto root = document_.append_child("mujoco");
    set(root, "model", model_.name.empty() ? "model" : model_.name);
    auto compiler = root.append_child("compiler");
    set(compiler, "angle", "radian");
    robot::set_bounds(compiler, model_, lost_);
    set(root.append_child("option"), "gravity", numbers(model_.gravity));
    auto world = root.append_child("worldbody");
    nodes_.assign(model_.bodies.size(), {});
    for (const auto& chain : tree_.chains)
      add_body(chain, chain.parent_body_idx < 0 ? world : nodes_[at(chain.parent_body_idx)]);
    for (const auto& marker : model_.markers)
      add_site(marker, marker.body_idx < 0 ? world : nodes_[at(marker.body_idx)]);
    add_couplings(root);
    add_posture(root, world);
    lost_.emplace_back("muscles, ligaments, geometry, contact and controllers are not written");
    return {.text = robot::text_of(document_), .lost = std::move(lost_)};
  }

 private:
  /// MuJoCo's joints stand in the frame of the body that they move.
  void add_body(const SimpleChain& chain, pugi::xml_node parent) {
    const auto& body = model_.bodies[at(chain.body_idx)];
    auto node = parent.append_child("body");
    nodes_[at(chain.body_idx)] = node;
    const math::SE3 pose = chain.parent_from_chain * chain.chain_from_body;
    const Eigen::Quaterniond q(pose.rotation);
    set(node, "name", body.name);
    set(node, "pos", numbers(pose.translation));
    set(node, "quat", fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z()));
    const math::SE3 body_from_chain = chain.chain_from_body.inverse();
    for (const auto& joint : chain.joints) add_joint(joint, body_from_chain, node);
    if (!(body.mass > 0.0)) return;
    const Eigen::Matrix3d inertia = robot::positive_inertia(body);
    auto inertial = node.append_child("inertial");
    set(inertial, "pos", numbers(body.com_in_body));
    set(inertial, "mass", number(body.mass));
    set(inertial, "fullinertia",
        numbers(inertia.diagonal()) + " " + numbers({inertia(0, 1), inertia(0, 2), inertia(1, 2)}));
  }

  void add_joint(const SimpleJoint& joint, const math::SE3& body_from_chain, pugi::xml_node body) {
    auto node = body.append_child("joint");
    set(node, "name", joint.name);
    set(node, "type", joint.is_rotation ? "hinge" : "slide");
    set(node, "axis", numbers(body_from_chain.rotation * joint.axis));
    set(node, "pos", numbers(body_from_chain.translation));
    if (joint.coordinate_idx < 0) return;
    const auto& coordinate = model_.coordinates[at(joint.coordinate_idx)];
    if (coordinate.clamped && coordinate.range_min < coordinate.range_max) {
      set(node, "limited", "true");
      set(node, "range", fmt::format("{} {}", coordinate.range_min, coordinate.range_max));
    }
  }

  static void add_site(const data::MarkerDescription& marker, pugi::xml_node body) {
    auto node = body.append_child("site");
    set(node, "name", marker.name);
    set(node, "pos", numbers(marker.x_in_body));
    set(node, "size", "0.01");
  }

  void add_couplings(pugi::xml_node root) const {
    if (tree_.couplings.empty()) return;
    auto equality = root.append_child("equality");
    for (const auto& coupling : tree_.couplings) {
      auto node = equality.append_child("joint");
      set(node, "joint1", coupling.dependent);
      set(node, "joint2", coupling.independent);
      auto coefficients = coupling.function.coefficients;
      coefficients.resize(kEqualityDegree + 1, 0.0);
      set(node, "polycoef", fmt::format("{}", fmt::join(coefficients, " ")));
    }
  }

  /// The default posture, in MuJoCo's order of joints: a body's own, then those of the bodies that it
  /// carries.
  void add_posture(pugi::xml_node root, pugi::xml_node world) const {
    std::map<std::string, double> values;
    for (const auto& chain : tree_.chains)
      for (const auto& joint : chain.joints) values[joint.name] = joint.default_value;
    std::string q;
    for (const auto& found : world.select_nodes(".//joint"))
      q += (q.empty() ? "" : " ") + number(values[found.node().attribute("name").value()]);
    if (q.empty()) return;
    auto key = root.append_child("keyframe").append_child("key");
    set(key, "name", "default");
    set(key, "qpos", q);
  }

  data::ModelDescription model_;
  SimpleTree tree_;
  std::vector<std::string> lost_;
  pugi::xml_document document_;
  std::vector<pugi::xml_node> nodes_;  ///< of the bodies
};

}  // namespace

RobotText mjcf_of(const data::ModelDescription& model) { return Mjcf(model).write(); }

}  // namespace kinemark::io

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/testing/random_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/math/euler.h"

namespace kinemark::model::testing {
namespace {

using data::AxisDescription;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using math::ScalarFunction;

class Builder {
 public:
  explicit Builder(std::uint64_t seed) : random_(seed, 0) {}

  data::ModelDescription build() {
    out_.name = "random tree";
    add_bodies();
    add_coordinates();
    add_couplings();
    add_joints();
    add_markers_and_constraints();
    list_children_first();
    return std::move(out_);
  }

 private:
  double number(double size) { return random_.uniform(-size, size); }
  Vector3d vector(double size) { return {number(size), number(size), number(size)}; }
  Vector3d direction() {
    const Vector3d v(random_.gaussian(), random_.gaussian(), random_.gaussian());
    return v * (random_.uniform(0.5, 2.0) / v.norm());  // axes in files are not of unit length
  }
  int below(int n) { return static_cast<int>(random_.uniform(0.0, n)); }
  math::SE3 frame() { return {math::exp_so3(vector(1.5)), vector(0.3)}; }

  void add_bodies() {
    for (int b = 0; b < 10; ++b) {
      data::BodyDescription body;
      body.name = "body" + std::to_string(b);
      body.mass = b == 1 ? 0.0 : random_.uniform(0.2, 3.0);  // the welded body may be massless
      body.com_in_body = vector(0.1);
      Matrix3d root;
      for (int i = 0; i < 3; ++i) root.col(i) = vector(0.2);
      body.inertia_about_com = root * root.transpose() + 0.01 * Matrix3d::Identity();
      if (b == 1) body.inertia_about_com.setZero();
      out_.bodies.push_back(body);
    }
  }

  void add_coordinates() {
    const auto add = [&](const char* name, bool is_rotation) {
      out_.coordinates.push_back({.name = name, .is_rotation = is_rotation, .default_value = number(0.3)});
    };
    for (const char* name : {"rz", "rx", "ry"}) add(name, true);
    for (const char* name : {"tx", "ty", "tz"}) add(name, false);
    for (const char* name :
         {"a0", "a1", "a2", "knee", "patella", "two0", "two1", "chain1", "chain2", "pin", "last"})
      add(name, true);
    add("slide", false);
    add("idle", true);        // drives nothing
    add("idle_slave", true);  // coupled, drives nothing
  }

  int coordinate(const char* name) const { return out_.find_coordinate(name); }

  ScalarFunction spline(bool natural, double size) {
    std::vector<double> x, y;
    for (int i = 0; i < 6; ++i) {
      x.push_back(-0.9 + 0.35 * i + number(0.05));
      y.push_back(number(size));
    }
    auto made = natural ? ScalarFunction::natural_spline(x, y) : ScalarFunction::simm_spline(x, y);
    return made.value();
  }

  void couple(const char* dependent, const char* independent, ScalarFunction function) {
    out_.couplings.push_back({.name = dependent,
                              .dependent_idx = coordinate(dependent),
                              .independent_idx = coordinate(independent),
                              .function = std::move(function)});
  }

  void add_couplings() {
    // Listed so that a chain comes before what it needs.
    couple("chain2", "chain1", ScalarFunction::polynomial({0.1, 0.8, -0.3, 0.2}));
    couple("chain1", "knee", ScalarFunction::sine(0.7, 1.3, 0.2, 0.1));
    couple("patella", "knee", spline(true, 0.5));
    couple("idle_slave", "knee", ScalarFunction::linear(2.0, -0.1));
  }

  AxisDescription rotation(const char* name, ScalarFunction function = {}) {
    return {.is_rotation = true,
            .axis = direction(),
            .coordinate_idx = coordinate(name),
            .function = std::move(function)};
  }
  AxisDescription shift(const char* name, ScalarFunction function = {}) {
    return {.is_rotation = false,
            .axis = direction(),
            .coordinate_idx = coordinate(name),
            .function = std::move(function)};
  }
  AxisDescription times(AxisDescription axis, const char* second, ScalarFunction function) {
    axis.second_coordinate_idx = coordinate(second);
    axis.second_function = std::move(function);
    return axis;
  }

  std::vector<AxisDescription> root_axes() {
    std::vector<AxisDescription> axes;
    for (const bool rotation : {true, false}) {
      std::array<int, 3> order{0, 1, 2};
      for (int i = 2; i > 0; --i)
        std::swap(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(below(i + 1))]);
      const std::array<const char*, 3> names = rotation ? std::array<const char*, 3>{"rz", "rx", "ry"}
                                                        : std::array<const char*, 3>{"tx", "ty", "tz"};
      for (std::size_t i = 0; i < 3; ++i) {
        AxisDescription axis;
        axis.is_rotation = rotation;
        axis.axis = Vector3d::Unit(order[i]) * (below(2) == 0 ? 1.0 : -2.0);
        axis.coordinate_idx = coordinate(names[i]);
        if (below(2) == 0) axis.function = ScalarFunction::linear(-1.0, 0.0);
        axes.push_back(axis);
      }
    }
    return axes;
  }

  void add_joint(int child, int parent, std::vector<AxisDescription> axes) {
    out_.joints.push_back({.name = "joint" + std::to_string(child),
                           .type = axes.empty() ? "WeldJoint" : "CustomJoint",
                           .parent_body_idx = parent,
                           .child_body_idx = child,
                           .parent_from_joint = child == 3 ? math::SE3{} : frame(),
                           .child_from_joint = child == 4 ? math::SE3{} : frame(),
                           .axes = std::move(axes)});
  }

  void add_joints() {
    add_joint(0, data::kGround, root_axes());
    add_joint(1, 0, {});
    add_joint(2, below(2), {rotation("a0"), rotation("a1"), rotation("a2")});
    AxisDescription offset = shift("knee", ScalarFunction::constant(0.07));
    offset.coordinate_idx = -1;
    add_joint(3, below(3),
              {rotation("knee", ScalarFunction::linear(-1.0, 0.1)), rotation("knee", spline(true, 0.4)),
               rotation("knee", spline(false, 0.4)), shift("knee", spline(false, 0.1)),
               shift("knee", ScalarFunction::polynomial({0.01, 0.1, -0.05})), offset});
    // Moved by the same coordinate from another joint, through a coupling and directly.
    add_joint(4, below(4),
              {rotation("patella"), shift("knee", spline(false, 0.1)), shift("patella", spline(false, 0.1))});
    add_joint(5, below(5),
              {rotation("two0"), rotation("two1"),
               times(rotation("two0", spline(true, 0.5)), "two1", ScalarFunction::sine(0.6, 2.0, 0.3, 0.2)),
               times(shift("two1", ScalarFunction::polynomial({0.1, 0.2, 0.3})), "two0",
                     ScalarFunction::linear(0.5, 0.2)),
               times(rotation("two1", ScalarFunction::sine(0.4, 1.5, 0.0, 0.1)), "two1", spline(true, 0.5)),
               times(shift("chain1", ScalarFunction::linear(0.3, 0.1)), "two1",
                     ScalarFunction::sine(0.2, 1.0, 0.5, 0.3))});
    add_joint(6, below(6),
              {rotation("chain2"), shift("slide"), shift("chain1", ScalarFunction::linear(0.2, 0.0))});
    add_joint(7, below(7), {rotation("last", ScalarFunction::linear(1.7, 0.3))});
    add_joint(8, data::kGround, {rotation("pin")});
    add_joint(9, 8,
              {rotation("chain2", ScalarFunction::linear(0.5, 0.0)),
               rotation("knee", ScalarFunction::sine(0.5, 1.0, 0.0, 0.0))});
  }

  void add_markers_and_constraints() {
    for (int m = 0; m < 22; ++m)
      out_.markers.push_back({.name = "m" + std::to_string(m),
                              .body_idx = m % 11 == 10 ? data::kGround : m % 11,
                              .x_in_body = vector(0.3)});
    out_.point_constraints.push_back({.name = "loop",
                                      .body_a_idx = 3,
                                      .body_b_idx = 6,
                                      .point_in_a = vector(0.2),
                                      .point_in_b = vector(0.2)});
    out_.point_constraints.push_back({.name = "hook",
                                      .body_a_idx = data::kGround,
                                      .body_b_idx = 9,
                                      .point_in_a = vector(0.2),
                                      .point_in_b = vector(0.2)});
  }

  void list_children_first() {
    const int last = static_cast<int>(out_.bodies.size()) - 1;
    std::ranges::reverse(out_.bodies);
    const auto flip = [last](int& body) {
      if (body >= 0) body = last - body;
    };
    for (auto& joint : out_.joints) {
      flip(joint.parent_body_idx);
      flip(joint.child_body_idx);
    }
    for (auto& marker : out_.markers) flip(marker.body_idx);
    for (auto& constraint : out_.point_constraints) {
      flip(constraint.body_a_idx);
      flip(constraint.body_b_idx);
    }
  }

  Random random_;
  data::ModelDescription out_;
};

}  // namespace

data::ModelDescription random_tree(std::uint64_t seed) { return Builder(seed).build(); }

Eigen::VectorXd random_vector(Eigen::Index n, double size, Random& random) {
  Eigen::VectorXd v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = random.uniform(-size, size);
  return v;
}

Eigen::VectorXd random_state(const Model& model, Random& random) {
  Eigen::VectorXd x = random_vector(model.state_count(), 1.2, random);
  for (const auto& free : model.free_joints()) {
    for (int i = 3; i < 7; ++i) x[free.state_idx + i] = random.gaussian();
    x.segment<4>(free.state_idx + 3).normalize();
  }
  return x;
}

double relative_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return INFINITY;
  if (a.size() == 0) return 0.0;
  const double worst = (a - b).cwiseAbs().maxCoeff();
  return std::isfinite(worst) ? worst / std::max(1.0, b.cwiseAbs().maxCoeff()) : INFINITY;
}

}  // namespace kinemark::model::testing

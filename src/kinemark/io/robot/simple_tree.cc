// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/simple_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

using data::AxisDescription;
using Eigen::Vector3d;

constexpr std::size_t kNamed = 8;
constexpr double kNoError = 1e-9, kUnlimited = 1e6;
constexpr int kGridPoints = 41;

std::string amount(double value, bool is_rotation) {
  return is_rotation ? fmt::format("{:.3g} deg", value * 180.0 / std::numbers::pi)
                     : fmt::format("{:.3g} mm", value * 1e3);
}

PolynomialFit line(const math::ScalarFunction& function) {
  return {.coefficients = {function.offset(), function.slope()}};
}

/// What follows a coordinate that has a joint.
struct Led {
  int leader_idx = 0;
  std::function<double(double)> function;  ///< of the leader
};

class Simplifier {
 public:
  Simplifier(const data::ModelDescription& model, int degree)
      : model_(model), degree_(degree), owner_(model.coordinates.size(), nullptr) {
    for (const auto& c : model_.coordinates) {
      default_q_.push_back(c.default_value);
      names_.insert(c.name);
    }
    for (std::size_t round = 0; round < model_.couplings.size(); ++round)
      for (const auto& c : model_.couplings)
        default_q_[at(c.dependent_idx)] = c.function(default_q_[at(c.independent_idx)]).f;
    for (const auto& joint : model_.joints)
      for (const auto& axis : joint.axes)
        if (can_own(axis)) owner_[at(axis.coordinate_idx)] = &axis;
  }

  SimpleTree simplify() {
    // Every round places the bodies whose parents are placed; validate() has seen that there is no circle.
    std::vector<bool> placed(model_.bodies.size(), false);
    for (std::size_t round = 0; round < model_.bodies.size(); ++round)
      for (const auto& joint : model_.joints) {
        if (placed[at(joint.child_body_idx)] ||
            (joint.parent_body_idx >= 0 && !placed[at(joint.parent_body_idx)]))
          continue;
        placed[at(joint.child_body_idx)] = true;
        out_.chains.push_back(chain_of(joint));
      }
    take_couplings();
    note_loops();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const data::CoordinateDescription& coordinate(int index) const {
    return model_.coordinates[at(index)];
  }

  /// Whether it is locked, or follows one that is.
  [[nodiscard]] bool is_held(int index) const {
    if (coordinate(index).locked) return true;
    const auto* coupling = coupling_of(index);
    return coupling != nullptr && (coupling->function.is_constant() || is_held(coupling->independent_idx));
  }

  /// Whether it stays as it is without a loss.
  [[nodiscard]] bool is_still(const AxisDescription& axis) const {
    const auto rests = [&](int c, const math::ScalarFunction& f) {
      return c < 0 || f.is_constant() || is_held(c);
    };
    return rests(axis.coordinate_idx, axis.function) &&
           rests(axis.second_coordinate_idx, axis.second_function);
  }

  [[nodiscard]] bool can_own(const AxisDescription& axis) const {
    return !is_still(axis) && axis.second_coordinate_idx < 0 && owner_[at(axis.coordinate_idx)] == nullptr &&
           axis.is_rotation == coordinate(axis.coordinate_idx).is_rotation && axis.function.is_linear() &&
           std::abs(axis.function.slope()) == 1.0;
  }

  [[nodiscard]] std::pair<double, double> range(int index) const {
    const auto& c = coordinate(index);
    if (c.range_min < c.range_max && std::max(std::abs(c.range_min), std::abs(c.range_max)) < kUnlimited)
      return {c.range_min, c.range_max};
    const double reach = c.is_rotation ? std::numbers::pi : 1.0;
    return {-reach, reach};
  }

  [[nodiscard]] static double moved_by(const AxisDescription& axis, double first, double second) {
    const double f = axis.function(first).f;
    return axis.second_coordinate_idx < 0 ? f : f * axis.second_function(second).f;
  }

  [[nodiscard]] double default_amount(const AxisDescription& axis) const {
    const auto q = [&](int c) { return c < 0 ? 0.0 : default_q_[at(c)]; };
    return moved_by(axis, q(axis.coordinate_idx), q(axis.second_coordinate_idx));
  }

  /// The most that an axis leaves its place in the default posture, over the ranges of its coordinates.
  [[nodiscard]] double most_moved(const AxisDescription& axis) const {
    const auto value = [&](int c, int step) {
      if (c < 0) return 0.0;
      const auto [low, high] = range(c);
      return low + (high - low) * step / (kGridPoints - 1);
    };
    double most = 0.0;
    for (int i = 0; i < kGridPoints; ++i)
      for (int j = 0; j < kGridPoints; ++j)
        most = std::max(most, std::abs(moved_by(axis, value(axis.coordinate_idx, i),
                                                value(axis.second_coordinate_idx, j)) -
                                       default_amount(axis)));
    return most;
  }

  [[nodiscard]] const data::CouplingDescription* coupling_of(int dependent) const {
    const auto found =
        std::ranges::find(model_.couplings, dependent, &data::CouplingDescription::dependent_idx);
    return found == model_.couplings.end() ? nullptr : &*found;
  }

  /// The same function of the nearest coordinate up the couplings that has a joint; none where no such one
  /// is.
  [[nodiscard]] std::optional<Led> led(int leader, std::function<double(double)> function) const {
    while (owner_[at(leader)] == nullptr) {
      const auto* coupling = coupling_of(leader);
      if (coupling == nullptr) return std::nullopt;
      function = [inner = std::move(function), coupling](double q) { return inner(coupling->function(q).f); };
      leader = coupling->independent_idx;
    }
    return Led{leader, std::move(function)};
  }

  [[nodiscard]] std::optional<Led> led(const AxisDescription& axis) const {
    if (axis.second_coordinate_idx >= 0) return std::nullopt;
    return led(axis.coordinate_idx, [&axis](double q) { return axis.function(q).f; });
  }

  /// A line stays as it is where no other function comes between.
  [[nodiscard]] PolynomialFit fit(const Led& led, int followed_idx,
                                  const math::ScalarFunction& function) const {
    if (led.leader_idx == followed_idx && function.is_linear()) return line(function);
    const auto [low, high] = range(led.leader_idx);
    return fit_polynomial(led.function, low, high, degree_);
  }

  void add_follower(const data::JointDescription& joint, const AxisDescription& axis, const Led& led,
                    const Vector3d& direction, SimpleChain& chain) {
    const int leader = led.leader_idx;
    auto fitted = fit(led, axis.coordinate_idx, axis.function);
    std::string name = fmt::format("{}_{}", joint.name, &axis - joint.axes.data() + 1);
    while (!names_.insert(name).second) name += '_';
    if (fitted.largest_error > kNoError)
      out_.lost.push_back(
          fmt::format("joint '{}': its {} {} follows '{}' by a polynomial of degree {}, at most {} off",
                      joint.name, axis.is_rotation ? "rotation" : "translation",
                      &axis - joint.axes.data() + 1, coordinate(leader).name, fitted.coefficients.size() - 1,
                      amount(fitted.largest_error, axis.is_rotation)));
    chain.joints.push_back({.name = name,
                            .is_rotation = axis.is_rotation,
                            .axis = direction,
                            .default_value = fitted(default_q_[at(leader)])});
    out_.couplings.push_back(
        {.dependent = name, .independent = coordinate(leader).name, .function = std::move(fitted)});
  }

  /// Adds the joint of an axis; what is left to turn or move by for good.
  double take_axis(const data::JointDescription& joint, const AxisDescription& axis,
                   const Vector3d& direction, SimpleChain& chain) {
    if (is_still(axis)) return default_amount(axis);
    const int c = axis.coordinate_idx;
    if (c >= 0 && owner_[at(c)] == &axis) {
      chain.joints.push_back({.name = coordinate(c).name,
                              .coordinate_idx = c,
                              .is_rotation = axis.is_rotation,
                              .axis = axis.function.slope() * direction,
                              .default_value = default_q_[at(c)]});
      return axis.function.offset();
    }
    if (const auto followed = led(axis)) {
      add_follower(joint, axis, *followed, direction, chain);
      return 0.0;
    }
    out_.lost.push_back(
        fmt::format("joint '{}': its {} {}, which no joint of one axis makes, is held where the default "
                    "posture has it: at most {} off",
                    joint.name, axis.is_rotation ? "rotation" : "translation", &axis - joint.axes.data() + 1,
                    amount(most_moved(axis), axis.is_rotation)));
    return default_amount(axis);
  }

  SimpleChain chain_of(const data::JointDescription& joint) {
    SimpleChain chain{.body_idx = joint.child_body_idx, .parent_body_idx = joint.parent_body_idx};
    Vector3d moved = Vector3d::Zero();
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
    // Translations first, whatever their place in the list; then rotations, each in the frame that those
    // before it turned.
    for (const bool rotations : {false, true})
      for (const auto& axis : joint.axes) {
        if (axis.is_rotation != rotations) continue;
        const Vector3d unit = axis.axis.normalized();
        const double constant = take_axis(joint, axis, turned * unit, chain);
        if (rotations)
          turned *= math::axis_angle(unit, constant);
        else
          moved += constant * unit;
      }
    chain.parent_from_chain = joint.parent_from_joint * math::SE3{.translation = moved};
    chain.chain_from_body = math::SE3{.rotation = turned} * joint.child_from_joint.inverse();
    return chain;
  }

  void take_couplings() {
    for (const auto& c : model_.couplings) {
      if (owner_[at(c.dependent_idx)] == nullptr) continue;
      const std::string& name = coordinate(c.dependent_idx).name;
      const auto followed = led(c.independent_idx, [&c](double q) { return c.function(q).f; });
      if (!followed) {
        out_.lost.push_back(
            fmt::format("coordinate '{}' follows '{}', which has no joint of its own, and is free here", name,
                        coordinate(c.independent_idx).name));
        continue;
      }
      const std::string& leader = coordinate(followed->leader_idx).name;
      auto fitted = fit(*followed, c.independent_idx, c.function);
      if (fitted.largest_error > kNoError)
        out_.lost.push_back(
            fmt::format("coordinate '{}' follows '{}' by a polynomial of degree {}, at most {} off", name,
                        leader, fitted.coefficients.size() - 1,
                        amount(fitted.largest_error, coordinate(c.dependent_idx).is_rotation)));
      out_.couplings.push_back({.dependent = name, .independent = leader, .function = std::move(fitted)});
    }
  }

  void note_loops() {
    if (model_.point_constraints.empty()) return;
    std::vector<std::string> names;
    for (const auto& c : model_.point_constraints) names.push_back(c.name);
    out_.lost.push_back(fmt::format("{} left open: {}",
                                    counted(std::ssize(names), "closed loop is", "closed loops are"),
                                    join_some(names, kNamed)));
  }

  const data::ModelDescription& model_;
  int degree_;
  std::vector<const AxisDescription*> owner_;  ///< of the coordinates: the axis that is their joint
  std::vector<double> default_q_;
  std::set<std::string, std::less<>> names_;  ///< of joints
  SimpleTree out_;
};

}  // namespace

SimpleTree simplify(const data::ModelDescription& model, int degree) {
  return Simplifier(model, degree).simplify();
}

}  // namespace kinemark::io

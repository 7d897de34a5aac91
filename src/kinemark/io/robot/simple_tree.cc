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

  /// Whether it stays as it is without a loss.
  [[nodiscard]] bool is_still(const AxisDescription& axis) const {
    const auto rests = [&](int c, const math::ScalarFunction& f) {
      return c < 0 || f.is_constant() || coordinate(c).locked;
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

  /// A function of the nearest coordinate up the couplings that has a joint; none where no such one is.
  [[nodiscard]] std::optional<std::pair<int, std::function<double(double)>>> led(
      const AxisDescription& axis) const {
    if (axis.second_coordinate_idx >= 0) return std::nullopt;
    int leader = axis.coordinate_idx;
    std::function<double(double)> function = [&axis](double q) { return axis.function(q).f; };
    while (owner_[at(leader)] == nullptr) {
      const auto* coupling = coupling_of(leader);
      if (coupling == nullptr) return std::nullopt;
      function = [inner = std::move(function), coupling](double q) { return inner(coupling->function(q).f); };
      leader = coupling->independent_idx;
    }
    return std::pair{leader, std::move(function)};
  }

  void add_follower(const data::JointDescription& joint, const AxisDescription& axis, int leader,
                    const std::function<double(double)>& function, const Vector3d& direction,
                    SimpleChain& chain) {
    const auto [low, high] = range(leader);
    const bool is_line = leader == axis.coordinate_idx && axis.function.is_linear();
    auto fit = is_line ? line(axis.function) : fit_polynomial(function, low, high, degree_);
    std::string name = fmt::format("{}_{}", joint.name, &axis - joint.axes.data() + 1);
    while (!names_.insert(name).second) name += '_';
    if (fit.largest_error > kNoError)
      out_.lost.push_back(fmt::format(
          "joint '{}': its {} {} follows '{}' by a polynomial of degree {}, at most {} off", joint.name,
          axis.is_rotation ? "rotation" : "translation", &axis - joint.axes.data() + 1,
          coordinate(leader).name, fit.coefficients.size() - 1, amount(fit.largest_error, axis.is_rotation)));
    chain.joints.push_back({.name = name,
                            .is_rotation = axis.is_rotation,
                            .axis = direction,
                            .default_value = fit(default_q_[at(leader)])});
    out_.couplings.push_back(
        {.dependent = name, .independent = coordinate(leader).name, .function = std::move(fit)});
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
    if (const auto function = led(axis)) {
      add_follower(joint, axis, function->first, function->second, direction, chain);
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
      const std::string& leader = coordinate(c.independent_idx).name;
      if (owner_[at(c.independent_idx)] == nullptr) {
        out_.lost.push_back(fmt::format(
            "coordinate '{}' follows '{}', which has no joint of its own, and is free here", name, leader));
        continue;
      }
      const auto [low, high] = range(c.independent_idx);
      auto fit = c.function.is_linear()
                     ? line(c.function)
                     : fit_polynomial([&c](double q) { return c.function(q).f; }, low, high, degree_);
      if (fit.largest_error > kNoError)
        out_.lost.push_back(fmt::format(
            "coordinate '{}' follows '{}' by a polynomial of degree {}, at most {} off", name, leader,
            fit.coefficients.size() - 1, amount(fit.largest_error, coordinate(c.dependent_idx).is_rotation)));
      out_.couplings.push_back({.dependent = name, .independent = leader, .function = std::move(fit)});
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

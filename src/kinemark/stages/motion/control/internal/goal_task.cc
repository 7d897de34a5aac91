// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/goal_task.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/math/se3.h"
#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/control/internal/two_points.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLine_m2 = 1e-4;  // sum of squared distances from a line: below, markers lie in it

/// Part of a marker's weight that its goal has at this instant, 0 to 1.
double seen_share(const GoalValues& goal, const Eigen::VectorXd& full, int marker) {
  return full[marker] > 0.0 ? goal.weight[marker] / full[marker] : 0.0;
}

/// A rigid body laid on the goals of its markers.
struct Laid {
  Matrix3d turn = Matrix3d::Identity(), axes = Matrix3d::Identity(), spread_inverse = Matrix3d::Zero();
  Vector3d spread = Vector3d::Zero();  // about the axes, m^2, smallest first
  Vector3d velocity = Vector3d::Zero(), acceleration = Vector3d::Zero();
  double fade = 0.0;  // 0: it cannot be laid
};

class OrientationOfMarkers : public GoalTask {
 public:
  OrientationOfMarkers(std::string body, Eigen::VectorXd weights)
      : body_(std::move(body)), weights_(std::move(weights)) {}

  [[nodiscard]] std::string name() const override { return fmt::format("orientation of '{}'", body_); }
  [[nodiscard]] int rows() const override { return 3; }
  [[nodiscard]] double points() const override { return static_cast<double>(markers_.size()); }

  [[nodiscard]] Status bind(const model::Model& model) override {
    const auto body = body_by_name(model, body_);
    if (!body) return std::unexpected(body.error());
    if (is_welded(model, *body))
      return fail(Code::bad_input, "the body is welded to the ground; it cannot be turned");
    idx_ = *body;
    markers_.clear();
    in_body_.clear();
    GoalValues own(model.marker_count());
    for (int m = 0; m < model.marker_count(); ++m) {
      if (model.markers()[at(m)].body != idx_) continue;
      markers_.push_back(m);
      in_body_.push_back(model.markers()[at(m)].x_in_body);
      own.x.col(m) = in_body_.back();
      own.weight[m] = 1.0;
    }
    if (lay(own, Eigen::VectorXd::Ones(model.marker_count())).fade >= 1.0) return {};
    return fail(Code::bad_input, fmt::format("needs three tracked markers of the body that are not in one "
                                             "line; there are {}",
                                             markers_.size()));
  }

  void follow(const model::Model& model, const model::Workspace& w, const GoalValues& goal,
              const Eigen::VectorXd& full, TaskRows& out, Eigen::MatrixXd* gains) const override {
    const Laid laid = lay(goal, full);
    if (gains != nullptr) gains->setZero(3, 3 * static_cast<Eigen::Index>(markers_.size()));
    if (!(laid.fade > 0.0)) {
      out.weight.setZero();
      return;
    }
    const Matrix3d to_axes = laid.axes.transpose();
    const Eigen::AngleAxisd miss(Matrix3d(laid.turn * w.rotation[at(idx_)].transpose()));
    out.error = to_axes * (miss.angle() * miss.axis());
    out.goal_velocity = to_axes * laid.velocity;
    out.goal_acceleration = to_axes * laid.acceleration;
    out.velocity = to_axes * w.body_velocity[at(idx_)].w;
    out.bias = to_axes * w.body_bias[at(idx_)].w;
    for (const int column : model.bodies()[at(idx_)].support)
      out.jacobian.col(model.columns()[at(column)].speed) += to_axes * w.column[at(column)].w;
    out.weight = laid.fade * laid.spread;
    if (gains == nullptr) return;
    const Vector3d middle = mean(goal, full, [this](std::size_t i) { return in_body_[i]; });
    for (std::size_t i = 0; i < markers_.size(); ++i)
      gains->middleCols<3>(3 * static_cast<Eigen::Index>(i)) = share(goal, full, i) * to_axes *
                                                               laid.spread_inverse *
                                                               math::skew(laid.turn * (in_body_[i] - middle));
  }

 private:
  [[nodiscard]] double share(const GoalValues& goal, const Eigen::VectorXd& full, std::size_t i) const {
    return weights_[markers_[i]] * seen_share(goal, full, markers_[i]);
  }

  template <class Point>
  [[nodiscard]] Vector3d mean(const GoalValues& goal, const Eigen::VectorXd& full, const Point& point) const {
    Vector3d sum = Vector3d::Zero();
    double weight = 0.0;
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      const double w = share(goal, full, i);
      if (!(w > 0.0)) continue;
      sum += w * point(i);
      weight += w;
    }
    return weight > 0.0 ? Vector3d(sum / weight) : sum;
  }

  [[nodiscard]] Laid lay(const GoalValues& goal, const Eigen::VectorXd& full) const {
    const Vector3d p = mean(goal, full, [this](std::size_t i) { return in_body_[i]; });
    const auto of = [&](const Eigen::Matrix3Xd& values) {
      return mean(goal, full, [&](std::size_t i) -> Vector3d { return values.col(markers_[i]); });
    };
    const Vector3d x = of(goal.x), v = of(goal.v), a = of(goal.a);
    Matrix3d product = Matrix3d::Zero();
    for (std::size_t i = 0; i < markers_.size(); ++i)
      if (const double w = share(goal, full, i); w > 0.0)
        product += w * (goal.x.col(markers_[i]) - x) * (in_body_[i] - p).transpose();
    Laid laid;
    laid.turn = math::fit_rotation(product).rotation;
    Matrix3d spread = Matrix3d::Zero();
    Vector3d turning = Vector3d::Zero();
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      const double w = share(goal, full, i);
      if (!(w > 0.0)) continue;
      const Vector3d r = laid.turn * (in_body_[i] - p);
      spread += w * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
      turning += w * r.cross(goal.v.col(markers_[i]) - v);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(spread);
    laid.axes = eigen.eigenvectors();
    laid.spread = eigen.eigenvalues();
    laid.fade = smooth_step(laid.spread[0] / kLine_m2 - 1.0);
    if (!(laid.fade > 0.0)) return laid;
    laid.spread_inverse = laid.axes * laid.spread.cwiseInverse().asDiagonal() * laid.axes.transpose();
    laid.velocity = laid.spread_inverse * turning;
    turning.setZero();
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      const double w = share(goal, full, i);
      if (!(w > 0.0)) continue;
      const Vector3d r = laid.turn * (in_body_[i] - p);
      turning += w * r.cross(goal.a.col(markers_[i]) - a - laid.velocity.cross(laid.velocity.cross(r)));
    }
    laid.acceleration = laid.spread_inverse * turning;
    return laid;
  }

  std::string body_;
  Eigen::VectorXd weights_;
  int idx_ = -1;
  std::vector<Vector3d> in_body_;
};

class DistanceOfMarkers : public GoalTask {
 public:
  DistanceOfMarkers(std::string a, std::string b) : names_{std::move(a), std::move(b)} {}

  [[nodiscard]] std::string name() const override {
    return fmt::format("distance of '{}' and '{}'", names_[0], names_[1]);
  }
  [[nodiscard]] int rows() const override { return 1; }
  [[nodiscard]] double points() const override { return 1.0; }

  [[nodiscard]] Status bind(const model::Model& model) override {
    markers_.clear();
    for (const auto& name : names_) {
      const int m = model.description().find_marker(name);
      if (m < 0)
        return fail(Code::bad_input,
                    fmt::format("marker '{}' is not in the recording, never seen, or weighs 0", name));
      markers_.push_back(m);
    }
    if (model.markers()[at(markers_[0])].body == model.markers()[at(markers_[1])].body)
      return fail(Code::bad_input, "both markers sit on one body; their distance cannot change");
    return {};
  }

  void follow(const model::Model& model, const model::Workspace& w, const GoalValues& goal,
              const Eigen::VectorXd& full, TaskRows& out, Eigen::MatrixXd* gains) const override {
    const int a = markers_[0], b = markers_[1];
    if (gains != nullptr) gains->setZero(1, 6);
    const double share = seen_share(goal, full, a) * seen_share(goal, full, b);
    const Vector3d wanted = goal.x.col(a) - goal.x.col(b);
    const double goal_m = wanted.norm();
    if (!(share > 0.0) || !(goal_m > 0.0)) {
      out.weight.setZero();
      return;
    }
    const double distance = distance_row(model, w, {model.markers()[at(a)].body, w.marker.col(a)},
                                         {model.markers()[at(b)].body, w.marker.col(b)}, out);
    const LengthRates rates(wanted, goal.v.col(a) - goal.v.col(b), goal.a.col(a) - goal.a.col(b));
    out.error[0] = goal_m - distance;
    out.goal_velocity[0] = rates.first;
    out.goal_acceleration[0] = rates.second;
    out.weight[0] = distance > 0.0 ? share : 0.0;
    if (gains != nullptr) *gains << (wanted / goal_m).transpose(), -(wanted / goal_m).transpose();
  }

 private:
  std::array<std::string, 2> names_;
};

}  // namespace

void GoalTask::evaluate(const model::Model& /*model*/, const model::Workspace& /*w*/, double /*time_s*/,
                        TaskRows& out) const {
  out.weight.setZero();
}

std::shared_ptr<GoalTask> orientation_of_markers(std::string body, Eigen::VectorXd weights) {
  return std::make_shared<OrientationOfMarkers>(std::move(body), std::move(weights));
}

std::shared_ptr<GoalTask> distance_of_markers(std::string a, std::string b) {
  return std::make_shared<DistanceOfMarkers>(std::move(a), std::move(b));
}

}  // namespace kinemark::motion::internal

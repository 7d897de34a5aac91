// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/tasks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/control/internal/goal_curve.h"
#include "kinemark/stages/motion/control/internal/two_points.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using internal::GoalCurve;

Status check_lever(double lever) {
  if (std::isfinite(lever) && lever > 0.0) return {};
  return fail(Code::usage, fmt::format("weight or lever is {}; it must be more than 0", lever));
}

class OrientationTask : public Task {
 public:
  OrientationTask(std::string body, std::vector<Eigen::Quaterniond> goals, const TimeBase& time,
                  double lever_m)
      : body_(std::move(body)), goals_(std::move(goals)), time_(time), lever_m_(lever_m) {}

  [[nodiscard]] std::string name() const override { return fmt::format("orientation of '{}'", body_); }
  [[nodiscard]] int rows() const override { return 3; }

  [[nodiscard]] Status bind(const model::Model& model) override {
    if (auto status = check_lever(lever_m_); !status) return status;
    const auto body = internal::body_by_name(model, body_);
    if (!body) return std::unexpected(body.error());
    if (internal::is_welded(model, *body))
      return fail(Code::bad_input, "the body is welded to the ground; it cannot be turned");
    idx_ = *body;
    Eigen::MatrixXd values(4, static_cast<Eigen::Index>(goals_.size()));
    Eigen::Vector4d before = Eigen::Vector4d::Zero();
    for (Eigen::Index i = 0; i < values.cols(); ++i) {
      const auto& goal = goals_[static_cast<std::size_t>(i)];
      if (!(goal.norm() > 0.5 && goal.norm() < 2.0))
        return fail(Code::bad_input, fmt::format("goal {} is no unit quaternion", i));
      Eigen::Vector4d value = goal.normalized().coeffs();
      if (value.dot(before) < 0.0) value = -value;  // both represent the same rotation: keep the sign
      values.col(i) = before = value;
    }
    auto curve = GoalCurve::through(values, time_);
    if (!curve) return std::unexpected(curve.error());
    curve_ = std::move(*curve);
    return {};
  }

  void evaluate(const model::Model& model, const model::Workspace& w, double time_s,
                TaskRows& out) const override {
    // The spline interpolates quaternions; its value is normalised to unit length, with the derivatives.
    std::array<double, 12> values{};
    curve_.at(time_s, values);
    const Eigen::Map<const Eigen::Vector4d> p(values.data()), dp(values.data() + 4), ddp(values.data() + 8);
    const double length = p.norm();
    const Eigen::Vector4d q = p / length;
    const double dlength = q.dot(dp);
    const Eigen::Vector4d dq = (dp - q * dlength) / length;
    const double ddlength = (dp.dot(dp) + p.dot(ddp) - dlength * dlength) / length;
    const Eigen::Vector4d ddq = (ddp - q * ddlength - 2.0 * dq * dlength) / length;
    const Eigen::Quaterniond goal(q), rate(dq), acceleration(ddq);
    out.goal_velocity = 2.0 * (rate * goal.conjugate()).vec();
    out.goal_acceleration = 2.0 * (acceleration * goal.conjugate()).vec();
    const Eigen::AngleAxisd miss(Eigen::Matrix3d(goal.toRotationMatrix() * w.rotation[at(idx_)].transpose()));
    out.error = miss.angle() * miss.axis();
    out.velocity = w.body_velocity[at(idx_)].w;
    out.bias = w.body_bias[at(idx_)].w;
    for (const int column : model.bodies()[at(idx_)].support)
      out.jacobian.col(model.columns()[at(column)].speed) += w.column[at(column)].w;
    out.weight.setConstant(lever_m_ * lever_m_);
  }

 private:
  std::string body_;
  std::vector<Eigen::Quaterniond> goals_;
  TimeBase time_;
  double lever_m_;
  int idx_ = -1;
  GoalCurve curve_;
};

class CoordinateGoal : public Task {
 public:
  CoordinateGoal(std::string coordinate, const std::vector<double>& values, const TimeBase& time,
                 double lever_m)
      : coordinate_(std::move(coordinate)),
        values_(
            Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Eigen::Index>(values.size()))),
        time_(time),
        lever_m_(lever_m) {}

  [[nodiscard]] std::string name() const override { return fmt::format("coordinate '{}'", coordinate_); }
  [[nodiscard]] int rows() const override { return 1; }

  [[nodiscard]] Status bind(const model::Model& model) override {
    if (auto status = check_lever(lever_m_); !status) return status;
    idx_ = model.description().find_coordinate(coordinate_);
    if (idx_ < 0) return fail(Code::bad_input, "the model does not have it");
    speed_ = model.coordinates()[at(idx_)].speed_idx;
    if (speed_ < 0)
      return fail(Code::not_supported,
                  "it belongs to a free root or follows another coordinate; use an "
                  "orientation, or the coordinate that it follows");
    auto curve = GoalCurve::through(values_, time_);
    if (!curve) return std::unexpected(curve.error());
    curve_ = std::move(*curve);
    return {};
  }

  void evaluate(const model::Model& /*model*/, const model::Workspace& w, double time_s,
                TaskRows& out) const override {
    std::array<double, 3> value{};
    curve_.at(time_s, value);
    out.error[0] = value[0] - w.q[idx_];
    out.goal_velocity[0] = value[1];
    out.goal_acceleration[0] = value[2];
    out.velocity[0] = w.v[speed_];
    out.jacobian(0, speed_) = 1.0;
    out.weight[0] = lever_m_ * lever_m_;
  }

 private:
  std::string coordinate_;
  Eigen::MatrixXd values_;
  TimeBase time_;
  double lever_m_;
  int idx_ = -1, speed_ = -1;
  GoalCurve curve_;
};

class DistanceTask : public Task {
 public:
  DistanceTask(BodyPoint a, BodyPoint b, const std::vector<double>& distances, const TimeBase& time,
               double weight)
      : a_(std::move(a)),
        b_(std::move(b)),
        values_(Eigen::Map<const Eigen::RowVectorXd>(distances.data(),
                                                     static_cast<Eigen::Index>(distances.size()))),
        time_(time),
        weight_(weight) {}

  [[nodiscard]] std::string name() const override {
    return fmt::format("distance between '{}' and '{}'", a_.body, b_.body);
  }
  [[nodiscard]] int rows() const override { return 1; }

  [[nodiscard]] Status bind(const model::Model& model) override {
    if (auto status = check_lever(weight_); !status) return status;
    for (const auto& [point, idx] : {std::pair{&a_, &idx_a_}, std::pair{&b_, &idx_b_}}) {
      const auto body = internal::body_by_name(model, point->body);
      if (!body) return std::unexpected(body.error());
      *idx = *body;
    }
    if (idx_a_ == idx_b_)
      return fail(Code::bad_input, "both points sit on one body; their distance cannot change");
    if (values_.size() > 0 && !(values_.minCoeff() > 0.0))
      return fail(Code::bad_input, "a distance is not more than 0 m");
    auto curve = GoalCurve::through(values_, time_);
    if (!curve) return std::unexpected(curve.error());
    curve_ = std::move(*curve);
    return {};
  }

  void evaluate(const model::Model& model, const model::Workspace& w, double time_s,
                TaskRows& out) const override {
    std::array<double, 3> value{};
    curve_.at(time_s, value);
    const Vector3d a = model::point_in_world(w, idx_a_, a_.x_in_body),
                   b = model::point_in_world(w, idx_b_, b_.x_in_body);
    const double distance = internal::distance_row(model, w, {idx_a_, a}, {idx_b_, b}, out);
    if (distance == 0.0) {
      out.weight[0] = 0.0;
      return;
    }
    out.error[0] = value[0] - distance;
    out.goal_velocity[0] = value[1];
    out.goal_acceleration[0] = value[2];
    out.weight[0] = weight_;
  }

 private:
  BodyPoint a_, b_;
  Eigen::MatrixXd values_;
  TimeBase time_;
  double weight_;
  int idx_a_ = data::kGround, idx_b_ = data::kGround;
  GoalCurve curve_;
};

}  // namespace

std::shared_ptr<Task> orientation_task(std::string body, std::vector<Eigen::Quaterniond> world_from_body,
                                       const TimeBase& time, double lever_m) {
  return std::make_shared<OrientationTask>(std::move(body), std::move(world_from_body), time, lever_m);
}

std::shared_ptr<Task> coordinate_task(std::string coordinate, const std::vector<double>& values,
                                      const TimeBase& time, double lever_m) {
  return std::make_shared<CoordinateGoal>(std::move(coordinate), values, time, lever_m);
}

std::shared_ptr<Task> distance_task(BodyPoint a, BodyPoint b, const std::vector<double>& distances_m,
                                    const TimeBase& time, double weight) {
  return std::make_shared<DistanceTask>(std::move(a), std::move(b), distances_m, time, weight);
}

}  // namespace kinemark::motion

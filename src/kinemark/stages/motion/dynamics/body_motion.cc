// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/body_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/math/euler.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kProbe = 1e-4;     // rad or m: step of the derivatives by q
constexpr double kNothing = 1e-12;  // of a number: what rounding moves it by

/// Coordinates and their rates in one frame.
struct FrameState {
  VectorXd q, qd, qdd;
};

/// Position, velocity and acceleration of one point.
struct PointState {
  Vector3d x, v, a;
};

/// Everything one thread needs to follow a frame.
class Follower {
 public:
  Follower(const model::Model& model, const BodyMotionOptions& options)
      : model_(model), options_(options), w_(model), acceleration_(model.bodies().size()) {}

  /// Fill y with the numbers of a frame, in the order of BodyMotion.
  void follow(const FrameState& at_frame, VectorXd& y) {
    model::kinematics(model_, w_, model::state_from_coordinates(model_, at_frame.q));
    model::speeds_from_rates(model_, at_frame.q, at_frame.qd, at_frame.qdd, v_, vdot_);
    model::velocities(model_, w_, v_);
    accelerate();
    const auto columns = y.size() / 3;
    Eigen::Index k = 0;
    for (const int body_idx : options_.body_idx) put_body(model_.body_of(body_idx), y, columns, k);
    put(mass_centre(), Matrix3d::Identity(), y, columns, k);
    for (const auto& point : options_.points) put_point(point, y, columns, k);
  }

 private:
  /// Acceleration fields of all bodies.
  void accelerate() {
    for (std::size_t b = 0; b < acceleration_.size(); ++b) {
      auto a = w_.body_bias[b];
      for (const int c : model_.bodies()[b].support) {
        const double rate = vdot_[model_.columns()[at(c)].speed];
        a.w += rate * w_.column[at(c)].w;
        a.v += rate * w_.column[at(c)].v;
      }
      acceleration_[b] = a;
    }
  }

  [[nodiscard]] PointState point(int body, const Vector3d& x_in_body) const {
    const Vector3d x = model::point_in_world(w_, body, x_in_body);
    if (body < 0) return {x, Vector3d::Zero(), Vector3d::Zero()};
    const auto& u = w_.body_velocity[at(body)];
    const auto& a = acceleration_[at(body)];
    const Vector3d v = u.v + u.w.cross(x);
    return {x, v, a.v + a.w.cross(x) + u.w.cross(v)};
  }

  [[nodiscard]] PointState mass_centre() const {
    PointState sum{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    double mass = 0.0;
    for (int b = 0; b < static_cast<int>(acceleration_.size()); ++b) {
      const auto& body = model_.bodies()[at(b)];
      const auto own = point(b, body.com_in_body);
      mass += body.mass;
      sum.x += body.mass * own.x;
      sum.v += body.mass * own.v;
      sum.a += body.mass * own.a;
    }
    return {sum.x / mass, sum.v / mass, sum.a / mass};
  }

  /// @param turned  axes of the answer from the world's, for its rates
  static void put(const PointState& own, const Matrix3d& turned, VectorXd& y, Eigen::Index columns,
                  Eigen::Index& k) {
    y.segment<3>(k) = own.x;
    y.segment<3>(columns + k) = turned * own.v;
    y.segment<3>(2 * columns + k) = turned * own.a;
    k += 3;
  }

  void put_body(int body, VectorXd& y, Eigen::Index columns, Eigen::Index& k) const {
    const Matrix3d& rotation = w_.rotation[at(body)];
    const Matrix3d turned = options_.rates_in_body ? Matrix3d(rotation.transpose()) : Matrix3d::Identity();
    put(point(body, model_.bodies()[at(body)].com_in_body), turned, y, columns, k);
    put({math::to_body_xyz(rotation), w_.body_velocity[at(body)].w, acceleration_[at(body)].w}, turned, y,
        columns, k);
  }

  void put_point(const FollowedPoint& followed, VectorXd& y, Eigen::Index columns, Eigen::Index& k) const {
    const int body = followed.body_idx < 0 ? data::kGround : model_.body_of(followed.body_idx);
    PointState own = point(body, followed.x_in_body);
    Matrix3d turned = Matrix3d::Identity();
    if (followed.relative_to_idx >= 0) {
      const auto to = at(model_.body_of(followed.relative_to_idx));
      turned = w_.rotation[to].transpose();
      own.x = turned * (own.x - w_.position[to]);
    }
    put(own, turned, y, columns, k);
  }

  const model::Model& model_;
  const BodyMotionOptions& options_;
  model::Workspace w_;
  std::vector<model::Spatial> acceleration_;
  VectorXd v_, vdot_;
};

/// Lower triangular factor of a covariance of q, qd, qdd, given as its upper triangle by rows.
Matrix3d factor(const std::array<double, 6>& upper) {
  Matrix3d p;
  p << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  // A Cholesky factor column by column, with what rounding makes negative taken as 0.
  Matrix3d l = Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double d = p(j, j) - l.row(j).head(j).squaredNorm();
    if (d <= 0.0) continue;
    l(j, j) = std::sqrt(d);
    for (int i = j + 1; i < 3; ++i) l(i, j) = (p(i, j) - l.row(i).head(j).dot(l.row(j).head(j))) / l(j, j);
  }
  return l;
}

/// One frame after the other, with the deviations of what is followed.
class FrameFollower {
 public:
  FrameFollower(const model::Model& model, const data::JointMotion& motion, const BodyMotionOptions& options,
                const RateErrors& errors, const Array<std::uint8_t>& is_filled, BodyMotion& out)
      : model_(model),
        motion_(motion),
        errors_(errors),
        is_filled_(is_filled),
        bars_(options.error_bars),
        out_(out),
        follower_(model, options) {
    for (auto* x : {&y_, &high_, &low_}) x->setZero(3 * out.columns());
    for (auto* x : {&state_.q, &state_.qd, &state_.qdd}) x->setZero(model.coordinate_count());
  }

  void visit(std::int64_t f) {
    for (int c = 0; c < model_.coordinate_count(); ++c) {
      const auto i = motion_.index(f, c);
      state_.q[c] = motion_.q[i];
      state_.qd[c] = motion_.qd[i];
      state_.qdd[c] = motion_.qdd[i];
    }
    follower_.follow(state_, y_);
    double* value = out_.value.data() + out_.index(f, 0, 0);
    std::copy(y_.data(), y_.data() + y_.size(), value);
    variance_.setZero(y_.size());
    for (int c = 0; c < model_.coordinate_count(); ++c) {
      if (model_.coordinates()[at(c)].source >= 0) continue;
      const auto i = motion_.index(f, c);
      const bool filled = !is_filled_.empty() && is_filled_[i] != 0;
      if (filled || (bars_ && !motion_.determined.empty() && motion_.determined[i] == 0))
        withdraw(c, filled ? value : nullptr);
      else if (bars_)
        spread(c, covariance_as_held(motion_, errors_, f, c));
    }
    if (!bars_) return;
    double* sd = out_.sd.data() + out_.index(f, 0, 0);
    for (Eigen::Index k = 0; k < y_.size(); ++k)
      sd[k] = std::isnan(value[k]) ? kNaN : std::sqrt(variance_[k]);
  }

 private:
  /// Half the difference of the frame moved by +step and -step of one coordinate and its rates.
  const VectorXd& derivative(int c, const Vector3d& step) {
    const Vector3d middle(state_.q[c], state_.qd[c], state_.qdd[c]);
    const auto go = [&](const Vector3d& z, VectorXd& y) {
      state_.q[c] = z[0];
      state_.qd[c] = z[1];
      state_.qdd[c] = z[2];
      follower_.follow(state_, y);
    };
    go(middle + step, high_);
    go(middle - step, low_);
    state_.q[c] = middle[0];
    state_.qd[c] = middle[1];
    state_.qdd[c] = middle[2];
    // Angles that jump by a turn between the two have moved by the rest.
    high_ = 0.5 * (high_ - low_);
    for (std::int64_t b = 0; b < out_.bodies; ++b)
      for (Eigen::Index k = 6 * b + 3; k < 6 * b + 6; ++k)
        high_[k] = 0.5 * std::remainder(2.0 * high_[k], 2.0 * M_PI);
    return high_;
  }

  void spread(int c, const std::array<double, 6>& covariance) {
    if (std::isnan(covariance[0])) return withdraw(c, nullptr);
    const Matrix3d l = factor(covariance);
    for (int k = 0; k < 3; ++k) {
      const Vector3d column = l.col(k);
      if (column.isZero(0.0)) continue;
      const double shrink = std::abs(column[0]) > kProbe ? kProbe / std::abs(column[0]) : 1.0;
      variance_.array() += derivative(c, shrink * column).array().square() / (shrink * shrink);
    }
  }

  /// What a coordinate moves has no deviation, and no value where the coordinate has none.
  void withdraw(int c, double* value) {
    const auto& moved = derivative(c, {kProbe, kProbe, kProbe});
    for (Eigen::Index k = 0; k < moved.size(); ++k) {
      if (std::abs(moved[k]) <= kNothing * (1.0 + std::abs(y_[k]))) continue;
      variance_[k] = kNaN;
      if (value) value[k] = kNaN;
    }
  }

  const model::Model& model_;
  const data::JointMotion& motion_;
  const RateErrors& errors_;
  const Array<std::uint8_t>& is_filled_;
  bool bars_;
  BodyMotion& out_;
  Follower follower_;
  FrameState state_;
  VectorXd y_, high_, low_, variance_;
};

Status check_followed(const model::Model& model, const data::JointMotion& motion,
                      const BodyMotionOptions& options, const RateErrors& errors,
                      const Array<std::uint8_t>& is_filled) {
  if (auto status = motion.validate(); !status) return status;
  if (motion.size() != model.coordinate_count())
    return fail(Code::bad_input, fmt::format("the motion has {} coordinates, the model {}", motion.size(),
                                             model.coordinate_count()));
  if (motion.qd.size() != motion.q.size() || motion.qdd.size() != motion.q.size())
    return fail(Code::bad_input, "the motion has no speeds and accelerations; estimate_rates() finds them");
  if (options.error_bars && errors.covariance.size() != 6 * motion.q.size())
    return fail(Code::bad_input, "errors of rates are needed for error bars, 6 a coordinate and frame");
  if (!is_filled.empty() && is_filled.size() != motion.q.size())
    return fail(Code::bad_input, "what is filled is needed for all coordinates and frames, or for none");
  const auto known = [&](int idx) { return idx < std::ssize(model.description().bodies); };
  for (const int idx : options.body_idx)
    if (idx < 0 || !known(idx)) return fail(Code::bad_input, "a body to follow is not of the model");
  for (const auto& point : options.points)
    if (!known(point.body_idx) || !known(point.relative_to_idx))
      return fail(Code::bad_input, fmt::format("point '{}' is in no body of the model", point.name));
  return {};
}

}  // namespace

Result<BodyMotion> body_motion(const model::Model& model, const data::JointMotion& motion,
                               const BodyMotionOptions& options, const RateErrors& errors,
                               const Array<std::uint8_t>& is_filled) {
  if (auto s = check_followed(model, motion, options, errors, is_filled); !s)
    return std::unexpected(s.error());
  BodyMotion out{
      .time = motion.time, .bodies = std::ssize(options.body_idx), .points = std::ssize(options.points)};
  const auto size = at(3 * motion.frames() * out.columns());
  out.value.assign(size, kNaN);
  if (options.error_bars) out.sd.assign(size, kNaN);
  parallel_for(motion.frames(), 16, options.threads, [&](std::int64_t begin, std::int64_t end) {
    FrameFollower worker(model, motion, options, errors, is_filled, out);
    for (std::int64_t f = begin; f < end; ++f) worker.visit(f);
  });
  return out;
}

}  // namespace kinemark::motion

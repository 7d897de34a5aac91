// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/control/internal/goal_curve.h"
#include "kinemark/stages/motion/control/internal/two_points.h"
#include "kinemark/stages/motion/control/tasks.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

class MassCentreTask : public Task {
 public:
  MassCentreTask(int axis, const std::vector<double>& values, const TimeBase& time, double weight)
      : axis_(axis),
        values_(
            Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Eigen::Index>(values.size()))),
        time_(time),
        weight_(weight) {}

  [[nodiscard]] std::string name() const override { return "centre of mass"; }
  [[nodiscard]] int rows() const override { return 1; }

  [[nodiscard]] Status bind(const model::Model& model) override {
    if (axis_ < 0 || axis_ > 2)
      return fail(Code::usage, fmt::format("axis {} is none; 0 to 2 are x, y, z", axis_));
    if (!(std::isfinite(weight_) && weight_ > 0.0))
      return fail(Code::usage, fmt::format("weight is {}; it must be more than 0", weight_));
    double mass = 0.0;
    share_.assign(model.bodies().size(), 0.0);
    for (std::size_t b = 0; b < share_.size(); ++b)
      if (!internal::is_welded(model, static_cast<int>(b))) mass += share_[b] = model.bodies()[b].mass;
    if (!(mass > 0.0)) return fail(Code::bad_input, "no body that can move has a mass");
    for (auto& share : share_) share /= mass;
    auto curve = internal::GoalCurve::through(values_, time_);
    if (!curve) return std::unexpected(curve.error());
    curve_ = std::move(*curve);
    return {};
  }

  void evaluate(const model::Model& model, const model::Workspace& w, double time_s,
                TaskRows& out) const override {
    std::array<double, 3> value{};
    curve_.at(time_s, value);
    double place = 0.0;
    for (int b = 0; b < static_cast<int>(share_.size()); ++b) {
      const double share = share_[at(b)];
      if (!(share > 0.0)) continue;
      const Vector3d centre = model::point_in_world(w, b, model.bodies()[at(b)].com_in_body);
      place += share * centre[axis_];
      out.velocity[0] += share * model::point_velocity(w, b, centre)[axis_];
      out.bias[0] += share * model::point_bias_acceleration(w, b, centre)[axis_];
      internal::add_point(model, w, {b, centre}, share * Vector3d::Unit(axis_), out.jacobian);
    }
    out.error[0] = value[0] - place;
    out.goal_velocity[0] = value[1];
    out.goal_acceleration[0] = value[2];
    out.weight[0] = weight_;
  }

 private:
  int axis_;
  Eigen::MatrixXd values_;
  TimeBase time_;
  double weight_;
  std::vector<double> share_;  // of each body in the mass of all that can move
  internal::GoalCurve curve_;
};

}  // namespace

std::shared_ptr<Task> mass_centre_task(int axis, const std::vector<double>& values_m, const TimeBase& time,
                                       double weight) {
  return std::make_shared<MassCentreTask>(axis, values_m, time, weight);
}

}  // namespace kinemark::motion

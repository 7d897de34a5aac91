// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/camera_task.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/camera/projection.h"
#include "kinemark/core/index.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/control/internal/goal_curve.h"
#include "kinemark/stages/motion/control/internal/goals.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using internal::GoalCurve;
using internal::smooth_step;

constexpr double kNoLowpass = 0.45;           // of the rate, as for markers
constexpr double kLowest = 1e-3;              // of the rate: its kernel has some thousand frames
constexpr double kMirrored = 1.2;             // periods of the cut-off, as for markers
constexpr double kUnseen = 0.1;               // cosine of the angle off the axis: 84 degrees
constexpr double kPlain = 0.25;               // 76 degrees
constexpr double kDifference = 1e-5;          // of the depth: rounding and truncation are both below 1e-9
constexpr double kStandstill_m_per_s = 1e-9;  // slower, the curvature is negligible

/// Weight of a view at this angle, 0 to 1: it vanishes where the point nears the plane of the lens.
double facing(const Vector3d& x_in_cam) {
  return smooth_step((x_in_cam.z() / x_in_cam.norm() - kUnseen) / (kPlain - kUnseen));
}

/// Frames in which a camera sees the point without a break.
struct Run {
  std::int64_t first = 0, last = 0;
  GoalCurve curve;
};

struct View {
  data::Camera camera;
  double sd = 0.0;  // of a goal, image units
  std::vector<Run> runs;
};

class CameraTask : public Task {
 public:
  CameraTask(BodyPoint point, const data::ImageTracks& tracks, std::string name,
             const CameraTaskOptions& options)
      : point_(std::move(point)), name_(std::move(name)), options_(options), time_(tracks.time) {
    status_ = build(tracks);
  }

  [[nodiscard]] std::string name() const override { return fmt::format("images of '{}'", name_); }
  [[nodiscard]] int rows() const override { return 2 * static_cast<int>(views_.size()); }
  [[nodiscard]] bool seen() const {
    return std::ranges::any_of(views_, [](const View& view) { return !view.runs.empty(); });
  }
  [[nodiscard]] const Status& status() const { return status_; }

  [[nodiscard]] Status bind(const model::Model& model) override {
    if (!status_) return status_;
    if (!seen()) return fail(Code::bad_input, "no camera sees it in two frames in a row");
    if (!point_.x_in_body.allFinite())
      return fail(Code::bad_input, "its position in the body is not a number");
    const auto body = internal::body_by_name(model, point_.body);
    if (!body) return std::unexpected(body.error());
    body_ = *body;
    if (internal::is_welded(model, body_))
      return fail(Code::bad_input, "its body is welded to the ground; no image can move it");
    return {};
  }

  void evaluate(const model::Model& model, const model::Workspace& w, double time_s,
                TaskRows& out) const override {
    const Vector3d position = model::point_in_world(w, body_, point_.x_in_body);
    const Vector3d velocity = model::point_velocity(w, body_, position);
    const Vector3d bias = model::point_bias_acceleration(w, body_, position);
    for (std::size_t c = 0; c < views_.size(); ++c) {
      const View& view = views_[c];
      const auto row = static_cast<Eigen::Index>(2 * c);
      out.sd.segment<2>(row).setConstant(view.sd);
      std::array<double, 6> goal{};
      const auto there = camera::project(view.camera, position);
      const double share = facing(there.x_in_cam) * goal_at(view, time_s, goal);
      if (!(share > 0.0) || !there.image.allFinite() || !there.d_point.allFinite()) {
        out.weight.segment<2>(row).setZero();
        continue;
      }
      const double depth = there.x_in_cam.z();
      out.error.segment<2>(row) = Vector2d(goal[0], goal[1]) - there.image;
      out.goal_velocity.segment<2>(row) = Vector2d(goal[2], goal[3]);
      out.goal_acceleration.segment<2>(row) = Vector2d(goal[4], goal[5]);
      out.velocity.segment<2>(row) = there.d_point * velocity;
      out.bias.segment<2>(row) =
          there.d_point * bias + curvature_term(view.camera, position, velocity, depth);
      for (const int column : model.bodies()[at(body_)].support) {
        const auto& s = w.column[at(column)];
        out.jacobian.block<2, 1>(row, model.columns()[at(column)].speed) +=
            there.d_point * (s.v + s.w.cross(position));
      }
      const Vector2d metres_per_unit(depth / view.camera.focal,
                                     depth / (view.camera.focal * view.camera.aspect));
      out.weight.segment<2>(row) = options_.weight * share * metres_per_unit.cwiseAbs2();
    }
  }

 private:
  /// Part of the image acceleration due to the curvature of the projection: (change of d_point along the
  /// velocity) velocity, by central differences.
  static Vector2d curvature_term(const data::Camera& camera, const Vector3d& position,
                                 const Vector3d& velocity, double depth) {
    const double speed = velocity.norm(), reach = kDifference * depth;
    if (!(speed > kStandstill_m_per_s)) return Vector2d::Zero();
    const Vector3d way = (reach / speed) * velocity;
    return speed / (2.0 * reach) *
           ((camera::project(camera, position + way).d_point -
             camera::project(camera, position - way).d_point) *
            velocity);
  }

  /// Goal and its two derivatives at a time; returns its weight, 0 to 1.
  [[nodiscard]] double goal_at(const View& view, double time_s, std::array<double, 6>& goal) const {
    if (view.runs.empty()) return 0.0;
    const double frame = (time_s - time_.t0_s) * time_.rate_hz;
    auto run = std::ranges::upper_bound(view.runs, frame, {},
                                        [](const Run& r) { return static_cast<double>(r.first); });
    if (run != view.runs.begin()) --run;
    run->curve.at(time_s, goal);
    if (time_.frames == 1) return 1.0;
    const double fade = std::max(1.0, options_.fade_s * time_.rate_hz);
    const double since = frame - static_cast<double>(run->first),
                 until = static_cast<double>(run->last) - frame;
    return smooth_step(since / fade + (run->first == 0 ? 1.0 : 0.0)) *
           smooth_step(until / fade + (run->last == time_.frames - 1 ? 1.0 : 0.0));
  }

  Status build(const data::ImageTracks& tracks) {
    const auto& o = options_;
    if (!(o.weight > 0.0 && std::isfinite(o.weight)))
      return fail(Code::usage, fmt::format("its weight is {}; it must be more than 0", o.weight));
    if (!(o.fade_s > 0.0 && std::isfinite(o.fade_s)))
      return fail(Code::usage, fmt::format("it fades within {} s; that must be more than 0", o.fade_s));
    if (auto status = tracks.validate(); !status) return status;
    if (tracks.frames() < 1 || !std::isfinite(time_.t0_s) || tracks.cameras.empty())
      return fail(Code::bad_input,
                  fmt::format("image tracks have {} frames from {} s of {} cameras; need one at least",
                              tracks.frames(), time_.t0_s, tracks.cameras.size()));
    if (!std::isfinite(o.cutoff_hz) || (o.cutoff_hz != 0.0 && !(o.cutoff_hz >= kLowest * time_.rate_hz)))
      return fail(
          Code::usage,
          fmt::format("its cut-off is {} Hz; it must be 0, or at least a thousandth of the rate of {} Hz",
                      o.cutoff_hz, time_.rate_hz));
    for (const auto& camera : tracks.cameras)
      if (!(camera.focal > 0.0 && camera.aspect > 0.0 && std::isfinite(camera.focal * camera.aspect)))
        return fail(Code::bad_input,
                    fmt::format("camera '{}' has focal length {} and aspect {}; both must be more than 0",
                                camera.name, camera.focal, camera.aspect));
    const auto it = std::ranges::find(tracks.names, name_);
    if (it == tracks.names.end()) return fail(Code::bad_input, "the image tracks do not have it");
    const auto marker = static_cast<std::size_t>(it - tracks.names.begin());
    const double left =
        lowpass() ? internal::GoalFilter(time_.rate_hz, o.cutoff_hz, 0.0, o.fade_s).noise_in_goal() : 1.0;
    for (std::size_t c = 0; c < tracks.cameras.size(); ++c) {
      View view{.camera = tracks.cameras[c], .sd = std::sqrt(left) * tracks.noise_sd[c], .runs = {}};
      view.camera.table = {};  // not needed here, and large
      if (auto status = find_runs(tracks, c, marker, view.runs); !status) return status;
      views_.push_back(std::move(view));
    }
    return {};
  }

  Status find_runs(const data::ImageTracks& tracks, std::size_t c, std::size_t marker,
                   std::vector<Run>& runs) const {
    const std::int64_t frames = tracks.frames();
    for (std::int64_t first = 0; first < frames; ++first) {
      std::int64_t end = first;
      while (end < frames && tracks.at(end, c, marker).allFinite()) ++end;
      // Goals need both ends of an interval, except for a constant goal.
      if (end - first >= std::min<std::int64_t>(2, frames)) {
        Eigen::MatrixXd values(2, end - first);
        for (std::int64_t f = first; f < end; ++f) values.col(f - first) = tracks.at(f, c, marker);
        smooth(values);
        auto curve = GoalCurve::through(
            values, {.rate_hz = time_.rate_hz, .t0_s = time_.time_s(first), .frames = end - first});
        if (!curve) return std::unexpected(curve.error());
        runs.push_back({.first = first, .last = end - 1, .curve = std::move(*curve)});
      }
      first = end;
    }
    return {};
  }

  [[nodiscard]] bool lowpass() const {
    return options_.cutoff_hz > 0.0 && options_.cutoff_hz < kNoLowpass * time_.rate_hz && time_.frames > 1;
  }

  void smooth(Eigen::MatrixXd& values) const {
    if (!lowpass()) return;
    const auto sections =
        math::butterworth_lowpass(2, math::two_pass_cutoff(2, options_.cutoff_hz / time_.rate_hz));
    const double mirrored = std::ceil(kMirrored * time_.rate_hz / options_.cutoff_hz);
    const int padding = static_cast<int>(std::min(mirrored, static_cast<double>(values.cols())));
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      std::vector<double> x(at(values.cols()));
      for (Eigen::Index i = 0; i < values.cols(); ++i) x[at(i)] = values(axis, i);
      math::filter_both_ways(sections, padding, x);
      for (Eigen::Index i = 0; i < values.cols(); ++i) values(axis, i) = x[at(i)];
    }
  }

  BodyPoint point_;
  std::string name_;
  CameraTaskOptions options_;
  TimeBase time_;
  std::vector<View> views_;
  Status status_;
  int body_ = data::kGround;
};

}  // namespace

std::shared_ptr<Task> camera_task(BodyPoint point, const data::ImageTracks& tracks, std::string name,
                                  const CameraTaskOptions& options) {
  return std::make_shared<CameraTask>(std::move(point), tracks, std::move(name), options);
}

Result<std::vector<std::shared_ptr<Task>>> camera_tasks(const model::Model& model,
                                                        const data::ImageTracks& tracks,
                                                        const CameraTaskOptions& options) {
  if (auto status = tracks.validate(); !status) return std::unexpected(status.error());
  std::vector<std::shared_ptr<Task>> tasks;
  const auto& described = model.description();
  for (std::size_t m = 0; m < described.markers.size(); ++m) {
    const auto& marker = model.markers()[m];
    const auto& name = described.markers[m].name;
    if (internal::is_welded(model, marker.body)) continue;
    if (std::ranges::find(tracks.names, name) == tracks.names.end()) continue;
    const auto& body = described.bodies[at(model.bodies()[at(marker.body)].description_idx)];
    auto task = std::make_shared<CameraTask>(BodyPoint{.body = body.name, .x_in_body = marker.x_in_body},
                                             tracks, name, options);
    if (!task->status()) return std::unexpected(task->status().error());
    if (task->seen()) tasks.push_back(std::move(task));
  }
  if (tasks.empty())
    return fail(
        Code::bad_input,
        "the image tracks name no marker of the model that moves and that a camera sees in two frames "
        "in a row");
  return tasks;
}

}  // namespace kinemark::motion

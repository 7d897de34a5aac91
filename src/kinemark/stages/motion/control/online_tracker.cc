// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/online_tracker.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/name_index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/control/internal/bounds.h"
#include "kinemark/stages/motion/control/internal/first_pose.h"
#include "kinemark/stages/motion/control/internal/recorder.h"
#include "kinemark/stages/motion/control/internal/track_bars.h"
#include "kinemark/stages/motion/control/internal/walker.h"
#include "kinemark/stages/motion/internal/stream_judge.h"

namespace kinemark::motion {
namespace {

using data::FrameStatus;

constexpr double kFastest_hz = 10000.0;
constexpr double kLongestGap_s = 2.0;
constexpr double kMostAhead_s = 0.5;  // of the stamps, by frames that come faster than the rate
constexpr double kPatience_s = 1.0;   // after which a start with fewer markers is accepted
constexpr double kEnough = 0.95;      // of the markers
constexpr std::int64_t kFewest = 3;
constexpr double kResiduals_s = 0.2;  // between frames whose residuals are looked at: slides take longer

/// A recording of two frames with all markers in the model's default pose, from which make_plan() matches the
/// names.
data::Trajectories pretend(const model::Model& model, const std::vector<std::string>& names, double rate_hz) {
  auto markers = data::Trajectories::all_missing(names, {.rate_hz = rate_hz, .t0_s = 0.0, .frames = 2});
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  for (std::int64_t f = 0; f < 2; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      markers.x(f, m).setZero();
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const data::NameIndex index(names);
  for (Eigen::Index i = 0; i < w.marker.cols(); ++i)
    if (const auto m = index.find(model.description().markers[at(i)].name); m >= 0)
      for (std::int64_t f = 0; f < 2; ++f) markers.x(f, m) = w.marker.col(i);
  return markers;
}

}  // namespace

struct OnlineTracker::Impl {
  Impl(internal::Plan given, const TrackOptions& opts, std::int64_t names)
      : plan(std::move(given)),
        options(opts),
        filter(internal::make_filter(plan.rate_hz, opts)),
        // Largest number of frames: the window, poses not fetched yet, and skipped frames.
        capacity(2 * filter.window_frames() + static_cast<std::int64_t>(kLongestGap_s * plan.rate_hz) + 4),
        samples(plan.problem.model.marker_count(), capacity),
        readout(plan.problem.model),
        pushed_readout(plan.problem.model),
        out(Eigen::MatrixX<std::uint8_t>::Zero(plan.problem.model.marker_count(), capacity)),
        known_goal(plan.problem.model.marker_count()),
        y(3, plan.problem.model.marker_count()),
        weight(plan.problem.model.marker_count()),
        rest_squares(Eigen::VectorXd::Zero(weight.size())),
        rest_count(rest_squares),
        residuals(plan.problem),
        columns(names) {
    y.setZero();
  }

  /// A frame in the order of the model's markers.
  void take(const Eigen::Matrix3Xd* x) {
    for (Eigen::Index m = 0; m < weight.size(); ++m) {
      const int column = plan.problem.data_marker[at(m)];
      const bool seen = x != nullptr && x->col(column).allFinite();
      weight[m] = seen ? plan.problem.weight[m] : 0.0;
      y.col(m) = seen ? Eigen::Vector3d(x->col(column)) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    }
    if (options.judge_samples) {
      if (!judge) judge.emplace(plan.problem, plan.start_options, plan.rate_hz);
      judge->judge(y, weight);
      const auto column = window().frames() % out.cols();
      for (Eigen::Index m = 0; m < weight.size(); ++m) out(m, column) = judge->out()[at(m)];
    }
    (walker ? walker->samples() : samples).push(y, weight);
  }

  [[nodiscard]] const internal::SampleWindow& window() const {
    return walker ? std::as_const(*walker).samples() : samples;
  }

  /// Whether the cell from frame `first` on can be built.
  [[nodiscard]] bool ready(std::int64_t first) const {
    const auto& w = window();
    return w.ended() ? first + 1 < w.frames() : first + 1 + filter.delay_frames() < w.frames();
  }

  /// Try to start at frame `f`; false: too few markers yet.
  Result<bool> try_start(std::int64_t f) {
    internal::GoalCell cell(static_cast<int>(weight.size()));
    internal::GoalValues goal(static_cast<int>(weight.size()));
    filter.build(samples, f, cell);
    cell.at(0.0, goal);
    const auto seen = (goal.weight.array() > 0.0).count();
    const bool patient = static_cast<double>(f) < kPatience_s * plan.rate_hz;
    if (static_cast<double>(seen) < kEnough * static_cast<double>(weight.size()) &&
        (patient || seen < kFewest))
      return false;
    const Eigen::VectorXd x = internal::find_first_pose(plan, goal.x, goal.weight, options.lock);
    if (auto status = internal::check_mass(plan, x); !status) return std::unexpected(status.error());
    walker.emplace(plan, filter, capacity, t0_s);
    walker->samples() = samples;
    if (options.error_bars) bounds.emplace(plan);
    walker->begin(x, f);
    return true;
  }

  void read(const Eigen::VectorXd& x, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
    readout.find(x, v, a);
    pose.q = readout.q();
    pose.qd = readout.rate();
    pose.qdd = readout.acceleration();
    pose.tau = readout.tau();
  }

  /// Goals, and the body that is pushed.
  void describe_push() {
    const auto& goal = walker->goal();
    pose.goal.setConstant(3, columns, kNaN);
    for (Eigen::Index m = 0; m < goal.weight.size(); ++m)
      if (goal.weight[m] > 0.0) pose.goal.col(plan.problem.data_marker[at(m)]) = goal.x.col(m);
    pose.pushed_q.resize(0);
    pose.pushed_m = walker->pushed_m();
    auto* body = walker->pushed();
    if (body == nullptr) return;
    pushed_readout.find(body->x(), body->v(), body->a());
    pose.pushed_q = pushed_readout.q();
  }

  void describe() {
    describe_push();
    auto& body = walker->controller();
    read(body.x(), body.v(), body.a());
    pose.rank = body.rank();
    pose.smallest_singular = body.smallest_singular();
    const auto held = std::count(plan.problem.fixed_speed.begin(), plan.problem.fixed_speed.end(), 1);
    bool fixed = pose.rank == plan.problem.model.speed_count() - held;
    known_goal = walker->goal();
    pose.left_out.clear();
    for (Eigen::Index m = 0; m < known_goal.weight.size(); ++m) {
      if (out(m, walker->frame() % out.cols()) == 0) continue;
      known_goal.weight[m] = 0.0;
      pose.left_out.push_back(plan.problem.data_marker[at(m)]);
    }
    if (bounds) {
      bounds->find(body.x(), pose.q, known_goal, walker->time_s(), noise());
      pose.q_sd = bounds->sd();
      pose.q_bound = bounds->bound().array() + (plan.settle ? internal::kSettled : 0.0);
      pose.determined = bounds->determined();
      pose.rank = bounds->rank();
      pose.smallest_singular = bounds->smallest_singular();
      fixed = std::all_of(pose.determined.begin(), pose.determined.end(), [](auto d) { return d != 0; });
    }
    if (walker->flagged() || walker->beyond())
      pose.status = FrameStatus::not_converged;
    else if (!walker->any_goal())
      pose.status = FrameStatus::no_markers;
    else
      pose.status = fixed ? FrameStatus::converged : FrameStatus::underdetermined;
  }

  /// Noise of the goals: as given, or what the residuals of the body and the part removed by the filter show
  /// so far, as goal_noise() does for a recording.
  const MarkerVariances& noise() {
    const double gain = filter.noise_in_goal();
    if (options.marker_noise_sd_m > 0.0) {
      variances.common.setZero(static_cast<Eigen::Index>(plan.problem.model.bodies().size()));
      variances.own.setConstant(weight.size(), gain * options.marker_noise_sd_m * options.marker_noise_sd_m);
      return variances;
    }
    const auto f = walker->frame();
    const auto& goal = known_goal;
    if (next_residuals <= f) {
      Eigen::VectorXd full = plan.problem.weight;
      for (Eigen::Index m = 0; m < full.size(); ++m)
        if (goal.weight[m] < full[m]) full[m] = 0.0;
      residuals.add(goal.x, full, walker->controller().x());
      of_residuals = residuals.variances();
      next_residuals = f + std::max<std::int64_t>(1, std::llround(kResiduals_s * plan.rate_hz));
    }
    variances = of_residuals;
    for (int m = 0; m < static_cast<int>(weight.size()); ++m) {
      if (window().present(f, m) && goal.weight[m] >= plan.problem.weight[m]) {
        rest_squares[m] += (window().x(f, m) - goal.x.col(m)).squaredNorm();
        rest_count[m] += 3.0;
      }
      if (rest_count[m] > 0.0 && filter.noise_in_rest() > 1e-3)
        variances.own[m] =
            std::max(variances.own[m], gain * rest_squares[m] / (rest_count[m] * filter.noise_in_rest()));
    }
    return variances;
  }

  internal::Plan plan;
  TrackOptions options;
  internal::GoalFilter filter;
  std::int64_t capacity;
  internal::SampleWindow samples;  // until the walker has its own
  std::optional<internal::Walker> walker;
  internal::Readout readout, pushed_readout;
  std::optional<internal::Bounds> bounds;
  std::optional<internal::StreamJudge> judge;
  Eigen::MatrixX<std::uint8_t> out;  // M x capacity; 1: the sample was not believed
  internal::GoalValues known_goal;   // without what was not believed
  Eigen::Matrix3Xd y;
  Eigen::VectorXd weight, rest_squares, rest_count;
  VarianceSums residuals;
  MarkerVariances of_residuals, variances;
  std::int64_t next_residuals = 0;  // frame whose residuals are looked at next
  std::int64_t columns;
  LivePose pose;
  std::int64_t next_frame = 0, ahead = 0;
  double t0_s = 0.0, last_time_s = 0.0;
};

Result<OnlineTracker> OnlineTracker::create(const model::Model& model,
                                            const std::vector<std::string>& markers, double rate_hz,
                                            const TrackOptions& options) {
  if (!(rate_hz > 0.0 && rate_hz <= kFastest_hz))
    return fail(Code::usage, fmt::format("the rate is {} Hz; it must lie in (0, {}]", rate_hz, kFastest_hz));
  if (options.derivatives != nullptr)
    return fail(Code::usage, "a live stream cannot come with the derivatives of a recording");
  if (options.accuracy_rad > 0.0)
    return fail(Code::usage, "a live stream cannot be followed to an accuracy: that takes a whole recording");
  if (options.propose_levels)
    return fail(Code::usage, "levels cannot be proposed for a live stream: that takes a whole recording");
  TrackOptions whole = options;
  whole.first_time_s = -1e300;
  whole.last_time_s = 1e300;
  auto plan = internal::make_plan(model, pretend(model, markers, rate_hz), whole);
  if (!plan) return std::unexpected(plan.error());
  return OnlineTracker(
      std::make_unique<Impl>(std::move(*plan), whole, static_cast<std::int64_t>(markers.size())));
}

OnlineTracker::OnlineTracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OnlineTracker::OnlineTracker(OnlineTracker&&) noexcept = default;
OnlineTracker& OnlineTracker::operator=(OnlineTracker&&) noexcept = default;
OnlineTracker::~OnlineTracker() = default;

std::int64_t OnlineTracker::delay_frames() const { return impl_->filter.delay_frames(); }

Status OnlineTracker::push(double time_s, const Eigen::Matrix3Xd& x) {
  auto& s = *impl_;
  if (x.cols() != s.columns)
    return fail(Code::bad_input, fmt::format("a frame has {} markers; need {}", x.cols(), s.columns));
  if (!std::isfinite(time_s)) return fail(Code::bad_input, "the time of a frame is not a number");
  if (s.window().ended()) return fail(Code::usage, "a frame came after the end of the stream");
  if (s.window().frames() - s.next_frame > s.filter.window_frames())
    return fail(Code::usage,
                "poses are waiting to be fetched; call next() after every frame until it has none");
  if (s.window().frames() == 0) {
    s.t0_s = time_s;
  } else {
    const double wait = time_s - s.last_time_s;
    if (wait <= 0.0)
      return fail(Code::bad_input, fmt::format("time runs backwards: a frame at {} s came after one at {} s",
                                               time_s, s.last_time_s));
    if (wait > kLongestGap_s)
      return fail(Code::bad_input,
                  fmt::format("no frame for {:.1f} s; after more than {:g} s begin a new stream", wait,
                              kLongestGap_s));
    // Counted from the first frame on, so that rounding does not add up.
    const auto index = std::llround((time_s - s.t0_s) * s.plan.rate_hz);
    const auto ahead = s.window().frames() - index;
    if (static_cast<double>(ahead) > std::max(2.0, kMostAhead_s * s.plan.rate_hz))
      return fail(
          Code::bad_input,
          fmt::format("frames come faster than {:g} Hz: the one at {} s is {} frames ahead of its time; "
                      "give the rate of the stream",
                      s.plan.rate_hz, time_s, ahead));
    for (auto missed = -ahead; missed > 0; --missed) s.take(nullptr);
    s.ahead = std::max<std::int64_t>(0, ahead);
  }
  s.last_time_s = time_s;
  s.take(&x);
  return {};
}

Status OnlineTracker::push_body(int body, const Eigen::Vector3d& point_in_body,
                                const Eigen::Vector3d& force_in_world) {
  auto& s = *impl_;
  const auto bodies = std::ssize(s.plan.problem.model.bodies());
  if (body < 0 || body >= bodies)
    return fail(Code::bad_input, fmt::format("body {} is pushed; the model has {}, from 0", body, bodies));
  if (!point_in_body.allFinite() || !force_in_world.allFinite())
    return fail(Code::bad_input, "the force on a body, or its point, is not a number");
  if (force_in_world.norm() > kLargestPush_n)
    return fail(Code::bad_input, fmt::format("a body is pushed by {:.0f} N; at most {:g} N are applied",
                                             force_in_world.norm(), kLargestPush_n));
  if (!s.walker) return {};
  if (force_in_world.isZero(0.0))
    s.walker->push({});
  else
    s.walker->push({.body = body, .point_in_body = point_in_body, .force_in_world = force_in_world});
  return {};
}

void OnlineTracker::finish() { (impl_->walker ? impl_->walker->samples() : impl_->samples).end(); }

Result<const LivePose*> OnlineTracker::next() {
  auto& s = *impl_;
  const std::int64_t f = s.next_frame;
  s.pose.frame = f;
  s.pose.time_s = s.t0_s + static_cast<double>(f) / s.plan.rate_hz;
  if (!s.walker) {
    if (!s.ready(f)) return nullptr;
    const auto started = s.try_start(f);
    if (!started) return std::unexpected(started.error());
    ++s.next_frame;
    if (*started) {
      s.describe();
    } else {
      const Eigen::VectorXd still = Eigen::VectorXd::Zero(s.plan.problem.model.speed_count());
      s.read(s.plan.rest, still, still);
    }
    return &s.pose;
  }
  if (!s.ready(f - 1)) return nullptr;
  s.walker->next();
  ++s.next_frame;
  s.describe();
  return &s.pose;
}

std::vector<std::string> OnlineTracker::locked_coordinates() const {
  std::vector<std::string> names;
  for (const int c : impl_->plan.locked)
    names.push_back(impl_->plan.problem.model.description().coordinates[at(c)].name);
  return names;
}

std::int64_t OnlineTracker::frames_ahead() const { return impl_->ahead; }

std::int64_t OnlineTracker::restarts() const { return impl_->walker ? impl_->walker->restarts() : 0; }

}  // namespace kinemark::motion

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/online_smoother.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/internal/start.h"
#include "kinemark/stages/motion/smoother/internal/frame_rows.h"
#include "kinemark/stages/motion/smoother/internal/motion_output.h"
#include "kinemark/stages/motion/smoother/internal/step_prior.h"
#include "kinemark/stages/motion/smoother/internal/window.h"

namespace kinemark::motion {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using internal::NodeFactor;

constexpr double kLargestSd = 0.5;        // rad or m, as in the smoother
constexpr double kFloor = 1e-6;           // 1/rad^2 or 1/m^2: holds undetermined directions
constexpr double kLinearizeAgain = 0.02;  // rad or m; a prediction that misses by more is linearized anew
constexpr int kLinearizations = 4;
constexpr std::int64_t kFewestMarkers = 3;
constexpr double kFarthest_m = 1e6;     // farther positions are not those of a marker
constexpr double kLargestEntry = 1e60;  // of the normal equations: products of these are finite

/// The markers of the newest frame.
class NewestFrame final : public Observations {
 public:
  explicit NewestFrame(std::vector<MarkerTrust> trust) : trust_(std::move(trust)) {}
  Eigen::Matrix3Xd x;
  void linearize(std::int64_t, const Eigen::Matrix3Xd& p, MarkerInformation& out) const override {
    out.clear(p.cols(), false);
    for (Eigen::Index m = 0; m < p.cols(); ++m)
      if (x.col(m).allFinite()) (void)add_point(trust_[at(m)], x.col(m) - p.col(m), m, out);
  }

 private:
  std::vector<MarkerTrust> trust_;
};

}  // namespace

Status OnlineMotionOptions::check() const {
  if (lag_frames < 3) return fail(Code::usage, fmt::format("lag is {} frames; need 3 or more", lag_frames));
  return {};
}

struct OnlineMotionSmoother::Impl {
  Impl(model::Model of, std::vector<std::string> names, const SmootherTuning& tuning,
       const OnlineMotionOptions& chosen)
      : model(std::move(of)),
        markers(std::move(names)),
        options(chosen),
        rate_hz(tuning.rate_hz),
        newest(tuning.markers),
        rows(model),
        prior(model, tuning.step_variance),
        window(model.speed_count()),
        w(model),
        fixed(at(model.speed_count()), 0),
        near(model.coordinate_count()) {
    for (int c = 0; c < model.coordinate_count(); ++c) {
      const auto& described = model.description().coordinates[at(c)];
      near[c] = described.default_value;
      const int speed = model.coordinates()[at(c)].speed_idx;
      if (speed >= 0 && described.locked) fixed[at(speed)] = 1;
    }
  }

  struct Node {
    VectorXd x;         ///< where it was linearized
    VectorXd step;      ///< from there to the best estimate
    NodeFactor factor;  ///< of the last three nodes: as if no more frames came
  };

  [[nodiscard]] VectorXd best(const Node& node) const {
    VectorXd x = node.x;
    model::integrate(model, x, node.step);
    return x;
  }

  /// Pose of the first frame, without a previous one.
  [[nodiscard]] Result<VectorXd> first_pose() const {
    auto recording = data::Trajectories::all_missing(markers, {.rate_hz = rate_hz, .frames = 1});
    for (std::int64_t m = 0; m < recording.markers(); ++m) {
      if (!newest.x.col(m).allFinite()) continue;
      recording.x(0, m) = newest.x.col(m);
      recording.state[at(m)] = data::SampleState::measured;
    }
    const IkOptions ik;
    auto problem = internal::make_problem(model, recording, ik);
    if (!problem) return std::unexpected(problem.error());
    internal::FrameSolver solver(*problem, ik);
    Eigen::Matrix3Xd y(3, problem->model.marker_count());
    VectorXd weight(problem->model.marker_count()), x = problem->model.default_state();
    problem->observe(recording, 0, y, weight);
    (void)internal::find_start(*problem, ik, solver, y, weight, 0, ik.starts, x);
    return x;
  }

  /// Prediction from the last frames: constant second difference.
  [[nodiscard]] VectorXd predict() const {
    const auto n = nodes.size();
    if (n == 0) return {};
    VectorXd x = best(nodes.back()), last, before;
    if (n >= 2) {
      model::difference(model, best(nodes[n - 2]), x, last);
      if (n >= 3) {
        model::difference(model, best(nodes[n - 3]), best(nodes[n - 2]), before);
        last = 2.0 * last - before;
      }
      model::integrate(model, x, last);
    }
    return x;
  }

  /// The newest frame, linearized at x, in the slot after those in view.
  void add_newest(const VectorXd& x, internal::Window& into) {
    (void)rows.visit(newest, 0, x);
    rows.descent(g);
    rows.matrix(H);
    H.diagonal().array() += kFloor;
    const auto n = static_cast<int>(nodes.size());
    into.add(std::min(n, 3), H, g);
    if (n < 3) return;
    (void)prior.visit(nodes[at(n - 3)].x, nodes[at(n - 2)].x, nodes[at(n - 1)].x, x);
    prior.add_to(into, true);
  }

  /// Steps of all nodes inside, from the window that has them all but for those eliminated for good.
  void solve(internal::Window in_view, std::deque<Node>& of) const {
    const auto count = static_cast<std::int64_t>(of.size());
    for (std::int64_t j = std::max<std::int64_t>(0, count - 3); j < count; ++j)
      in_view.eliminate(fixed.data(), of[at(j)].factor);
    const auto n = model.speed_count();
    VectorXd next = VectorXd::Zero(3 * n);
    for (std::int64_t j = count - 1; j >= 0; --j) {
      internal::step_back(of[at(j)].factor, next, of[at(j)].step);
      next.tail(2 * n) = next.head(2 * n).eval();
      next.head(n) = of[at(j)].step;
    }
  }

  /// False when the normal equations or a step are not finite; the stored state is then invalid.
  [[nodiscard]] bool take_in(VectorXd x) {
    internal::Window with = window;
    for (int round = 0; round < kLinearizations; ++round) {
      with = window;
      add_newest(x, with);
      if (!(with.matrix().array().abs() <= kLargestEntry).all() ||
          !(with.right().array().abs() <= kLargestEntry).all())
        return false;
      const bool full = nodes.size() >= 3;
      NodeFactor oldest;
      if (full) with.eliminate(fixed.data(), oldest);
      if (full) nodes[nodes.size() - 3].factor = std::move(oldest);
      nodes.push_back({.x = x});
      solve(with, nodes);
      if (!std::ranges::all_of(nodes, [](const Node& node) { return node.step.allFinite(); })) return false;
      if (round + 1 == kLinearizations || nodes.back().step.cwiseAbs().maxCoeff() <= kLinearizeAgain) break;
      model::integrate(model, x, nodes.back().step);
      nodes.pop_back();
    }
    window = with;
    while (static_cast<std::int64_t>(nodes.size()) > options.lag_frames + 3) nodes.pop_front();
    return true;
  }

  void forget() {
    nodes.clear();
    window.clear();
  }

  /// The current estimate of the node at a position in the queue.
  SmoothedFrame read(std::int64_t index) {
    const std::int64_t from = std::max<std::int64_t>(0, index - 2),
                       to = std::min<std::int64_t>(static_cast<std::int64_t>(nodes.size()), index + 3);
    MatrixXd states(model.state_count(), to - from);
    for (std::int64_t j = from; j < to; ++j) {
      VectorXd x = best(nodes[at(j)]);
      if (options.limits)
        for (int c = 0; c < model.coordinate_count(); ++c) {
          const auto& described = model.description().coordinates[at(c)];
          const int row = model.coordinates()[at(c)].state_idx;
          if (row >= 0 && described.clamped && !described.locked)
            x[row] = std::clamp(x[row], described.range_min, described.range_max);
        }
      states.col(j - from) = x;
    }
    SmoothedFrame out;
    out.frame = pushed - static_cast<std::int64_t>(nodes.size()) + index;
    VectorXd v = VectorXd::Zero(model.speed_count()), vdot = v;
    if (states.cols() >= 3) internal::speeds_of_states(model, states, index - from, rate_hz, v, vdot);
    model::coordinates_from_state(model, states.col(index - from), near, out.q);
    near = out.q;
    model::kinematics(model, w, states.col(index - from));
    model::rates_from_speeds(model, w, out.q, v, vdot, out.qd, out.qdd);
    if (options.error_bars) add_bars(index, out);
    return out;
  }

  void add_bars(std::int64_t index, SmoothedFrame& out) {
    const int n = model.speed_count();
    internal::CovarianceWindow covariance(n);
    for (auto j = static_cast<std::int64_t>(nodes.size()) - 1; j >= index; --j)
      covariance.step_back(nodes[at(j)].factor);
    MatrixXd own = covariance.matrix().topLeftCorner(n, n), E;
    for (int i = 0; i < n; ++i)
      if (fixed[at(i)]) {
        own.row(i).setZero();
        own.col(i).setZero();
      }
    model::coordinate_jacobian(model, w, out.q, E);
    out.q_sd.setConstant(out.q.size(), kNaN);
    out.determined.assign(at(out.q.size()), 0);
    const MatrixXd rows_of_q = E * own;
    for (Eigen::Index c = 0; c < out.q.size(); ++c) {
      const double sd = std::sqrt(std::max(0.0, rows_of_q.row(c).dot(E.row(c))));
      if (!(sd <= kLargestSd)) continue;
      out.q_sd[c] = sd;
      out.determined[at(c)] = 1;
    }
  }

  model::Model model;
  std::vector<std::string> markers;
  OnlineMotionOptions options;
  double rate_hz;
  NewestFrame newest;
  internal::FrameRows rows;
  internal::StepPrior prior;
  internal::Window window;  ///< the last three nodes, after all before were eliminated
  model::Workspace w;
  std::vector<std::uint8_t> fixed;
  VectorXd near, g;
  MatrixXd H;
  std::deque<Node> nodes;
  std::int64_t pushed = 0;  ///< frames, from the first with markers enough; the last node is the newest
};

OnlineMotionSmoother::OnlineMotionSmoother(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OnlineMotionSmoother::OnlineMotionSmoother(OnlineMotionSmoother&&) noexcept = default;
OnlineMotionSmoother& OnlineMotionSmoother::operator=(OnlineMotionSmoother&&) noexcept = default;
OnlineMotionSmoother::~OnlineMotionSmoother() = default;

Result<OnlineMotionSmoother> OnlineMotionSmoother::create(const model::Model& model,
                                                          const std::vector<std::string>& markers,
                                                          SmootherTuning tuning,
                                                          const OnlineMotionOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  if (!(tuning.rate_hz > 0.0) || !std::isfinite(tuning.rate_hz))
    return fail(Code::usage,
                fmt::format("the tuning is of {} Hz; need a finite rate above 0", tuning.rate_hz));
  if (tuning.markers.size() != markers.size() || tuning.step_variance.size() != model.speed_count())
    return fail(Code::usage, fmt::format("the tuning is of {} markers and {} speeds; need {} and {}",
                                         tuning.markers.size(), tuning.step_variance.size(), markers.size(),
                                         model.speed_count()));
  if (!(tuning.step_variance.array() > 0.0).all() || !tuning.step_variance.allFinite())
    return fail(Code::usage, "the tuning has a step variance that is not a finite number above 0");
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const auto& trust = tuning.markers[m];
    if (!(trust.information > 0.0) || !std::isfinite(trust.information) || !(trust.huber_m > 0.0) ||
        !std::isfinite(trust.huber_m))
      return fail(
          Code::usage,
          fmt::format(
              "the tuning of marker '{}' has an information of {} 1/m^2 and a Huber threshold of {} m; both "
              "need to be finite and above 0",
              markers[m], trust.information, trust.huber_m));
  }
  data::ModelDescription reduced = model.description();
  reduced.markers.clear();
  for (const auto& name : markers) {
    const int m = model.description().find_marker(name);
    if (m < 0) return fail(Code::bad_input, fmt::format("the model has no marker '{}'", name));
    reduced.markers.push_back(model.description().markers[at(m)]);
  }
  auto compiled = model::Model::compile(std::move(reduced), {.free_roots = !model.free_joints().empty()});
  if (!compiled) return std::unexpected(compiled.error());
  return OnlineMotionSmoother(std::make_unique<Impl>(std::move(*compiled), markers, tuning, options));
}

Result<std::optional<SmoothedFrame>> OnlineMotionSmoother::push(const Eigen::Matrix3Xd& x) {
  auto& live = *impl_;
  if (x.cols() != static_cast<Eigen::Index>(live.markers.size()))
    return fail(Code::bad_input,
                fmt::format("the frame has {} markers; need {}", x.cols(), live.markers.size()));
  live.newest.x = x;
  for (Eigen::Index m = 0; m < x.cols(); ++m)
    if (!(x.col(m).cwiseAbs().maxCoeff() <= kFarthest_m)) live.newest.x.col(m).setConstant(kNaN);
  VectorXd guess = live.predict();
  if (live.nodes.empty()) {
    std::int64_t seen = 0;
    for (Eigen::Index m = 0; m < x.cols(); ++m) seen += live.newest.x.col(m).allFinite();
    if (seen < kFewestMarkers) {
      if (live.pushed > 0) ++live.pushed;
      return std::optional<SmoothedFrame>();
    }
    auto pose = live.first_pose();
    if (!pose) return std::unexpected(pose.error());
    guess = std::move(*pose);
  }
  ++live.pushed;
  if (!live.take_in(std::move(guess))) {
    live.forget();
    return std::optional<SmoothedFrame>();
  }
  const std::int64_t index = static_cast<std::int64_t>(live.nodes.size()) - 1 - live.options.lag_frames;
  if (index < 0) return std::optional<SmoothedFrame>();
  return std::optional<SmoothedFrame>(live.read(index));
}

std::vector<SmoothedFrame> OnlineMotionSmoother::finish() {
  auto& live = *impl_;
  std::vector<SmoothedFrame> rest;
  const auto count = static_cast<std::int64_t>(live.nodes.size());
  for (std::int64_t index = std::max<std::int64_t>(0, count - live.options.lag_frames); index < count;
       ++index)
    rest.push_back(live.read(index));
  live.forget();
  live.pushed = 0;
  return rest;
}

}  // namespace kinemark::motion

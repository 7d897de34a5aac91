// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Direct marker control on simulated subjects whose angles are known.
#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "acceptance/track_subject.h"
#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/priority_solver.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_support::print_row;

struct Tasks {
  MatrixXd M;
  std::vector<MatrixXd> J;
  std::vector<VectorXd> r;
};

/// Equations 2 to 13 of the paper as they stand there: Lambda, Jbar and N.
VectorXd textbook(const Tasks& t, std::size_t levels, const VectorXd& posture) {
  const auto n = t.M.rows();
  const MatrixXd inverse = t.M.inverse(), one = MatrixXd::Identity(n, n);
  MatrixXd N = one;
  VectorXd force = VectorXd::Zero(n);
  for (std::size_t i = 0; i < levels; ++i) {
    const MatrixXd J = t.J[i] * N;
    const MatrixXd lambda = (J * inverse * J.transpose()).inverse();
    const MatrixXd Jbar = inverse * J.transpose() * lambda;
    force += J.transpose() * lambda * (t.r[i] - t.J[i] * inverse * force);
    N = N * (one - Jbar * J);
  }
  return inverse * (force + N.transpose() * t.M * (posture - inverse * force));
}

void equations() {
  const auto model = human();
  model::Workspace w(model);
  const int n = model.speed_count();
  double worst = 0.0, moved = 0.0;
  bool complete = true;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Random random(seed, 3);
    VectorXd q = VectorXd::Zero(model.coordinate_count());
    for (auto& value : q) value = random.uniform(-0.6, 0.6);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    Tasks t;
    MatrixXd J;
    model::mass_matrix(model, w, t.M);
    model::marker_jacobian(model, w, J);
    // One marker each of pelvis, hand, foot and head: the goals of the levels do not conflict.
    for (const char* name : {"RASI", "LFIN", "RTOE", "RFHD"}) {
      const auto m = model.description().find_marker(name);
      if (m < 0) continue;  // reported below: all four must be there
      t.J.push_back(J.middleRows(3 * m, 3));
      VectorXd r(3);
      for (auto& value : r) value = random.gaussian();
      t.r.push_back(std::move(r));
    }
    complete = complete && t.J.size() == 4;
    VectorXd posture(n);
    for (auto& value : posture) value = random.gaussian();
    const std::vector<std::uint8_t> nothing(at(n), 0);
    motion::internal::PrioritySolver solver(n);
    VectorXd before;
    for (std::size_t levels = 1; levels <= t.J.size(); ++levels) {
      solver.begin(t.M, nothing, VectorXd::Zero(n));
      for (std::size_t i = 0; i < levels; ++i) {
        before = solver.acceleration();
        solver.add_level(t.J[i], t.r[i], {.damping = 0.0, .truncation = 1e-9});
        for (std::size_t k = 0; k < i; ++k)
          moved = larger(moved, (t.J[k] * (solver.acceleration() - before)).norm() / t.r[i].norm());
      }
      before = solver.acceleration();
      solver.add_posture(posture);
      for (std::size_t k = 0; k < levels; ++k)
        moved = larger(moved, (t.J[k] * (solver.acceleration() - before)).norm() / posture.norm());
      const VectorXd expected = textbook(t, levels, posture);
      worst = larger(worst, (solver.acceleration() - expected).norm() / expected.norm());
    }
  }
  print_row(complete && worst < 1e-9,
            "whitened equations against Lambda, Jbar, N of the textbook, 1 to 4 levels", "1e-9 relative",
            fmt::format("{:.1e}", worst));
  print_row(complete && moved < 1e-9, "lower levels and posture move higher ones", "< 1e-9",
            fmt::format("{:.1e}", moved));
}

motion::TrackResult run(const model::Model& model, const data::Trajectories& markers,
                        motion::TrackOptions options) {
  options.threads = 0;
  return motion::track_markers(model, markers, options).value();
}

void one_level(int seeds) {
  const auto model = human();
  double ratio = 0.0, marker = 0.0, ours = 0.0;
  std::int64_t flagged = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto s = subject(model, 1e-3, 60.0, 10.0, static_cast<std::uint64_t>(seed));
    const auto goals = motion::control_goals(s.markers).value();
    const auto ik = motion::solve_ik(model, goals, {.judge_samples = false, .error_bars = false}).value();
    const auto track = run(model, s.markers, {.step_s = 1e-3, .error_bars = false});
    const double angle = joint_rms_deg(model, track.motion, s.truth);
    ratio = larger(ratio, angle / joint_rms_deg(model, ik.motion, s.truth));
    marker = larger(marker, 1e3 * track.rms_goal_error_m);
    ours = larger(ours, angle);
    flagged += track.flagged_frames;
  }
  print_row(
      ratio <= 1.02 && flagged == 0,
      fmt::format("40 markers, 1 mm, one level, 1 ms: joint RMS against least squares, {} subjects", seeds),
      "<= 1.02 times", fmt::format("{:.4f} times, {:.3f} deg, {} flagged", ratio, ours, flagged));
  print_row(marker <= 0.7, "the same: marker RMS against the goals", "<= 0.7 mm",
            fmt::format("{:.3f} mm", marker));
}

void levels(int seeds) {
  const auto model = human();
  std::vector<std::string> names;
  for (const auto& m : model.description().markers) names.push_back(m.name);
  const auto mixed = [&](std::size_t count) {
    std::vector<motion::TrackLevel> list(count);
    for (std::size_t m = 0; m < names.size(); ++m) list[(7 * m) % count].markers.push_back(names[m]);
    return list;
  };
  std::vector<motion::TrackLevel> pairs(names.size() / 2);
  for (std::size_t m = 0; m < 2 * pairs.size(); ++m) pairs[m / 2].markers.push_back(names[m]);
  const std::vector<std::pair<std::string, std::vector<motion::TrackLevel>>> cases{
      {"three strict levels", three_levels(model)},
      {"20 levels of two", pairs},
      {"two levels, markers mixed", mixed(2)}};
  for (const auto& [what, list] : cases) {
    std::int64_t flagged = 0;
    double angle = 0.0, one = 0.0, marker = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const auto s = subject(model, 1e-3, 60.0, 10.0, static_cast<std::uint64_t>(seed));
      const auto strict =
          run(model, s.markers, {.levels = list, .strict = true, .step_s = 2e-3, .error_bars = false});
      const auto flat = run(model, s.markers, {.step_s = 2e-3, .error_bars = false});
      flagged += strict.flagged_frames + strict.restarts;
      angle = larger(angle, joint_rms_deg(model, strict.motion, s.truth));
      one = larger(one, joint_rms_deg(model, flat.motion, s.truth));
      marker = larger(marker, 1e3 * strict.rms_goal_error_m);
    }
    print_row(flagged == 0 && std::isfinite(angle + one + marker), what,
              "no failure; cost of priority reported",
              fmt::format("{} failures; joints {:.3f} deg against {:.3f} deg at one level, markers {:.2f} mm",
                          flagged, angle, one, marker));
  }
}

constexpr std::int64_t kMargin = 30;  // frames left out at each end, where the filter mirrors

/// Share of the bounded values that hold, and the mean of bound over error.
struct Held {
  std::int64_t bounded = 0, held = 0, all = 0;
  double ratio = 0.0, worst = 0.0;
};

Held count_bounds(const model::Model& model, const motion::TrackResult& track,
                  const data::JointMotion& truth) {
  Held held;
  std::vector<double> ratios;
  const auto& motion = track.motion;
  for (std::int64_t f = kMargin; f < motion.frames() - kMargin; ++f)
    for (const auto c : joints(model)) {
      ++held.all;
      const double bound = motion.q_bound[motion.index(f, c)];
      if (std::isnan(bound)) continue;
      const double miss = std::abs(motion.q[motion.index(f, c)] - truth.q[truth.index(f, c)]);
      ++held.bounded;
      held.held += miss <= bound;
      held.worst = larger(held.worst, miss / bound);
      ratios.push_back(bound / std::max(miss, 1e-12));
    }
  if (ratios.empty()) return held;
  held.ratio = math::upper_median(ratios);
  return held;
}

void bounds(int seeds) {
  const auto model = human();
  struct Case {
    std::string what;
    double noise;
    std::vector<motion::TrackLevel> levels;
    motion::LockMode lock;
    double share_low, share_high;  // of coordinates that may be called determined
  };
  const std::vector<Case> cases{
      {"exact goals, one level", 0.0, {}, motion::LockMode::automatic, 0.999, 1.0},
      {"exact goals, three levels", 0.0, three_levels(model), motion::LockMode::automatic, 0.999, 1.0},
      {"1 mm noise, one level", 1e-3, {}, motion::LockMode::automatic, 0.999, 1.0},
      {"1 mm noise, three levels", 1e-3, three_levels(model), motion::LockMode::automatic, 0.999, 1.0},
      {"the paper's 2 + 2 markers",
       1e-3,
       {{.markers = {"RSHO", "LWRA"}}, {.markers = {"LELB", "RWRA"}}},
       motion::LockMode::off,
       0.0,
       0.2}};
  for (const auto& c : cases) {
    Held sum;
    int lowest = 1000, highest = 0;
    double ratio = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const auto s = subject(model, c.noise, 60.0, 5.0, static_cast<std::uint64_t>(seed));
      motion::TrackOptions options{.levels = c.levels, .strict = true, .step_s = 2e-3, .lock = c.lock};
      if (c.noise == 0.0) options.cutoff_hz = 0.0;  // goals are the truth, to the last digit
      const auto track = run(model, s.markers, options);
      const auto held = count_bounds(model, track, s.truth);
      sum.all += held.all;
      sum.bounded += held.bounded;
      sum.held += held.held;
      sum.worst = larger(sum.worst, held.worst);
      ratio += held.ratio / seeds;
      lowest = std::min(lowest, *std::min_element(track.rank.begin(), track.rank.end()));
      highest = std::max(highest, *std::max_element(track.rank.begin(), track.rank.end()));
    }
    const double share = static_cast<double>(sum.bounded) / static_cast<double>(sum.all);
    print_row(
        sum.bounded > 0 && sum.held == sum.bounded && share >= c.share_low && share <= c.share_high,
        "bound of the error by equation 15 and 5 SD of the goals' noise, " + c.what,
        c.share_low > 0.0 ? "holds in 100 % of the frames" : "holds where given, most not determined",
        fmt::format(
            "holds for {} of {} values ({:.1f} % of all but {} frames at each end), rank {} to {}; median "
            "bound {:.0f} times the error, tightest {:.2f}",
            sum.held, sum.bounded, 100.0 * share, kMargin, lowest, highest, ratio,
            sum.worst > 0.0 ? 1.0 / sum.worst : 0.0));
  }
}

/// accept_motion track [SEEDS]: subjects per row.
int run_check(int argc, char** argv) {
  const int seeds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1;
  equations();
  one_level(seeds);
  levels(seeds);
  bounds(seeds);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track", run_check);

}  // namespace

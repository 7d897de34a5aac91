// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A live stream with levels whose body is pushed: what is tracked stays the same bits, the body goes as far
// as force and stiffness say, and comes back.
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include "acceptance/track_subject.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using testing_support::print_row;

constexpr double kRate_hz = 240.0, kSeconds = 6.0;
constexpr double kPushed_s = 2.0, kReleased_s = 3.5;

struct Push {
  int body = -1;
  double force_n = 0.0;
};

struct Stream {
  std::vector<motion::LivePose> poses;
  std::vector<double> busy_s;  ///< of the processor, per frame
};

Stream run(const model::Model& model, const data::Trajectories& markers, const motion::TrackOptions& options,
           const Push& push) {
  auto tracker = motion::OnlineTracker::create(model, markers.names, kRate_hz, options).value();
  Stream out;
  Eigen::Matrix3Xd x(3, markers.markers());
  const auto fetch = [&] {
    while (const auto* pose = tracker.next().value()) {
      out.poses.push_back(*pose);
      if (push.body < 0) continue;
      const bool acts = pose->time_s >= kPushed_s && pose->time_s < kReleased_s;
      tracker
          .push_body(push.body, model.bodies()[static_cast<std::size_t>(push.body)].com_in_body,
                     Eigen::Vector3d(0.0, 0.0, acts ? push.force_n : 0.0))
          .value();
    }
  };
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    for (std::int64_t m = 0; m < markers.markers(); ++m) x.col(m) = markers.x(f, m);
    const auto begun = std::clock();
    tracker.push(markers.time.time_s(f), x).value();
    fetch();
    out.busy_s.push_back(static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC);
  }
  tracker.finish();
  fetch();
  return out;
}

const motion::LivePose& at_s(const Stream& stream, double time_s) {
  return stream.poses[static_cast<std::size_t>(std::llround(time_s * kRate_hz))];
}

void compare_with_a_file(const model::Model& model, const data::Trajectories& markers,
                         motion::TrackOptions options, const char* what, const Push& push) {
  options.marker_noise_sd_m = 1e-3;
  const auto live = run(model, markers, options, push);
  options.error_bars = false;
  const auto file = motion::track_markers(model, markers, options).value().motion;
  double differ = 0.0;
  std::int64_t pushed = 0;
  for (std::int64_t f = 0; f < file.frames(); ++f) {
    const auto& pose = live.poses[static_cast<std::size_t>(f)];
    pushed += pose.pushed_q.size() > 0;
    for (std::int64_t c = 0; c < file.size(); ++c)
      differ = larger(differ, std::abs(pose.q[c] - file.q[file.index(f, c)]));
  }
  print_row(
      std::ssize(live.poses) == file.frames() && differ == 0.0 && pushed > 300,
      fmt::format("{}: same numbers as offline, also in {} frames in which the body is pushed", what, pushed),
      "no difference, more than 300 frames", fmt::format("{:.1e} in {} frames", differ, file.frames()));
  const double busy_s = math::nth_smallest(
      live.busy_s, static_cast<std::size_t>(0.99 * static_cast<double>(live.busy_s.size())));
  print_row(busy_s < 1.0 / kRate_hz, fmt::format("{}: time of the processor, 99 % of the frames", what),
            "< 4.17 ms, a frame at 240 Hz", fmt::format("{:.2f} ms", 1e3 * busy_s));
}

void push_and_return(const model::Model& model, const data::Trajectories& markers, const Push& push) {
  const auto deviation = [&](double omega, double force_n) {
    return run(model, markers, {.omega_rad_s = omega, .error_bars = false}, {push.body, force_n});
  };
  constexpr double kOmega = 30.0;
  const auto once = deviation(kOmega, push.force_n);
  const double away_m = at_s(once, kReleased_s).pushed_m;
  double off = 0.0;
  for (double t_s = 0.0; t_s < 0.3; t_s += 1.0 / kRate_hz) {
    const double wt = kOmega * t_s;
    off = larger(off, std::abs(at_s(once, kReleased_s + t_s).pushed_m / away_m - (1.0 + wt) * std::exp(-wt)));
  }
  const double left = at_s(once, kReleased_s + 6.6 / kOmega).pushed_m / away_m;
  print_row(off < 0.05 && left < 0.02, "return after the release, as (1 + wt) exp(-wt)",
            "within 0.05 of it in each frame, at most 2 % after 6.6 / w",
            fmt::format("{:.3f} off, {:.2f} % of {:.1f} mm left", off, 100.0 * left, 1e3 * away_m));
  print_row(at_s(once, kReleased_s + 1.0).pushed_q.size() == 0, "a second after the release",
            "the body is back", fmt::format("{:.2f} mm away", 1e3 * at_s(once, kReleased_s + 1.0).pushed_m));
  const double twice = at_s(deviation(kOmega, 2.0 * push.force_n), kReleased_s).pushed_m / away_m;
  const double stiff = away_m / at_s(deviation(2.0 * kOmega, push.force_n), kReleased_s).pushed_m;
  print_row(std::abs(twice - 2.0) < 0.2 && std::abs(stiff - 4.0) < 0.4, "how far a push goes: f / (m w^2)",
            "twice as far by twice the force, a quarter by twice w, within 10 %",
            fmt::format("{:.2f} times, 1 / {:.2f}", twice, stiff));
}

/// accept_motion live_push [seed=N]
int run_check(int argc, char** argv) {
  const Asked asked(argc, argv, 1);
  const auto model = human();
  const auto s = subject(model, 1e-3, kRate_hz, kSeconds, asked.seed);
  const auto& bodies = model.bodies();
  Push push{.force_n = 60.0};
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (model.description().bodies[static_cast<std::size_t>(bodies[b].description_idx)].name == "tibia_r")
      push.body = static_cast<int>(b);
  const std::vector<std::string> pelvis{"LASI", "RASI", "LPSI", "RPSI"};
  compare_with_a_file(model, s.markers,
                      {.levels = {{.markers = pelvis, .weight = 4.0}, {.markers = {"*"}, .weight = 1.0}}},
                      "two levels by weights", push);
  compare_with_a_file(
      model, s.markers,
      {.levels = {{.markers = pelvis}, {.markers = {"*"}}}, .strict = true, .level_bound_m = 0.02},
      "two strict levels", push);
  push_and_return(model, s.markers, push);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("live_push", run_check);

}  // namespace

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The rig of 1986: the study's table on ten rigs, its own method against its own column, and rigs under
// stress.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "kinemark/stages/trajectory/from_counts/smooth_counts.h"
#include "studies/poizner/study_poizner_job.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

/// One number of the 1986 method as the reference found it, and how to get it from a seed.
struct Anchor {
  const char* what;
  double value;
  std::function<double(const studies::PoiznerSeed&)> get;
};

std::vector<Anchor> anchors() {
  std::vector<Anchor> out{
      {"still tree, scatter x, mm", 0.61, [](auto& s) { return 1e3 * s.tree.classic.sd_m.x(); }},
      {"still tree, scatter y, mm", 0.57, [](auto& s) { return 1e3 * s.tree.classic.sd_m.y(); }},
      {"still tree, scatter z, mm", 1.04, [](auto& s) { return 1e3 * s.tree.classic.sd_m.z(); }}};
  struct Wheel {
    int index;
    const char* name;
    double error, sd, most, plane_raw, plane;
  };
  for (const Wheel& w : {Wheel{0, "wheel at 8 deg", 0.68, 0.58, 2.2, 0.96, 0.59},
                         Wheel{1, "wheel at 35 deg", 0.92, 1.07, 3.2, 1.38, 0.82}}) {
    const auto i = static_cast<std::size_t>(w.index);
    out.push_back({"wheel, median error, mm", w.error,
                   [i](auto& s) { return 1e3 * std::abs(s.wheels[i].classic.median_error_m); }});
    out.push_back({"wheel, scatter, mm", w.sd, [i](auto& s) { return 1e3 * s.wheels[i].classic.sd_m; }});
    out.push_back(
        {"wheel, largest error, mm", w.most, [i](auto& s) { return 1e3 * s.wheels[i].classic.max_error_m; }});
    out.push_back({"wheel, plane, not filtered, mm", w.plane_raw,
                   [i](auto& s) { return 1e3 * s.wheels[i].classic_raw.plane_sd_m; }});
    out.push_back(
        {"wheel, plane, mm", w.plane, [i](auto& s) { return 1e3 * s.wheels[i].classic.plane_sd_m; }});
  }
  out.push_back({"wheel with glint, largest error, not filtered, mm", 9.6,
                 [](auto& s) { return 1e3 * s.wheels[2].classic_raw.max_error_m; }});
  out.push_back({"wheel with glint, ratio of axes less 1, not filtered, %", 2.7,
                 [](auto& s) { return 100.0 * (s.wheels[2].classic_raw.width_ratio - 1.0); }});
  constexpr std::array<std::array<double, 3>, 4> kArm{
      {{1.4, 28.2, 1.88}, {1.9, 34.8, 1.84}, {3.2, 51.9, 1.85}, {4.4, 65.9, 2.05}}};
  for (std::size_t led = 0; led < 4; ++led) {
    out.push_back({"arm, position, mm", kArm[led][0],
                   [led](auto& s) { return 1e3 * s.arm.leds[led].classic.position; }});
    out.push_back({"arm, velocity, mm/s", kArm[led][1],
                   [led](auto& s) { return 1e3 * s.arm.leds[led].classic.velocity; }});
    out.push_back({"arm, acceleration, m/s^2", kArm[led][2],
                   [led](auto& s) { return s.arm.leds[led].classic.acceleration; }});
  }
  return out;
}

/// The whole table for seeds 1 to `last`.
void study(int last) {
  studies::PoiznerJob job;
  job.seeds = studies::parse_seeds(fmt::format("1-{}", last)).value();
  const auto done = studies::study_poizner(job).value();
  for (const auto& row : done.table.rows) {
    std::string asked;
    if (row.at_least) asked += fmt::format(">= {:.4g} ", *row.at_least);
    if (row.at_most) asked += fmt::format("<= {:.4g} ", *row.at_most);
    const std::string measured = fmt::format(
        "{:.4g}{}", row.ours,
        row.expected ? fmt::format(" ({} {:.4g})", to_string(row.expected_is), *row.expected) : "");
    if (asked.empty())
      print_note(row.quantity, measured + " " + row.unit);
    else
      print_row(row.pass(), row.quantity, asked + row.unit, measured);
  }
  if (last < 10) return;
  std::vector<double> mean, most;
  for (const auto& seed : done.seeds) {
    mean.push_back(1e3 * seed.tree.classic.mean_error_m());
    most.push_back(1e3 * seed.tree.classic.max_error_m());
  }
  const double all = [&] {
    double sum = 0.0;
    for (const double m : mean) sum += m / static_cast<double>(mean.size());
    return sum;
  }();
  print_row(std::abs(all / 1.56 - 1.0) <= 0.15, "1986 method: still tree, mean error of distances",
            "1.56 mm +- 15 %", fmt::format("{:.3g} mm", all));
  print_row(std::abs(std::ranges::max(most) / 12.1 - 1.0) <= 0.15,
            "1986 method: still tree, largest error of distances", "12.1 mm +- 15 %",
            fmt::format("{:.3g} mm", std::ranges::max(most)));
  for (const auto& anchor : anchors()) {
    std::vector<double> values;
    for (const auto& seed : done.seeds) values.push_back(anchor.get(seed));
    const double found = math::median(values);
    print_row(std::abs(found / anchor.value - 1.0) <= 0.15, std::string("1986 method: ") + anchor.what,
              fmt::format("{:.3g} +- 15 %", anchor.value), fmt::format("{:.3g}", found));
  }
}

/// Distances of the still tree over some rigs: mean error, and error over predicted.
struct Still {
  double mean_error_m = 0.0, error_over_predicted = 0.0;
};

Still still(int seeds, const studies::CalibratedRigOptions& options,
            const studies::StillStudyOptions& how = {}) {
  Still out;
  double squares = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto rig = studies::calibrate_rig(static_cast<std::uint64_t>(seed), options).value();
    const auto found = studies::study_still_tree(rig, how).value();
    out.mean_error_m += found.ours.mean_error_m() / seeds;
    squares += found.error_over_predicted * found.error_over_predicted / seeds;
  }
  out.error_over_predicted = std::sqrt(squares);
  return out;
}

void print_predicted(const std::string& what, const Still& found) {
  print_row(
      found.error_over_predicted >= 0.6 && found.error_over_predicted <= 1.3, what + ", error / predicted",
      "0.6 to 1.3",
      fmt::format("{:.2f}, mean error {:.3f} mm", found.error_over_predicted, 1e3 * found.mean_error_m));
}

void stress() {
  constexpr int kSeeds = 4;
  const Still normal = still(kSeeds, {});
  studies::CalibratedRigOptions wrong;
  wrong.rig.crosstalk = 0.02;
  wrong.rig.ripple = 0.001;
  const Still rich = still(kSeeds, wrong);
  print_row(rich.mean_error_m <= 1.2 * normal.mean_error_m, "wrong detector, rich model",
            fmt::format("mean error of distances <= 1.2 x {:.4f} mm", 1e3 * normal.mean_error_m),
            fmt::format("{:.4f} mm", 1e3 * rich.mean_error_m));
  wrong.bundle.warp_degree = 7;
  wrong.bundle.crosstalk = wrong.bundle.escalate = false;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto refused = studies::calibrate_rig(seed, wrong);
    print_row(!refused && refused.error().message.find("chi2") != std::string::npos,
              fmt::format("wrong detector, plain model, seed {}", seed), "refused by chi2",
              refused ? "accepted" : refused.error().message.substr(0, 70));
  }
  // Offsets hold the stray light of LEDs as bright as those of the calibration, so both are dimmed; the grid
  // is not.
  for (const double light : {0.5, 0.3}) {
    studies::CalibratedRigOptions dim;
    dim.intensity = light;
    dim.grid_in_bundle = false;
    print_predicted(fmt::format("{} of the light", light), still(kSeeds, dim, {.intensity = light}));
  }
  studies::CalibratedRigOptions few;
  few.tree_poses = 30;
  print_predicted("30 tree poses", still(kSeeds, few));
  studies::CalibratedRigOptions bare;
  bare.grid_in_bundle = false;
  print_predicted("no grid", still(kSeeds, bare));

  for (const bool dark : {false, true}) {
    studies::CalibratedRigOptions with;
    with.rig.dark_slot = dark;
    const auto rig = studies::calibrate_rig(1, with).value();
    simulation::WheelOptions wheel;
    wheel.leds = dark ? 7 : 8;
    simulation::RigRecordingOptions how;
    how.rate_hz = std::floor(rig.physical.rig.timing.highest_rate_hz(wheel.leds, 2));
    how.frames = 300;
    const auto recorded = simulation::record(rig.physical, simulation::rotating_wheel(wheel), how).value();
    const auto start = reconstruction::reconstruct(recorded.counts, rig.bundle.rig).value();
    trajectory::SmoothCountsOptions options;
    options.flicker = dark ? trajectory::Flicker::dark_slot : trajectory::Flicker::regress;
    const auto smooth =
        trajectory::smooth_counts(recorded.counts, rig.bundle.rig, start.points, options).value();
    studies::Coverage positions, rates;
    double worst = 0.0;
    for (std::int64_t led = 0; led < recorded.counts.led_count(); ++led) {
      const auto path = studies::aligned_path(smooth.points, smooth.derivatives, led, rig.truth_from_ours);
      studies::add_coverage(path, recorded.truth, recorded.derivatives, led, 10, how.frames - 10, positions,
                            rates);
      const auto errors =
          studies::motion_errors(path.position, path.velocity, path.acceleration, recorded.truth,
                                 recorded.derivatives, led, 10, how.frames - 10);
      const auto predicted = studies::predicted_errors(path, 10, how.frames - 10);
      worst = std::max(worst, errors.position / predicted.position);
    }
    print_row(worst <= 1.3,
              fmt::format("{} LEDs at {} Hz, dark slot {}", wheel.leds, how.rate_hz, dark ? "on" : "off"),
              "error of position / predicted <= 1.3, every LED",
              fmt::format("{:.2f}; within 1 and 2 SD: {:.0f} %, {:.0f} %", worst, 100.0 * positions.share_1(),
                          100.0 * positions.share_2()));
  }
}

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void speed() {
  double best = 1e9;
  studies::CalibratedRig rig = studies::calibrate_rig(1).value();
  for (std::uint64_t run = 0; run < 3; ++run)
    best = std::min(best, studies::calibrate_rig(1).value().bundle_s);
  print_row(best <= 2.0, "bundle of 300 poses x 10 frames, one thread", "<= 2 s",
            fmt::format("{:.2f} s", best));
  simulation::RigRecordingOptions how;
  how.frames = 6000;
  const auto recorded = simulation::record(rig.physical, simulation::signing_arm(), how).value();
  const auto start = reconstruction::reconstruct(recorded.counts, rig.bundle.rig).value();
  trajectory::SmoothCountsOptions options;
  for (const int threads : {1, 0}) {
    options.threads = threads;
    double fastest = 1e9;
    for (int run = 0; run < 3; ++run)
      fastest = std::min(
          fastest, seconds([&] {
            (void)trajectory::smooth_counts(recorded.counts, rig.bundle.rig, start.points, options).value();
          }));
    print_row(
        fastest <= 1.0,
        fmt::format("a minute of 4 LEDs at 100 Hz smoothed, {}", threads == 1 ? "one thread" : "all cores"),
        "<= 1 s", fmt::format("{:.2f} s", fastest));
  }
}

/// accept_rig poizner study LAST_SEED | stress | speed
int run_check(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::string what = arguments.empty() ? "study" : arguments.front();
  if (what == "study") study(arguments.size() > 1 ? std::stoi(arguments[1]) : 10);
  if (what == "stress") stress();
  if (what == "speed") speed();
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("poizner", run_check);

}  // namespace

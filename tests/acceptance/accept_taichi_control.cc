// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The tai chi recording tracked by direct marker control, beside least squares on the same goals.
#include <fmt/core.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "acceptance/taichi_recording.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "studies/taichi/control_runs.h"
#include "studies/taichi/least_squares.h"
#include "studies/taichi/study_taichi.h"
#include "studies/taichi/subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using acceptance::kMillimetres;
using studies::ControlComparison;
using studies::ControlSetting;
using studies::LandmarkSet;
using testing_support::print_row;

/// The sized model, the recording, and what the model itself can do.
struct Scene {
  model::Model model;
  data::Trajectories landmarks, made;
  motion::IkResult ik;
};

Scene prepare(const std::filesystem::path& data) {
  auto landmarks = acceptance::tai_chi_landmarks(data);
  const auto description =
      studies::scale_by_medians(acceptance::human(), landmarks, {.lock_unseen = true}).value();
  auto model = model::Model::compile(description).value();
  auto ik = motion::solve_ik(model, landmarks, studies::reference_ik_options(description)).value();
  auto made = studies::carried_landmarks(model, ik.motion);
  return {.model = std::move(model),
          .landmarks = std::move(landmarks),
          .made = std::move(made),
          .ik = std::move(ik)};
}

std::string describe(const ControlComparison& c) {
  return fmt::format(
      "{:.3f} mm, at most {:.1f} (least squares {:.3f}, {:.1f}); {} frames flagged; {:.0f} us a step",
      kMillimetres * c.control_rms_m, kMillimetres * c.control_max_m, kMillimetres * c.least_squares_rms_m,
      kMillimetres * c.least_squares_max_m, c.flagged_frames, c.us_per_step);
}

void check_recorded(const ControlComparison& c, const std::string& step, double most_deg) {
  constexpr int kDetermined = 30;  // all that is not locked or the root's
  const double above = kMillimetres * (c.control_rms_m - c.least_squares_rms_m);
  print_row(std::abs(above) <= 0.1 && !c.failed(), "whole body, recorded goals, " + step,
            "landmark RMS within 0.1 mm of least squares", describe(c));
  print_row(
      kDegPerRad * c.angle_rms_rad <= most_deg && c.determined >= kDetermined, "whole body, angles, " + step,
      fmt::format("{} angles or more determined, within {} deg RMS of least squares", kDetermined, most_deg),
      fmt::format("{:.3f} deg, at most {:.1f}; {} of {} coordinates determined; rank {} to {} of {}",
                  kDegPerRad * c.angle_rms_rad, kDegPerRad * c.angle_max_rad, c.determined, c.coordinates,
                  c.rank_min, c.rank_max, c.free_speeds));
}

void check_reachable(const ControlComparison& c, const std::string& step, double most_mm) {
  print_row(kMillimetres * c.control_rms_m <= most_mm && !c.failed(),
            "whole body, goals that the model made, " + step, fmt::format("landmark RMS <= {} mm", most_mm),
            describe(c));
}

/// Least squares, solved apart, beside what control itself says of its distance to it.
void check_bounds(const ControlComparison& c, const std::string& what) {
  print_row(c.bounded > 0 && c.held_15 == c.bounded && c.held_16 == c.bounded,
            "whole body, distance of angles to least squares, " + what,
            "as control says, by equations 15 (0.01 deg) and 16, in every frame that determines all",
            fmt::format("{} and {} of {}; {:.2f} deg RMS, {:.2f} at most", c.held_15, c.held_16, c.bounded,
                        kDegPerRad * c.angle_rms_rad, kDegPerRad * c.angle_max_rad));
}

void whole(const Scene& scene) {
  const auto body =
      studies::study_set(scene.model, scene.landmarks, scene.made, studies::whole_body_set(), true).value();
  check_recorded(body.recorded_fine, "1 ms", 0.5);
  check_recorded(body.recorded_coarse, "1/60 s", 1.0);
  check_reachable(body.reachable_fine, "1 ms", 0.05);
  check_reachable(*body.reachable_coarse, "1/60 s", 1.0);
  check_bounds(body.recorded_fine, "recorded goals, 1 ms");
  check_bounds(body.recorded_coarse, "recorded goals, 1/60 s");
  check_bounds(body.reachable_fine, "made goals, 1 ms");
  check_bounds(*body.reachable_coarse, "made goals, 1/60 s");
}

void sets(const Scene& scene) {
  const auto one =
      studies::study_set(scene.model, scene.landmarks, scene.made, studies::whole_body_set(), false).value();
  const auto three =
      studies::study_set(scene.model, scene.landmarks, scene.made, studies::three_level_set(), true).value();
  const bool whole_ok = !three.recorded_fine.failed() && !three.recorded_coarse.failed() &&
                        !three.reachable_fine.failed() && !three.reachable_coarse->failed();
  print_row(
      whole_ok, "three strict levels, recorded and made goals, 1 ms and 1/60 s",
      "no failure; cost of priority beside one level",
      fmt::format(
          "{:.2f} mm and {:.2f} deg from least squares against {:.2f} mm and {:.2f} deg of one level; "
          "on made goals {:.3f} mm",
          kMillimetres * three.recorded_fine.control_rms_m, kDegPerRad * three.recorded_fine.angle_rms_rad,
          kMillimetres * one.recorded_fine.control_rms_m, kDegPerRad * one.recorded_fine.angle_rms_rad,
          kMillimetres * three.reachable_fine.control_rms_m));
  for (const auto& set : {studies::paper_set(), studies::pelvis_paper_set(), studies::upper_body_set(),
                          studies::upper_body_pelvis_set()}) {
    const auto outcome = studies::study_set(scene.model, scene.landmarks, scene.made, set, false).value();
    const auto& c = outcome.recorded_fine;
    const bool paper = set.name == studies::paper_set().name;
    const bool upper =
        set.name == studies::upper_body_set().name || set.name == studies::upper_body_pelvis_set().name;
    const bool enough = c.determined >= (upper ? 15 : 0);
    const bool rank_ok = !paper || (c.rank_min >= 11 && c.rank_max <= 12);
    print_row(
        !c.failed() && !outcome.reachable_fine.failed() && rank_ok && enough && c.determined < c.coordinates,
        set.name + ", recorded goals, 1 ms",
        paper   ? "no failure, rank 11 or 12 in every frame, undetermined angles marked"
        : upper ? "no failure, rank said, 15 angles or more determined, the others marked"
                : "no failure, rank said, undetermined angles marked",
        fmt::format("{}; rank {} to {} of {}; {} of {} coordinates determined; made goals {:.3f} mm",
                    describe(c), c.rank_min, c.rank_max, c.free_speeds, c.determined, c.coordinates,
                    kMillimetres * outcome.reachable_fine.control_rms_m));
  }
}

/// Runs of five seconds over gains, damping, posture and the time in the recording at the start; the rest
/// pose differs by up to 0.3 rad from the posture there.
void stability(const Scene& scene, const LandmarkSet& set, const std::string& name, int runs, bool limits) {
  constexpr double kOff_rad = 0.3;
  constexpr std::int64_t kLength = 300, kApart = 7;  // frames
  int failures = 0;
  std::string first;
  for (int run = 0; run < runs; ++run) {
    ControlSetting setting;
    setting.omega_rad_s = std::vector{50.0, 100.0, 200.0, 400.0}[static_cast<std::size_t>(run % 4)];
    setting.damping = std::vector{0.1, 0.03, 0.3, 0.05, 0.2}[static_cast<std::size_t>(run / 4 % 5)];
    setting.posture_kp =
        std::vector{25.0, 50.0, 100.0, 200.0, 400.0}[static_cast<std::size_t>(run * 5 / runs)];
    // From a fifth of critical damping to twice as much.
    setting.posture_kd =
        std::vector{2.0, 0.4, 4.0}[static_cast<std::size_t>(run % 3)] * std::sqrt(setting.posture_kp);
    setting.limits = limits;
    setting.first_frame = kApart * run;
    setting.last_frame = setting.first_frame + kLength;
    Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(
        scene.ik.motion.q.data() + scene.ik.motion.index(setting.first_frame, 0),
        static_cast<Eigen::Index>(scene.ik.motion.size()));
    Random random(static_cast<std::uint64_t>(run), 777);
    for (Eigen::Index c = 0; c < rest.size(); ++c)
      if (scene.ik.motion.is_rotation[static_cast<std::size_t>(c)])
        rest[c] += random.uniform(-kOff_rad, kOff_rad);
    const auto tracked = studies::run_control(scene.model, scene.landmarks, set, setting, rest);
    if (tracked && tracked->flagged_frames == 0) continue;
    ++failures;
    if (first.empty())
      first = fmt::format(
          "; the first: omega {}, damping {}, posture {} and {}, from frame {}: {}", setting.omega_rad_s,
          setting.damping, setting.posture_kp, setting.posture_kd, setting.first_frame,
          tracked ? fmt::format("{} frames flagged", tracked->flagged_frames) : tracked.error().message);
  }
  print_row(failures == 0,
            fmt::format("{}{}, {} runs over gains, damping, posture, rest pose and starts, 1 ms", name,
                        limits ? ", limits" : "", runs),
            "no failure", fmt::format("{} failures{}", failures, first));
}

/// accept_studies taichi_control whole | sets | stability [RUNS]
int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("direct marker control of the tai chi recording");
  const Scene scene = prepare(*data);
  const std::string_view part = argc > 1 ? argv[1] : "whole";
  if (part == "whole") whole(scene);
  if (part == "sets") sets(scene);
  if (part == "stability") {
    const int runs = argc > 2 ? std::stoi(argv[2]) : 100;
    stability(scene, studies::whole_body_set(), "whole body, one level", runs, false);
    stability(scene, studies::paper_set(), "the paper's two subsets", runs, false);
    stability(scene, studies::pelvis_paper_set(), "pelvis level, then the paper's two subsets", runs, false);
    stability(scene, studies::whole_body_set(), "whole body, one level", (runs + 3) / 4, true);
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("taichi_control", run_check);

}  // namespace

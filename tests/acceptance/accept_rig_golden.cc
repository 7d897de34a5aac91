// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The simulated rig of 1986 against the values of an independent prototype (rig_golden.json; mm, degrees).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kinemark/camera/noise.h"
#include "kinemark/camera/shares.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/rig_calibration.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using nlohmann::json;
using testing_support::print_row;

/// Largest difference of two lists, relative to `size`.
class Worst {
 public:
  explicit Worst(double size = 1.0) : size_(size) {}
  void compare(double ours, double golden) { worst_ = std::max(worst_, std::abs(ours - golden) / size_); }
  template <class Ours>
  void compare_all(const Ours& ours, const json& golden) {
    if (static_cast<std::size_t>(ours.size()) != golden.size()) worst_ = INFINITY;
    for (std::size_t i = 0; i < std::min<std::size_t>(golden.size(), static_cast<std::size_t>(ours.size()));
         ++i)
      compare(ours[static_cast<Eigen::Index>(i)], golden[i].get<double>());
  }
  void row(const std::string& what, double bound, const std::string& unit) const {
    print_row(worst_ <= bound, what, fmt::format("within {} {}", bound, unit),
              fmt::format("{:.2g} {}", worst_, unit));
  }

 private:
  double size_, worst_ = 0.0;
};

Eigen::Vector3d metres(const json& mm) {
  return 1e-3 * Eigen::Vector3d(mm[0].get<double>(), mm[1].get<double>(), mm[2].get<double>());
}

void random_numbers(const json& golden) {
  Random uniform(golden["seed"], golden["stream"]), gauss(golden["seed"], golden["stream"]);
  int same = 0;
  for (const auto& value : golden["uniform"]) same += uniform.uniform() == value.get<double>();
  print_row(same == 4, "uniform random numbers", "4 of 4 bit for bit", fmt::format("{} of 4", same));
  Worst worst;
  for (const auto& value : golden["gauss"]) worst.compare(gauss.gaussian(), value);
  worst.row("Gaussian random numbers", 4e-16, "");
}

void detector(const json& golden) {
  Worst worst;
  for (const auto& point : golden)
    worst.compare_all(camera::tetra_lateral_shares(point[0][0], point[0][1]).share, point[1]);
  worst.row("tetra-lateral shares at four places", 1e-13, "");
}

void derived(const json& golden) {
  const data::Electronics e;
  const simulation::RigLight light;
  const double diameter = 1e3 * light.focal_length_m / light.f_number;
  const auto relative = [&](const char* what, double ours) {
    const double theirs = golden[what];
    return std::abs(ours - theirs) / theirs;
  };
  const double worst = std::max(
      {relative("slot_us", 1e6 * data::SlotTiming().slot_s(2)),
       relative("A_lens_mm2", M_PI / 4.0 * diameter * diameter),
       relative("B_n_Hz", camera::noise_bandwidth_hz(e)),
       relative("i_n_pA_rtHz", 1e12 * std::sqrt(camera::current_noise_a2_hz(e))),
       relative("sig_amp_nA", 1e9 * e.count_a() * camera::amplifier_noise_counts(e, 0.0)),
       relative("LSB_nA", 1e9 * e.count_a()),
       relative("I0_3m_cos30_uA", 1e6 * simulation::photocurrent_a(light, 3.0, std::cos(M_PI / 6.0), 1.0))});
  print_row(worst <= 1e-14, "slot, lens area, noise, photocurrent", "within 1e-14",
            fmt::format("{:.2g}", worst));
}

void camera_draws(const json& golden, const simulation::PhysicalRig& rig) {
  Worst worst;
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& theirs = golden[c];
    const auto& ours = rig.rig.cameras[c];
    const double half_side_mm = 1e3 * ours.detector.half_side_m;
    for (int i = 0; i < 3; ++i)
      worst.compare_all(Eigen::Vector3d(ours.cam_from_world.rotation.row(i)),
                        theirs["R"][static_cast<std::size_t>(i)]);
    const Eigen::Vector3d centre = ours.centre_in_world() - metres(theirs["C"]);
    worst.compare(centre.norm(), 0.0);
    worst.compare(ours.focal * half_side_mm, theirs["f"]);
    worst.compare_all(Eigen::Vector2d(ours.principal_point * half_side_mm), theirs["pp"]);
    worst.compare(ours.distortion.k1, theirs["k1"]);
    worst.compare(ours.distortion.k2, theirs["k2"]);
    worst.compare(ours.distortion.p1, theirs["p"][0]);
    worst.compare(ours.distortion.p2, theirs["p"][1]);
    for (std::size_t n = 0; n < theirs["warp"].size(); ++n) {
      worst.compare(ours.detector.warp_x.at(n), theirs["warp"][n][0]);
      worst.compare(ours.detector.warp_y.at(n), theirs["warp"][n][1]);
    }
    worst.compare_all(ours.detector.gain, theirs["gain"]);
    worst.compare_all(ours.detector.offset_counts, theirs["off"]);
    worst.compare(rig.room[c].flicker_phase_rad, theirs["flick_phase"]);
  }
  worst.row("camera draws of seed 1", 1e-13, "");
}

void expected_counts(const json& golden, const simulation::PhysicalRig& rig) {
  Worst worst(1000.0);
  for (const auto& point : golden)
    for (int c = 0; c < 2; ++c)
      worst.compare_all(simulation::expected_counts(rig, c, {.x_in_world = metres(point["P"])}).counts,
                        point["counts"][static_cast<std::size_t>(c)]);
  worst.row("expected counts of three points", 1e-13, "of 1000 counts");
}

simulation::RigRecording recorded(const simulation::PhysicalRig& rig, const simulation::RigScene& scene,
                                  std::int64_t frames, std::uint64_t stream, int threads = 1) {
  return simulation::record(rig, scene,
                            {.frames = frames, .seed = rig.seed, .stream = stream, .threads = threads})
      .value();
}

/// Counts of one frame, [led][camera][channel], that differ.
int different(const data::Counts& ours, std::int64_t frame, const json& golden) {
  int out = 0;
  for (std::int64_t l = 0; l < ours.led_count(); ++l)
    for (std::int64_t c = 0; c < 2; ++c)
      for (int k = 0; k < 4; ++k)
        out += ours.at(frame, l, c)[k] !=
               golden[static_cast<std::size_t>(l)][static_cast<std::size_t>(c)][static_cast<std::size_t>(k)]
                   .get<double>();
  return out;
}

void exact(const std::string& what, int wrong, int of) {
  print_row(wrong == 0, what, fmt::format("{} of {} the same", of, of),
            fmt::format("{} of {}", of - wrong, of));
}

void recordings(const json& golden, const simulation::PhysicalRig& rig) {
  const auto& pose = simulation::tree_test_poses()[3];
  Worst positions;
  for (int l = 0; l < 3; ++l)
    positions.compare(
        (pose.leds_in_world().col(l) - metres(golden["tree_pose3_points"][static_cast<std::size_t>(l)]))
            .norm(),
        0.0);
  positions.row("tree pose 3", 1e-15, "m");
  exact("tree pose 3, counts",
        different(recorded(rig, simulation::still_tree(pose), 3, 303).counts, 0,
                  golden["tree_pose3_raw_first_frame_of_3"]),
        24);
  const auto wheel = recorded(rig, simulation::rotating_wheel(), 220, 400).counts;
  exact("wheel, counts of two frames",
        different(wheel, 0, golden["wheel0_raw_frames_0_1"][0]) +
            different(wheel, 1, golden["wheel0_raw_frames_0_1"][1]),
        16);
  const auto& asl = golden["asl"];
  const auto scene = simulation::signing_arm();
  Worst path;
  for (int l = 0; l < 4; ++l)
    path.compare(
        (scene.led(l, 0.37).x_in_world - metres(asl["pos_t0_37"][static_cast<std::size_t>(l)])).norm(), 0.0);
  path.row("sign, places at 0.37 s", 1e-14, "m");
  const auto sign = recorded(rig, scene, 400, 420);
  exact("sign, counts", different(sign.counts, 0, asl["raw_frame_0"]), 32);
  Worst times;
  for (int k = 0; k < 8; ++k)
    times.compare(sign.counts.offset_s(3, k / 4)[k % 4],
                  asl["t_conv_frame0_led3"][static_cast<std::size_t>(k)]);
  times.row("sign, times of conversions", 1e-17, "s");
  const auto parallel = recorded(rig, scene, 400, 420, 4);
  print_row(parallel.counts.counts == sign.counts.counts, "sign, four threads", "the same bits",
            parallel.counts.counts == sign.counts.counts ? "the same" : "different");
}

void grid(const json& golden, const simulation::PhysicalRig& rig) {
  const auto recorded = simulation::record_grid(rig).value();
  const auto& counts = recorded.counts[0];
  Worst worst;
  for (const auto& [name, mean] : golden.items()) {
    const auto comma = name.find(',');
    const int i = std::stoi(name.substr(5)), j = std::stoi(name.substr(comma + 1));
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::int64_t f = 0; f < counts.frames(); ++f) sum += counts.at(f, i * recorded.nodes + j, 0);
    worst.compare_all(Eigen::Vector4d(sum / static_cast<double>(counts.frames())), mean);
  }
  worst.row("grid before camera A, mean counts of three LEDs", 1e-12, "counts");
}

/// The study's scenes stay on both sheets for all its rigs, so that nothing depends on what lies beyond.
void scenes_in_sight() {
  int off = 0, observations = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto rig = simulation::draw_rig({.seed = seed}).value();
    const auto check_scene = [&](const simulation::RigScene& scene, std::int64_t frames) {
      const auto hidden = recorded(rig, scene, frames, 1).hidden;
      observations += static_cast<int>(hidden.size());
      off += static_cast<int>(std::ranges::count_if(
          hidden, [](std::uint8_t why) { return (why & simulation::kHiddenOffSheet) != 0; }));
    };
    for (const auto& pose : simulation::tree_test_poses()) check_scene(simulation::still_tree(pose), 1);
    for (const double rotated : {8.0, 35.0})
      check_scene(simulation::rotating_wheel({.rotation_deg = rotated}), 67);
    check_scene(simulation::signing_arm(), 400);
  }
  print_row(off == 0, "study scenes, ten rigs, off the sheet", "none",
            fmt::format("{} of {}", off, observations));
}

int run_check(int /*argc*/, char** /*argv*/) {
  std::ifstream file(testing_support::project_folder() / "tests/acceptance/rig_golden.json");
  const json golden = json::parse(file);
  const auto rig = simulation::draw_rig({.seed = 1}).value();
  random_numbers(golden["prng"]);
  detector(golden["fractions(+x,-x,+y,-y)"]);
  derived(golden["derived"]);
  camera_draws(golden["rig_seed1"], rig);
  expected_counts(golden["expect_counts_seed1"], rig);
  recordings(golden, rig);
  grid(golden["grid_cam0_mean_counts"], rig);
  scenes_in_sight();
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("rig_golden", run_check);

}  // namespace

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/simulate/simulate_rig_job.h"

namespace kinemark::cli {
namespace {

struct RigArguments {
  pipeline::SimulateRigJob job;
  std::string scene = "sign", detector = "tetra-lateral";
  std::vector<std::string> intensity;
  double conversion_us = 48.0;
  bool glint = false, z_is_up = false, keep_position = false, no_noise = false;
};

/// "0.5" for all LEDs or "hand=0.5" for one.
Status add_intensity(const std::string& text, pipeline::SimulateRigJob& job) {
  const auto equals = text.rfind('=');
  const std::string name = equals == std::string::npos ? "" : text.substr(0, equals);
  const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size())
    return fail(Code::usage, fmt::format("--intensity: '{}' is neither a number nor LED=NUMBER", text));
  job.intensity.emplace_back(name, value);
  return {};
}

Status complete(RigArguments& arguments) {
  auto& job = arguments.job;
  const auto scene = pipeline::parse_rig_scene(arguments.scene);
  if (!scene) return std::unexpected(scene.error());
  job.scene = *scene;
  const auto detector = data::parse_detector_kind(arguments.detector);
  if (!detector) return fail(Code::usage, detector.error().message);
  job.rig.detector = *detector;
  job.rig.conversion_s = arguments.conversion_us / 1e6;
  job.recording.noise = !arguments.no_noise;
  job.wheel.glint_share = arguments.glint ? 0.04 : 0.0;
  job.marker_options.z_is_up = arguments.z_is_up;
  job.marker_options.centred = !arguments.keep_position;
  for (const auto& text : arguments.intensity)
    if (auto s = add_intensity(text, job); !s) return s;
  return {};
}

int run_rig(const CommonOptions& common, RigArguments& arguments) {
  if (auto s = complete(arguments); !s) return report_error(s.error());
  return run_job(common, "files", arguments.job, pipeline::run_simulate_rig, print_written);
}

void add_scene_options(CLI::App& rig, RigArguments& arguments) {
  auto& job = arguments.job;
  rig.add_option("scene", arguments.scene, "tree, wheel, sign or markers")->capture_default_str();
  rig.add_option("--pose", job.tree_pose, "tree: place, 0 to 9")->capture_default_str();
  rig.add_option("--turned", job.wheel.rotation_deg, "wheel: about the vertical, degrees")
      ->capture_default_str();
  rig.add_option("--leds", job.wheel.leds, "wheel: LEDs on the rim, 1 to 8")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  rig.add_flag("--glint", arguments.glint, "wheel: its frame mirrors 4 % of the light at one angle");
  rig.add_option("-t,--markers", job.markers, "markers: .c3d, .trc or .csv whose markers are LEDs");
  rig.add_option("--marker", job.marker_options.markers, "markers: use this one; repeat for up to 8")
      ->allow_extra_args(false);
  rig.add_flag("--z-up", arguments.z_is_up, "markers: the laboratory's Z points up, not its Y");
  rig.add_flag("--keep-place", arguments.keep_position, "markers: do not move them to the middle of the rig");
}

void add_recording_options(CLI::App& rig, RigArguments& arguments) {
  auto& job = arguments.job;
  rig.add_option("--rate", job.recording.rate_hz, "Frames per second")->capture_default_str();
  rig.add_flag("--highest-rate", job.highest_rate, "As many frames per second as the LEDs leave room for");
  rig.add_option("--duration", job.duration_s, "Length, s; the scene's own when absent");
  rig.add_option("--intensity", arguments.intensity,
                 "Relative light: 0.5 for all LEDs, hand=0.5 for one; repeat")
      ->allow_extra_args(false);
  rig.add_option("--occlude", job.occlusions,
                 "Hide an LED: LED:CAMERA:FIRST-LAST, either may be 'all'; repeat")
      ->allow_extra_args(false);
  rig.add_flag("--dark-slot", job.rig.dark_slot, "One more slot in which no LED shines");
  rig.add_flag("--no-noise", arguments.no_noise, "No noise of amplifiers and converter");
}

void add_rig_options(CLI::App& rig, RigArguments& arguments) {
  auto& job = arguments.job;
  rig.add_option("--detector", arguments.detector, "tetra-lateral, duo-lateral or pin-cushion")
      ->capture_default_str();
  rig.add_option("--imperfection", job.rig.imperfection,
                 "Times the tolerances of lenses, sheets and amplifiers")
      ->capture_default_str();
  rig.add_option("--misalignment", job.rig.misalignment, "Times the errors of poses set by hand")
      ->capture_default_str();
  rig.add_option("--crosstalk", job.rig.crosstalk, "Share of the currents that strays to other electrodes")
      ->capture_default_str();
  rig.add_option("--ripple", job.rig.ripple, "Fine unevenness of the sheet, half-sides")
      ->capture_default_str();
  rig.add_option("--bits", job.rig.bits, "Of the converter, 8 to 14")->capture_default_str();
  rig.add_option("--conversion", arguments.conversion_us, "Time of one conversion, us")
      ->capture_default_str();
  rig.add_flag("--grid", job.grid, "Also record the calibration grid");
  rig.add_flag("--tree-poses", job.tree_poses, "Also record 300 poses of the orientation tree");
  rig.add_flag("--scan", job.scan, "Also record an LED on a motor stage");
}

}  // namespace

void add_simulate_rig(CLI::App& simulate, const CommonOptions& common, Run& run) {
  auto* rig =
      simulate.add_subcommand("rig", "Two lateral-effect cameras and pulsed LEDs: counts, and the truth");
  rig->footer(
      "Writes recording.mcap, truth.trc, truth_derivatives.sto, rig_true.toml and rig_nominal.toml into the "
      "folder;\nwith --grid, --tree-poses and --scan also grid_A.mcap, grid_B.mcap, tree_poses.mcap and "
      "scan.mcap. "
      "The\nseed draws the rig and its noise.");
  const auto arguments = std::make_shared<RigArguments>();
  rig->add_option("-o,--out", arguments->job.folder, "Folder to write into; made when absent")->required();
  add_scene_options(*rig, *arguments);
  add_recording_options(*rig, *arguments);
  add_rig_options(*rig, *arguments);
  rig->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_rig(common, *arguments); }; });
}

}  // namespace kinemark::cli

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/orientation_options.h"

#include <fmt/core.h>

#include <cmath>

#include "cli/console.h"
#include "cli/motion_arguments.h"
#include "kinemark/core/units.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::cli {
namespace {

Result<motion::FacingAxis> facing_of(const std::string& text) {
  const auto colon = text.rfind(':');
  const auto axis = workflow::parse_axis(colon == std::string::npos ? "" : text.substr(colon + 1));
  if (!axis || colon == 0)
    return fail(Code::usage, fmt::format("--heading: '{}' is not SENSOR:AXIS, such as pelvis_imu:-z", text));
  return motion::FacingAxis{.sensor = text.substr(0, colon), .axis = *axis};
}

/// What the options say of sensors, whether or not there are markers.
Status apply(const OrientationArguments& a, pipeline::SensorSettings& settings) {
  settings.max_rms_rad = a.max_rms_deg / kDegPerRad;
  auto& options = settings.options;
  options.noise_sd_rad = a.noise_deg / kDegPerRad;
  for (const auto& text : a.sensors) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return fail(Code::usage, fmt::format("--sensor: '{}' is not SENSOR=BODY", text));
    options.sensors.push_back({.sensor = text.substr(0, equals), .body = text.substr(equals + 1)});
  }
  if (a.heading.empty()) return {};
  const auto facing = facing_of(a.heading);
  if (!facing) return std::unexpected(facing.error());
  options.facing = *facing;
  return {};
}

std::string noise_text(const motion::OrientationFit& fit) {
  return std::isnan(fit.noise_sd_rad)
             ? std::string("not known")
             : fmt::format("{:.2f} deg about each axis", kDegPerRad * fit.noise_sd_rad);
}

std::string heading_text(const motion::OrientationFit& fit) {
  const double deg = kDegPerRad * fit.heading_rad;
  if (fit.heading_source == motion::HeadingSource::model)
    return "Sensors as the model places them, angles in the heading of their world";
  if (fit.heading_source == motion::HeadingSource::facing)
    return fmt::format("Heading {:.1f} deg, by the axis that faces forward", deg);
  return fmt::format(
      "Heading {:.1f} deg (SD {:.1f}), estimated from {}", deg, kDegPerRad * fit.heading_sd_rad,
      fit.heading_source == motion::HeadingSource::markers ? "markers and sensors" : "the motion");
}

void print_orientations(const CommonOptions& common, const pipeline::OrientationOutcome& outcome) {
  const auto& [motion, errors, fit, seconds] = outcome.result;
  std::size_t determined = 0;
  for (const auto one : motion.determined) determined += one != 0;
  say(common,
      fmt::format("{} frames at {:g} Hz, {} sensors, {} coordinates; solved in {:.3f} s ({:.0f} frames/s).",
                  motion.frames(), motion.time.rate_hz, fit.sensors.size(), motion.size(), seconds,
                  static_cast<double>(motion.frames()) / seconds));
  say(common,
      fmt::format(
          "Orientation error {:.2f} deg RMS, {:.1f} deg at most; {:.1f} % of the coordinates determined.",
          kDegPerRad * fit.rms_rad, kDegPerRad * fit.max_rad,
          motion.determined.empty()
              ? 0.0
              : 100.0 * static_cast<double>(determined) / static_cast<double>(motion.determined.size())));
  say(common, fmt::format("{}; noise of an orientation {}.", heading_text(fit), noise_text(fit)));
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::orientation_json(outcome)) + "\n");
}

}  // namespace

Status add_sensors(const OrientationArguments& a, pipeline::IkJob& job) {
  job.sensors = a.job;
  return apply(a, job.sensors);
}

void say_sensors(const CommonOptions& common, const motion::OrientationFit& fit) {
  std::size_t by_markers = 0;
  for (const auto& sensor : fit.sensors) by_markers += sensor.placed_by == motion::SensorPlacement::markers;
  say(common,
      fmt::format("{} sensors, {} placed by markers, {} by {}; orientation error {:.2f} deg RMS, {:.1f} "
                  "deg at most.",
                  fit.sensors.size(), by_markers, fit.sensors.size() - by_markers,
                  fit.sensors.empty() || fit.sensors.front().placed_by != motion::SensorPlacement::model
                      ? "the pose"
                      : "the model",
                  kDegPerRad * fit.rms_rad, kDegPerRad * fit.max_rad));
  say(common, fmt::format("{}; noise of an orientation {}.", heading_text(fit), noise_text(fit)));
}

void add_orientation_options(CLI::App& command, OrientationArguments& a) {
  const auto add = [&](const char* name, auto& value, const char* text) {
    return command.add_option(name, value, text)->group("Orientations");
  };
  add("--orientations", a.job.orientations,
      "Orientations of inertial sensors, in place of markers or beside them: .sto of quaternions as "
      "OpenSense has it, .c3d with rotations as of Theia, rigid bodies of QTM (.tsv) or Motive (.csv)");
  add("--calibration", a.job.pose,
      "The same sensors in the model's default pose, .sto: how they stand on the bodies; when absent, as "
      "frames of the model say (OpenSense), else as markers say, else as in the first frame that has all of "
      "them");
  add("--sensor", a.sensors,
      "The body that carries a sensor, SENSOR=BODY; others by name: tibia_r_imu. Repeatable.");
  add("--sensors-up", a.job.up,
      "Axis of the sensors' world that points up; when absent, that of --up without markers, of the model "
      "beside them");
  add("--heading", a.heading,
      "The axis of a sensor that faces forward in the pose, pelvis_imu:-z; when absent, the heading is "
      "estimated from markers and motion");
  add("--orientation-noise", a.noise_deg, "Noise about each axis, deg; 0 estimates it from the residuals")
      ->capture_default_str();
  add("--max-orientation-rms", a.max_rms_deg, "Gate: RMS angle between sensors and model, deg")
      ->capture_default_str();
}

int run_orientation_command(const CommonOptions& common, OrientationArguments& a,
                            const pipeline::IkJob& markers) {
  auto& job = a.job;
  job.model = markers.model;
  job.output = markers.output.empty() ? motion_beside({job.orientations}) : markers.output;
  job.report = markers.report;
  job.geometry = markers.geometry;
  if (job.up.empty()) job.up = markers.axes.up;
  if (auto s = apply(a, job); !s) return report_error(s.error());
  auto& options = job.options;
  options.limits = markers.options.limits;
  options.judge_samples = markers.drops_doubtful(options.judge_samples);
  options.error_bars = markers.options.error_bars;
  if (std::isfinite(markers.selection.first_time_s)) options.first_time_s = markers.selection.first_time_s;
  if (std::isfinite(markers.selection.last_time_s)) options.last_time_s = markers.selection.last_time_s;
  return run_job(common, "frames", job, pipeline::run_orientations, print_orientations);
}

}  // namespace kinemark::cli

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/internal/sensor_run.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/markers/orientation_file.h"
#include "kinemark/io/osim/offset_frames.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::pipeline::internal {
namespace {

using Json = nlohmann::ordered_json;
using motion::HeadingSource;
using motion::OrientationFit;
using motion::SensorPlacement;

constexpr std::size_t kNamed = 12;
constexpr double kMostDrift_rad = 5.0 / kDegPerRad;  // quiet standing sways by one or two degrees

Result<data::Orientations> read_one(const char* role, const std::filesystem::path& path,
                                    std::vector<data::InputFile>& inputs,
                                    std::vector<std::string>& warnings) {
  auto sensors = io::read_orientation_file(path);
  if (!sensors) return sensors;
  for (const auto& warning : sensors->warnings)
    warnings.push_back(fmt::format("{}: {}", path.filename().string(), warning));
  auto file = io::record_input(role, path);
  if (!file) return std::unexpected(file.error());
  inputs.push_back(std::move(*file));
  return sensors;
}

/// Sensors that the model has a frame for, as IMUPlacer adds them, where neither a pose nor a body is given.
Status place_by_model(const std::filesystem::path& model_file, const model::Model& model,
                      const SensorSettings& settings, workflow::SensorInputs& sensors) {
  if (!settings.pose.empty() || !settings.options.sensors.empty()) return {};
  const auto frames = io::read_offset_frames(model_file, model.description(), sensors.recording.names);
  if (!frames) return std::unexpected(frames.error());
  auto& placed = sensors.options.placed;
  for (const auto& frame : *frames)
    placed.push_back({.sensor = frame.name,
                      .body = model.description().bodies[at(frame.body_idx)].name,
                      .body_from_sensor = frame.body_from_frame.rotation});
  if (!placed.empty() && settings.options.facing)
    return fail(Code::usage,
                "--heading is for sensors that a pose places; the model has frames for them, and "
                "--calibration would take their place");
  return {};
}

/// NaN is null in JSON.
Json degrees(double rad) { return std::isnan(rad) ? Json(nullptr) : Json(kDegPerRad * rad); }

const char* name_of(HeadingSource source) {
  constexpr std::array kNames{"motion", "model", "facing axis", "markers"};
  return kNames[static_cast<std::size_t>(source)];
}

const char* name_of(SensorPlacement placement) {
  constexpr std::array kNames{"pose", "model", "markers"};
  return kNames[static_cast<std::size_t>(placement)];
}

/// "0.52 s", "0.52 to 0.58 s"
std::string span_text(const motion::RejectedOrientations& span) {
  return span.first_frame == span.last_frame ? fmt::format("{:.2f} s", span.first_s)
                                             : fmt::format("{:.2f} to {:.2f} s", span.first_s, span.last_s);
}

/// A sentence for each sensor of which samples were left out, in the recording or in the pose.
std::vector<std::string> rejected_sentences(const OrientationFit& fit) {
  std::vector<std::string> out;
  for (const auto& sensor : fit.sensors)
    for (const bool in_pose : {false, true}) {
      std::vector<std::string> spans;
      std::int64_t samples = 0;
      double largest = 0.0;
      for (const auto& span : fit.rejected) {
        if (span.sensor != sensor.name || span.in_pose != in_pose) continue;
        spans.push_back(span_text(span));
        samples += span.samples();
        largest = std::max(largest, span.angle_rad);
      }
      if (spans.empty()) continue;
      out.push_back(
          fmt::format("sensor '{}'{} is turned by up to {:.0f} deg against the samples before and after: {} "
                      "left out, at {}",
                      sensor.name, in_pose ? ", in the pose," : "", kDegPerRad * largest,
                      samples == 1 ? std::string("1 sample") : fmt::format("{} samples", samples),
                      join_some(spans, kNamed)));
    }
  return out;
}

std::int64_t count_placed(const OrientationFit& fit, SensorPlacement by) {
  return std::ranges::count(fit.sensors, by, &motion::FittedSensor::placed_by);
}

}  // namespace

Status check_up(SensorSettings& settings, const char* option) {
  if (settings.up.empty()) return {};
  const auto up = workflow::parse_axis(settings.up);
  if (!up) return fail(Code::usage, fmt::format("{}: {}", option, up.error().message));
  settings.options.up_in_world = *up;
  return {};
}

Result<workflow::SensorInputs> read_sensors(const SensorSettings& settings,
                                            const std::filesystem::path& model_file,
                                            const model::Model& model, std::vector<data::InputFile>& inputs,
                                            std::vector<std::string>& warnings) {
  workflow::SensorInputs out{.recording = {}, .pose = {}, .options = settings.options};
  auto recording = read_one("orientations", settings.orientations, inputs, warnings);
  if (!recording) return std::unexpected(recording.error());
  out.recording = std::move(*recording);
  if (!settings.pose.empty()) {
    auto pose = read_one("pose", settings.pose, inputs, warnings);
    if (!pose) return std::unexpected(pose.error());
    out.pose = std::move(*pose);
  }
  if (auto s = place_by_model(model_file, model, settings, out); !s) return std::unexpected(s.error());
  return out;
}

workflow::Remarks sensor_remarks(const OrientationFit& fit, const SensorSettings& settings, bool error_bars,
                                 bool beside_markers) {
  workflow::Remarks out;
  if (!fit.left_out.empty())
    out.warnings.push_back(fmt::format("no body carries these sensors, which are not used: {}",
                                       join_some(fit.left_out, kNamed)));
  if (!fit.never_seen.empty())
    out.warnings.push_back(fmt::format("no frame that is solved has an orientation of these sensors: {}",
                                       join_some(fit.never_seen, kNamed)));
  if (!fit.unplaced.empty())
    out.warnings.push_back(
        fmt::format("markers do not determine the bodies of these sensors, which are not used; --calibration "
                    "would say how they stand there: {}",
                    join_some(fit.unplaced, kNamed)));
  std::ranges::move(rejected_sentences(fit), std::back_inserter(out.warnings));
  if (error_bars && std::isnan(fit.noise_sd_rad))
    out.warnings.emplace_back(
        "the sensors measure no more than is solved for, so that their noise does not show and the angles "
        "have no error bars; --orientation-noise states it");
  const auto gate = [&](const char* name, double rad, double bound_rad, const std::string& what,
                        const std::string& advice) {
    const double value = kDegPerRad * rad, bound = kDegPerRad * bound_rad;
    const bool passed = value <= bound;
    out.gates.push_back(
        {.name = name,
         .passed = passed,
         .value = value,
         .bound = bound,
         .unit = "deg",
         .sentence = fmt::format("{} {:.2f} deg, {} {:g}{}", what, value, passed ? "within" : "above", bound,
                                 passed ? "" : "; " + advice)});
    if (!passed) out.warnings.push_back(out.gates.back().sentence);
  };
  gate("orientation_rms", fit.rms_rad, settings.max_rms_rad, "RMS angle between sensors and model",
       fmt::format("is the pose that places the sensors the model's default, and {} the sensors' vertical?",
                   beside_markers ? "--sensors-up" : "--up"));
  if (count_placed(fit, SensorPlacement::pose) == 0) return out;
  const bool has_pose = !settings.pose.empty();
  gate("pose_drift", fit.pose_drift_rad, kMostDrift_rad,
       has_pose ? "a sensor turns within the pose that places the sensors by"
                : "a sensor turns in the first half second, whose first frame is taken for the "
                  "model's default pose, by",
       has_pose ? "give one in which the subject stands still"
                : "give a recording of that pose, --calibration");
  return out;
}

std::vector<std::pair<std::string, std::string>> sensor_facts(const OrientationFit& fit,
                                                              const SensorSettings& settings) {
  const auto by = [&](SensorPlacement placement) { return count_placed(fit, placement); };
  const double heading = kDegPerRad * fit.heading_rad;
  return {
      {"orientations",
       fmt::format(
           "{}: {} sensors, how they stand on bodies said by markers for {}, by a pose for {}, by the "
           "model for {}",
           settings.orientations.filename().string(), fit.sensors.size(), by(SensorPlacement::markers),
           by(SensorPlacement::pose), by(SensorPlacement::model))},
      {"heading of the sensors",
       fit.heading_source == HeadingSource::facing
           ? fmt::format("{:.1f} deg, given", heading)
           : fmt::format("{:.1f} deg, SD {:.2f}, estimated ({})", heading, kDegPerRad * fit.heading_sd_rad,
                         name_of(fit.heading_source))},
      {"noise of an orientation",
       std::isnan(fit.noise_sd_rad)
           ? std::string("not known")
           : fmt::format("{:.2f} deg about each axis, {}", kDegPerRad * fit.noise_sd_rad,
                         settings.options.noise_sd_rad > 0.0 ? "given" : "estimated from the residuals")},
      {"turned samples of sensors", settings.options.judge_samples ? "left out" : "kept"},
      {"angle between sensors and model", fmt::format("{:.2f} deg RMS, {:.1f} deg at most",
                                                      kDegPerRad * fit.rms_rad, kDegPerRad * fit.max_rad)}};
}

data::Table orientation_errors_table(const TimeBase& time, const OrientationFit& fit,
                                     const Array<double>& error_rad) {
  data::Table table;
  table.name = "Orientation errors";
  table.in_degrees = true;
  for (const auto& sensor : fit.sensors) table.columns.push_back(sensor.name);
  for (std::int64_t f = 0; f < time.frames; ++f) table.time_s.push_back(time.time_s(f));
  for (const double error : error_rad) table.values.push_back(kDegPerRad * error);
  return table;
}

report::ReportSensors page_sensors(const TimeBase& time, const OrientationFit& fit,
                                   const Array<double>& error_rad) {
  report::ReportSensors out{.rows = {},
                            .error_rad = error_rad,
                            .state = {},
                            .heading_rad = fit.heading_rad,
                            .heading_sd_rad = fit.heading_sd_rad,
                            .heading_from = name_of(fit.heading_source),
                            .pose_drift_rad = fit.pose_drift_rad,
                            .noise_sd_rad = fit.noise_sd_rad};
  for (const double error : error_rad)
    out.state.push_back(std::isnan(error) ? data::SampleState::missing : data::SampleState::measured);
  const auto S = fit.sensors.size();
  for (std::size_t s = 0; s < S; ++s) {
    const auto& sensor = fit.sensors[s];
    auto& row = out.rows.emplace_back(
        report::SensorRow{.name = sensor.name, .body = sensor.body, .placed_by = name_of(sensor.placed_by)});
    for (const auto& span : fit.rejected) {
      if (span.in_pose || span.sensor != sensor.name) continue;
      row.rejected_samples += span.samples();
      const double slack = 0.5 / time.rate_hz;
      for (std::int64_t f = 0; f < time.frames; ++f)
        if (time.time_s(f) > span.first_s - slack && time.time_s(f) < span.last_s + slack)
          out.state[at(f) * S + s] = data::SampleState::rejected;
    }
  }
  return out;
}

Json sensors_json(const OrientationFit& fit) {
  auto sensors = Json::array();
  for (const auto& sensor : fit.sensors) {
    const Eigen::Quaterniond q(sensor.body_from_sensor);
    sensors.push_back({{"name", sensor.name},
                       {"body", sensor.body},
                       {"seen", sensor.seen},
                       {"rms_deg", degrees(sensor.rms_rad)},
                       {"max_deg", degrees(sensor.max_rad)},
                       {"placed_by", name_of(sensor.placed_by)},
                       {"body_from_sensor", {q.w(), q.x(), q.y(), q.z()}}});
  }
  auto rejected = Json::array();
  std::int64_t samples = 0;
  for (const auto& span : fit.rejected) {
    samples += span.in_pose ? 0 : span.samples();
    rejected.push_back({{"sensor", span.sensor},
                        {"in", span.in_pose ? "pose" : "recording"},
                        {"first_frame", span.first_frame},
                        {"last_frame", span.last_frame},
                        {"first_time_s", span.first_s},
                        {"last_time_s", span.last_s},
                        {"turned_deg", degrees(span.angle_rad)}});
  }
  return {{"sensors", sensors},
          {"rejected_samples", samples},
          {"rejected", rejected},
          {"heading",
           {{"deg", degrees(fit.heading_rad)},
            {"sd_deg", degrees(fit.heading_sd_rad)},
            {"from", name_of(fit.heading_source)}}},
          {"pose_drift_deg", degrees(fit.pose_drift_rad)},
          {"noise_sd_deg", degrees(fit.noise_sd_rad)},
          {"rms_deg", degrees(fit.rms_rad)},
          {"max_deg", degrees(fit.max_rad)}};
}

}  // namespace kinemark::pipeline::internal

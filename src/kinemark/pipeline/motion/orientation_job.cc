// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/orientation_job.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/core/version.h"
#include "kinemark/io/c3d/rotations.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/osim/offset_frames.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/orientation_table.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/staging.h"
#include "kinemark/stages/report/inputs_json.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;
using motion::OrientationFit;
using motion::OrientationResult;

constexpr std::size_t kNamed = 12;
constexpr double kMostDrift_rad = 5.0 / kDegPerRad;  // quiet standing sways by one or two degrees

Status check(const OrientationJob& job) {
  if (job.model.empty()) return fail(Code::usage, "no model; give --model");
  if (job.orientations.empty()) return fail(Code::usage, "no orientations; give --orientations");
  if (job.output.empty()) return fail(Code::usage, "no output; give --output");
  return check_ending(job.output, {".mot", ".sto"}, "joint angles are");
}

Status record(const char* role, const std::filesystem::path& path, OrientationOutcome& outcome) {
  auto file = io::record_input(role, path);
  if (!file) return std::unexpected(file.error());
  outcome.inputs.push_back(std::move(*file));
  return {};
}

Result<model::Model> read_model(const std::filesystem::path& path, OrientationOutcome& outcome) {
  auto description = io::read_osim(path);
  if (!description) return std::unexpected(description.error());
  outcome.model = description->name;
  outcome.warnings = description->warnings;
  auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(path.string(), model.error());
  if (auto s = record("model", path, outcome); !s) return std::unexpected(s.error());
  return model;
}

Result<data::Orientations> read_sensors(const char* role, const std::filesystem::path& path,
                                        OrientationOutcome& outcome) {
  auto sensors = ending_of(path) == ".c3d" ? io::read_c3d_rotations(path) : io::read_orientations(path);
  if (!sensors) return sensors;
  for (const auto& warning : sensors->warnings)
    outcome.warnings.push_back(fmt::format("{}: {}", path.filename().string(), warning));
  if (auto s = record(role, path, outcome); !s) return std::unexpected(s.error());
  return sensors;
}

/// Sensors that the model has a frame for, as IMUPlacer adds them, where neither a pose nor a body is given.
Status place_by_model(const model::Model& model, const data::Orientations& recording, OrientationJob& job) {
  if (!job.pose.empty() || !job.options.sensors.empty()) return {};
  const auto frames = io::read_offset_frames(job.model, model.description(), recording.names);
  if (!frames) return std::unexpected(frames.error());
  for (const auto& frame : *frames)
    job.options.placed.push_back({.sensor = frame.name,
                                  .body = model.description().bodies[at(frame.body_idx)].name,
                                  .body_from_sensor = frame.body_from_frame.rotation});
  if (!job.options.placed.empty() && job.options.facing)
    return fail(Code::usage,
                "--heading is for sensors that a pose places; the model has frames for them, and "
                "--calibration would take their place");
  return {};
}

data::Table errors_table(const OrientationResult& result) {
  data::Table table;
  table.name = "Orientation errors";
  table.in_degrees = true;
  for (const auto& sensor : result.fit.sensors) table.columns.push_back(sensor.name);
  for (std::int64_t f = 0; f < result.motion.frames(); ++f)
    table.time_s.push_back(result.motion.time.time_s(f));
  for (const double error : result.error_rad) table.values.push_back(kDegPerRad * error);
  return table;
}

void judge(const OrientationJob& job, OrientationOutcome& outcome) {
  const auto& fit = outcome.result.fit;
  if (!fit.left_out.empty())
    outcome.warnings.push_back(fmt::format("no body carries these sensors, which are not used: {}",
                                           join_some(fit.left_out, kNamed)));
  if (!fit.never_seen.empty())
    outcome.warnings.push_back(fmt::format("no frame that is solved has an orientation of these sensors: {}",
                                           join_some(fit.never_seen, kNamed)));
  if (job.options.error_bars && std::isnan(fit.noise_sd_rad))
    outcome.warnings.emplace_back(
        "the sensors measure no more than is solved for, so that their noise does not show and the angles "
        "have no error bars; --orientation-noise states it");
  const auto gate = [&](const char* name, double rad, double bound_rad, const std::string& what,
                        const std::string& advice) {
    const double value = kDegPerRad * rad, bound = kDegPerRad * bound_rad;
    const bool passed = value <= bound;
    outcome.gates.push_back(
        {.name = name,
         .passed = passed,
         .value = value,
         .bound = bound,
         .unit = "deg",
         .sentence = fmt::format("{} {:.2f} deg, {} {:g}{}", what, value, passed ? "within" : "above", bound,
                                 passed ? "" : "; " + advice)});
    if (!passed) outcome.warnings.push_back(outcome.gates.back().sentence);
  };
  gate("orientation_rms", fit.rms_rad, job.max_rms_rad, "RMS angle between sensors and model",
       "is the pose that places the sensors the model's default, and --up the sensors' vertical?");
  if (fit.heading_source == motion::HeadingSource::model) return;
  gate("pose_drift", fit.pose_drift_rad, kMostDrift_rad,
       job.pose.empty() ? "a sensor turns in the first half second, whose first frame is taken for the "
                          "model's default pose, by"
                        : "a sensor turns within the pose that places the sensors by",
       job.pose.empty() ? "give a recording of that pose, --calibration"
                        : "give one in which the subject stands still");
}

std::string set_of(const OrientationJob& job, const OrientationOutcome& outcome) {
  const auto& [motion, errors, fit, seconds] = outcome.result;
  SetDigest digest;
  digest.add("orientations").add(kVersion).add(outcome.inputs).add(job.up);
  digest.add(coordinates_table(motion))
      .add(std::span<const double>(motion.q_sd))
      .add(std::span<const double>(errors));
  digest.add(std::array{fit.heading_rad, fit.heading_sd_rad, fit.noise_sd_rad, job.max_rms_rad});
  return digest.hex();
}

Status write(const OrientationJob& job, Staging& staging, OrientationOutcome& outcome) {
  const auto& result = outcome.result;
  std::vector<ResultFile> files;
  files.push_back(table_file(job.output, [&] { return coordinates_table(result.motion); }));
  if (job.options.error_bars)
    files.push_back(
        table_file(beside(job.output, "_sd.sto"), [&] { return deviations_table(result.motion); }));
  files.push_back(
      table_file(beside(job.output, "_orientation_errors.sto"), [&] { return errors_table(result); }));
  files.push_back(json_file(beside(job.output, "_report.json"), [&] { return orientation_json(outcome); }));
  const auto frames = result.motion.frames();
  const auto go_on = [&](std::int64_t, std::int64_t) {
    return !job.progress || job.progress(frames, frames);
  };
  auto written = write_results(staging, files, go_on, "inverse kinematics", set_of(job, outcome));
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return {};
}

/// NaN is null in JSON.
Json degrees(double rad) { return std::isnan(rad) ? Json(nullptr) : Json(kDegPerRad * rad); }

Json sensors_json(const OrientationFit& fit) {
  auto out = Json::array();
  for (const auto& sensor : fit.sensors) {
    const Eigen::Quaterniond q(sensor.body_from_sensor);
    out.push_back({{"name", sensor.name},
                   {"body", sensor.body},
                   {"seen", sensor.seen},
                   {"rms_deg", degrees(sensor.rms_rad)},
                   {"max_deg", degrees(sensor.max_rad)},
                   {"body_from_sensor", {q.w(), q.x(), q.y(), q.z()}}});
  }
  return out;
}

const char* source_of(motion::HeadingSource source) {
  constexpr std::array kNames{"motion", "model", "facing axis"};
  return kNames[static_cast<std::size_t>(source)];
}

Json coordinates_json(const data::JointMotion& motion) {
  auto out = Json::array();
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    Json one = {{"name", motion.coordinates[at(c)]}};
    if (!motion.determined.empty()) {
      std::int64_t frames = 0;
      for (std::int64_t f = 0; f < motion.frames(); ++f) frames += motion.determined[motion.index(f, c)] != 0;
      one["determined_frames"] = frames;
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

Result<OrientationOutcome> run_orientations(OrientationJob job) {
  if (auto s = check(job); !s) return std::unexpected(s.error());
  if (!job.up.empty()) {
    const auto up = workflow::parse_axis(job.up);
    if (!up) return fail(Code::usage, fmt::format("--up: {}", up.error().message));
    job.options.up_in_world = *up;
  }
  job.options.threads = job.threads;
  job.options.seed = job.seed;
  std::vector<std::filesystem::path> targets{job.output};
  if (job.options.error_bars) targets.push_back(beside(job.output, "_sd.sto"));
  for (const char* suffix : {"_orientation_errors.sto", "_report.json"})
    targets.push_back(beside(job.output, suffix));
  auto staging = Staging::create(targets, job, {job.model, job.orientations, job.pose});
  if (!staging) return std::unexpected(staging.error());

  OrientationOutcome outcome;
  outcome.command_line = job.command_line;
  const auto model = read_model(job.model, outcome);
  if (!model) return std::unexpected(model.error());
  const auto recording = read_sensors("orientations", job.orientations, outcome);
  if (!recording) return std::unexpected(recording.error());
  std::optional<data::Orientations> pose;
  if (!job.pose.empty()) {
    auto read = read_sensors("pose", job.pose, outcome);
    if (!read) return std::unexpected(read.error());
    pose = std::move(*read);
  }
  if (auto s = place_by_model(*model, *recording, job); !s) return std::unexpected(s.error());
  auto found =
      motion::solve_orientations(*model, *recording, pose ? &*pose : nullptr, job.options, job.progress);
  if (!found) return fail_at(job.orientations.string(), found.error());
  outcome.result = std::move(*found);
  judge(job, outcome);
  if (auto s = write(job, *staging, outcome); !s) return std::unexpected(s.error());
  return outcome;
}

Json orientation_json(const OrientationOutcome& outcome) {
  const auto& motion = outcome.result.motion;
  const auto& fit = outcome.result.fit;
  auto gates = Json::array();
  for (const auto& gate : outcome.gates)
    gates.push_back({{"name", gate.name},
                     {"passed", gate.passed},
                     {"value", gate.value},
                     {"bound", gate.bound},
                     {"unit", gate.unit},
                     {"sentence", gate.sentence}});
  return {{"kinemark", kVersion},
          {"command_line", outcome.command_line},
          {"inputs", report::inputs_json(outcome.inputs)},
          {"model", outcome.model},
          {"frames", motion.frames()},
          {"first_frame", motion.time.first_number},
          {"first_time_s", motion.time.t0_s},
          {"rate_hz", motion.time.rate_hz},
          {"coordinates", coordinates_json(motion)},
          {"sensors", sensors_json(fit)},
          {"heading",
           {{"deg", degrees(fit.heading_rad)},
            {"sd_deg", degrees(fit.heading_sd_rad)},
            {"from", source_of(fit.heading_source)}}},
          {"pose_drift_deg", degrees(fit.pose_drift_rad)},
          {"noise_sd_deg", degrees(fit.noise_sd_rad)},
          {"rms_deg", degrees(fit.rms_rad)},
          {"max_deg", degrees(fit.max_rad)},
          {"gates", gates},
          {"warnings", outcome.warnings}};
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/orientation_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/version.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/staging.h"
#include "kinemark/pipeline/motion/internal/sensor_page.h"
#include "kinemark/pipeline/motion/internal/sensor_run.h"
#include "kinemark/pipeline/motion/model_meshes.h"
#include "kinemark/stages/report/inputs_json.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Status check(const OrientationJob& job) {
  if (job.model.empty()) return fail(Code::usage, "no model; give --model");
  if (job.orientations.empty()) return fail(Code::usage, "no orientations; give --orientations");
  if (job.output.empty()) return fail(Code::usage, "no output; give --output");
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return s;
  if (auto s = check_geometry(job.geometry); !s) return s;
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

Status write(const OrientationJob& job, Staging& staging, const model::Model& model,
             OrientationOutcome& outcome) {
  const auto& result = outcome.result;
  std::vector<ResultFile> files;
  if (!job.report.empty()) {
    auto page = internal::sensor_page(job, model, outcome);
    if (!page) return std::unexpected(page.error());
    files.push_back(text_file(job.report, [html = std::move(*page)] { return html; }));
  }
  files.push_back(table_file(job.output, [&] { return coordinates_table(result.motion); }));
  if (job.options.error_bars)
    files.push_back(
        table_file(beside(job.output, "_sd.sto"), [&] { return deviations_table(result.motion); }));
  files.push_back(table_file(beside(job.output, "_orientation_errors.sto"), [&] {
    return internal::orientation_errors_table(result.motion.time, result.fit, result.error_rad);
  }));
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
  if (auto s = internal::check_up(job, "--up"); !s) return std::unexpected(s.error());
  job.options.threads = job.threads;
  job.options.seed = job.seed;
  std::vector<std::filesystem::path> targets{job.output};
  if (job.options.error_bars) targets.push_back(beside(job.output, "_sd.sto"));
  for (const char* suffix : {"_orientation_errors.sto", "_report.json"})
    targets.push_back(beside(job.output, suffix));
  if (!job.report.empty()) targets.push_back(job.report);
  auto staging = Staging::create(targets, job, {job.model, job.orientations, job.pose});
  if (!staging) return std::unexpected(staging.error());

  OrientationOutcome outcome;
  outcome.command_line = job.command_line;
  const auto model = read_model(job.model, outcome);
  if (!model) return std::unexpected(model.error());
  const auto sensors = internal::read_sensors(job, job.model, *model, outcome.inputs, outcome.warnings);
  if (!sensors) return std::unexpected(sensors.error());
  auto found = motion::solve_orientations(
      *model, sensors->recording, sensors->pose ? &*sensors->pose : nullptr, sensors->options, job.progress);
  if (!found) return fail_at(job.orientations.string(), found.error());
  outcome.result = std::move(*found);
  auto remarks = internal::sensor_remarks(outcome.result.fit, job, job.options.error_bars, false);
  std::ranges::move(remarks.warnings, std::back_inserter(outcome.warnings));
  outcome.gates = std::move(remarks.gates);
  if (auto s = write(job, *staging, *model, outcome); !s) return std::unexpected(s.error());
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
  Json json = {{"kinemark", kVersion},
               {"command_line", outcome.command_line},
               {"inputs", report::inputs_json(outcome.inputs)},
               {"model", outcome.model},
               {"frames", motion.frames()},
               {"first_frame", motion.time.first_number},
               {"first_time_s", motion.time.t0_s},
               {"rate_hz", motion.time.rate_hz},
               {"coordinates", coordinates_json(motion)}};
  json.update(internal::sensors_json(fit));
  json["gates"] = gates;
  json["warnings"] = outcome.warnings;
  return json;
}

}  // namespace kinemark::pipeline

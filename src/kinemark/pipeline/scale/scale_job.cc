// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/scale/scale_job.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/osim_document.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/io/place.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/skeleton_file.h"
#include "kinemark/pipeline/scale/scale_json.h"
#include "kinemark/pipeline/scale/scale_recordings.h"
#include "kinemark/stages/motion/scaling/clavicles.h"
#include "kinemark/stages/motion/scaling/place.h"

namespace kinemark::pipeline {
namespace {

double bounded(double time_s) { return std::clamp(time_s, -1e300, 1e300); }

/// The value of a coordinate's column in the row nearest to the middle of the placement's time range.
Result<double> value_from_file(const io::ScaleSetup& setup, const data::Table& table,
                               const data::ModelDescription& model, int coordinate_idx) {
  const auto& name = model.coordinates[static_cast<std::size_t>(coordinate_idx)].name;
  const auto column = table.find(name);
  if (column < 0 || table.rows() == 0)
    return fail(Code::bad_input, fmt::format("{}: has no value of '{}', which a task takes from it",
                                             setup.coordinate_file.string(), name));
  const double begin = std::max(setup.place_begin_s, table.time_s.front()),
               end = std::min(setup.place_end_s, table.time_s.back());
  std::int64_t nearest = 0;
  for (std::int64_t row = 1; row < table.rows(); ++row) {
    const auto away = [&](std::int64_t r) {
      return std::abs(table.time_s[static_cast<std::size_t>(r)] - 0.5 * (begin + end));
    };
    if (away(row) < away(nearest)) nearest = row;
  }
  return table(nearest, column) * column_unit(table, model, coordinate_idx);
}

/// The options of place_markers() that a ScaleTool file sets. `fixed`: markers of its set that stay. Tasks of
/// markers that the model lacks are passed over, as OpenSim does; tasks of unknown coordinates, and values
/// that the coordinate file does not hold, are errors.
Result<motion::PlaceOptions> place_options(const io::ScaleSetup& setup,
                                           const std::vector<io::MarkerOfSet>& set,
                                           const data::ModelDescription& model) {
  motion::PlaceOptions options;
  options.ik.first_time_s = bounded(setup.place_begin_s);
  options.ik.last_time_s = bounded(setup.place_end_s);
  if (setup.max_marker_movement_mm >= 0.0)
    options.max_marker_movement_m = 1e-3 * setup.max_marker_movement_mm;
  for (const auto& marker : set)
    if (marker.fixed) options.fixed.push_back(marker.name);
  if (!setup.tasks.markers.empty()) options.ik.default_marker_weight = 0.0;
  for (const auto& task : setup.tasks.markers)
    if (model.find_marker(task.name) >= 0)
      options.ik.marker_weights.push_back({.marker = task.name, .weight = task.apply ? task.weight : 0.0});

  std::optional<data::Table> table;
  for (const auto& task : setup.tasks.coordinates) {
    if (!task.apply || task.weight == 0.0) continue;
    const int c = model.find_coordinate(task.name);
    if (c < 0)
      return fail(Code::bad_input,
                  fmt::format("a task names coordinate '{}', which the model does not have", task.name));
    const auto& coordinate = model.coordinates[static_cast<std::size_t>(c)];
    double value = task.value;
    if (task.target == io::IkCoordinateTask::Target::default_value) value = coordinate.default_value;
    if (task.target == io::IkCoordinateTask::Target::from_file) {
      if (setup.coordinate_file.empty())
        return fail(Code::bad_input,
                    fmt::format("the task of coordinate '{}' takes its value from a file, but the "
                                "setup names no coordinate_file",
                                task.name));
      if (!table) {
        auto read = io::read_table(setup.coordinate_file);
        if (!read) return std::unexpected(read.error());
        table = std::move(*read);
      }
      const auto found = value_from_file(setup, *table, model, c);
      if (!found) return std::unexpected(found.error());
      value = *found;
    }
    options.ik.coordinate_tasks.push_back({.coordinate = task.name, .weight = task.weight, .value = value});
  }
  return options;
}

namespace fs = std::filesystem;
using Setup = std::optional<io::ScaleSetup>;

/// The setup, where there is one; it fills what the job leaves open.
Result<Setup> read_setup(ScaleJob& job) {
  if (job.setup.empty()) return Setup{};
  auto setup = io::read_scale_setup(job.setup);
  if (!setup) return std::unexpected(setup.error());
  if (job.model.empty()) job.model = setup->model_file;
  if (job.output.empty() && !setup->output_model_file.empty()) {
    if (auto s = io::check_below(job.setup, setup->output_model_file, "output_model_file"); !s)
      return std::unexpected(s.error());
    job.output = setup->output_model_file;
  }
  if (job.mass_kg == 0.0) job.mass_kg = setup->recipe.mass_kg;
  return Setup{std::move(*setup)};
}

/// --static takes precedence over files that the setup names.
Status check_named(const ScaleJob& job, const Setup& setup) {
  if (!setup || !job.static_trial.empty()) return {};
  const bool measures = setup->recipe.measures() && setup->scale_marker_file.empty();
  if (measures || (setup->place && setup->place_marker_file.empty()))
    return fail(Code::usage,
                fmt::format("{} needs a marker file; give --static or name it there",
                            measures ? "the measurements of the setup" : "the MarkerPlacer of the setup"));
  return {};
}

Status check(const ScaleJob& job, const Setup& setup) {
  if (job.model.empty()) return fail(Code::usage, "no model; give --model or a --setup that names one");
  if (job.output.empty()) return fail(Code::usage, "no output; give --output or a --setup that names one");
  if (auto s = check_ending(job.output, {".osim"}, "a model is"); !s) return s;
  if (auto s = check_ending(job.report, {".html"}, "a page is"); !s) return s;
  if (!setup && job.static_trial.empty() && job.markers.empty())
    return fail(Code::usage, "nothing to scale by; give --static, --setup or --markers");
  if (auto s = job.RecordingOptions::check(); !s) return s;
  if (auto s = check_for_several(job); !s && count_recordings(job, setup ? &*setup : nullptr) > 1) return s;
  if (auto s = job.ScaleMethod::check(); !s) return s;
  if (!job.joints.empty() && job.markers.empty() && (job.static_trial.empty() || setup))
    return fail(Code::usage,
                "functional joints place those of a model that is adapted; give --static or "
                "--markers besides --joints");
  return check_named(job, setup);
}

Result<Staging> stage(const ScaleJob& job, const Setup& setup) {
  std::vector<fs::path> targets{job.output, beside(job.output, "_report.json")};
  if (!job.report.empty()) targets.push_back(job.report);
  std::vector<fs::path> read{job.model, job.setup, job.joints, job.joints / "skeleton.json"};
  std::vector<fs::path> recordings{job.static_trial, job.markers};
  if (setup) {
    read.insert(read.end(), {setup->marker_set_file, setup->coordinate_file});
    read.insert(read.end(), setup->parts.begin(), setup->parts.end());
    recordings.insert(recordings.end(), {setup->scale_marker_file, setup->place_marker_file});
  }
  for (const auto& recording : recordings)
    std::ranges::move(files_of(recording, job), std::back_inserter(read));
  return Staging::create(targets, job, read);
}

/// The body of a file, and as it is scaled: with the markers of the setup.
struct Body {
  io::OsimDocument document;
  data::ModelDescription model;
  std::vector<io::MarkerOfSet> marker_set;
};

Result<Body> read_body(const ScaleJob& job, const Setup& setup) {
  auto document = io::OsimDocument::read(job.model);
  if (!document) return std::unexpected(document.error());
  Body body{.document = std::move(*document), .model = {}, .marker_set = {}};
  body.model = body.document.model();
  if (setup && !setup->marker_set_file.empty()) {
    auto set = io::read_marker_set(setup->marker_set_file);
    if (!set) return std::unexpected(set.error());
    body.marker_set = std::move(*set);
    if (auto s = io::merge_markers(body.model, body.marker_set); !s)
      return fail_at(setup->marker_set_file.string(), s.error());
  }
  if (body.model.markers.empty())
    return fail(Code::bad_input,
                fmt::format("{}: model '{}' has no markers; need at least one, or a setup with a marker set",
                            job.model.string(), body.model.name));
  return body;
}

/// How the setup places markers, on coordinates of the body as it is scaled.
Result<motion::PlaceOptions> read_place_options(const ScaleJob& job, const io::ScaleSetup& setup,
                                                const Body& body) {
  auto model = body.model;
  if (job.clavicles)
    if (auto moving = motion::add_clavicles(model); !moving)
      return fail_at(job.model.string(), moving.error());
  auto options = place_options(setup, body.marker_set, model);
  if (!options) return fail_at(job.setup.string(), options.error());
  return options;
}

Result<workflow::ScaleOptions> options_of(const ScaleJob& job, const Setup& setup, const Body& body) {
  workflow::ScaleOptions options;
  static_cast<workflow::ScaleMethod&>(options) = job;
  auto& adapt = options.adapt;
  adapt.threads = job.threads;
  adapt.ik.seed = job.seed;
  const auto& times = job.selection;
  if (std::isfinite(times.first_time_s)) adapt.ik.first_time_s = times.first_time_s;
  if (std::isfinite(times.last_time_s)) adapt.ik.last_time_s = times.last_time_s;
  options.axes = job.axes;
  options.drop_doubtful = job.drops_doubtful(false);
  options.progress = job.progress;
  if (!setup) return options;
  options.recipe = setup->recipe;
  if (!setup->place) return options;
  auto place = read_place_options(job, *setup, body);
  if (!place) return std::unexpected(place.error());
  options.place = std::move(*place);
  return options;
}

/// All that the body is scaled by.
Result<workflow::ScaleInputs> read_inputs(const ScaleJob& job, const Setup& setup, const Body& body) {
  workflow::ScaleInputs inputs;
  inputs.names = {.model = job.model.string(), .recipe = job.setup.string(), .skeleton = job.joints.string()};
  inputs.paths = body.document.paths();
  inputs.paths_fault = body.document.paths_error();
  std::string found_in;
  if (!job.joints.empty()) {
    auto file = read_skeleton(job.joints);
    if (!file) return std::unexpected(file.error());
    inputs.joints = std::move(file->skeleton);
    found_in = file->recording.hash;
  }
  if (auto s = read_scale_recordings(job, setup ? &*setup : nullptr, found_in, inputs); !s)
    return std::unexpected(s.error());
  return inputs;
}

/// What is found, with what was said of it behind what was said before.
void take(workflow::ScaleFound found, ScaleOutcome& outcome) {
  auto remarks = std::exchange(found.remarks, {});
  static_cast<workflow::ScaleFound&>(outcome) = std::move(found);
  std::ranges::move(remarks.warnings, std::back_inserter(outcome.warnings));
  outcome.gates = std::move(remarks.gates);
}

/// Name of the set of files. @param text  of the model
std::string name_set(const ScaleOutcome& outcome, const std::string& text) {
  SetDigest digest;
  digest.add("scale").add(text);
  for (const auto& gate : outcome.gates) digest.add(gate.name).add(std::array{gate.value, gate.bound});
  for (const auto& factor : outcome.factors)
    digest.add(std::array{factor.factors.x(), factor.factors.y(), factor.factors.z()});
  return digest.hex();
}

/// The scaled model in the document that it came in. @param lost  what does not fit there is added
Result<std::string> format_model(const io::OsimDocument& document, ScaleOutcome& outcome) {
  std::vector<Eigen::Vector3d> factors;  // of the bodies that the file has: clavicles come behind them
  for (std::size_t b = 0; b < document.model().bodies.size(); ++b)
    factors.push_back(outcome.factors[b].factors);
  auto text =
      document.format({.model = outcome.model, .factors = std::move(factors), .paths = outcome.muscles});
  if (!text) return std::unexpected(text.error());
  outcome.lost = std::move(text->lost);
  return std::move(text->text);
}

Status write(const ScaleJob& job, const io::OsimDocument& document, Staging& staging, ScaleOutcome& outcome) {
  const auto text = format_model(document, outcome);
  if (!text) return fail_at(job.output.string(), text.error());
  std::vector<ResultFile> files{
      model_file(job.output, *text),
      json_file(beside(job.output, "_report.json"), [&] { return scale_json(job, outcome); })};
  if (!job.report.empty()) files.push_back(text_file(job.report, [&] { return scale_page(job, outcome); }));
  auto written = write_results(staging, files, {}, "scaling", name_set(outcome, *text));
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return {};
}

}  // namespace

Result<ScaleOutcome> run_scale(ScaleJob job) {
  // Prepare: options, where results go, body and recordings.
  const auto setup = read_setup(job);
  if (!setup) return std::unexpected(setup.error());
  if (auto s = check(job, *setup); !s) return std::unexpected(s.error());
  auto staging = stage(job, *setup);
  if (!staging) return std::unexpected(staging.error());
  const auto body = read_body(job, *setup);
  if (!body) return std::unexpected(body.error());
  const auto options = options_of(job, *setup, *body);
  if (!options) return std::unexpected(options.error());
  auto inputs = read_inputs(job, *setup, *body);
  if (!inputs) return std::unexpected(inputs.error());
  // Scale and judge.
  ScaleOutcome outcome;
  if (*setup) outcome.warnings = (*setup)->notes;
  auto found = workflow::scale(body->model, std::move(*inputs), *options);
  if (!found) return std::unexpected(found.error());
  take(std::move(*found), outcome);
  // Write.
  if (auto s = write(job, body->document, *staging, outcome); !s) return std::unexpected(s.error());
  return outcome;
}

}  // namespace kinemark::pipeline

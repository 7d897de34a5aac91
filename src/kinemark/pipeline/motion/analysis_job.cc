// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/analysis_job.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/core/version.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/motion/given_motion.h"
#include "kinemark/pipeline/motion/internal/analysis_plan.h"
#include "kinemark/stages/report/inputs_json.h"
#include "kinemark/workflow/motion/dynamics.h"

namespace kinemark::pipeline {
namespace {

constexpr std::array kHeadings{"Positions", "Velocities", "Accelerations"};
constexpr std::array kPointOrders{"PointPosition", "PointVelocity", "PointAcceleration"};

data::Table begin_table(std::string name, const TimeBase& time, const RowRange& rows) {
  data::Table table;
  table.name = std::move(name);
  for (auto f = rows.first; f < rows.last; ++f) table.time_s.push_back(time.time_s(f));
  return table;
}

using internal::AnalysisPlan;
namespace fs = std::filesystem;

constexpr std::array kRates{"q", "u", "dudt"};
constexpr std::array kOrders{"pos", "vel", "acc"};

RowRange rows_in(const AnalysisPlan& plan, const TimeBase& time) {
  const double slack = 1e-3 / time.rate_hz;
  RowRange rows{0, time.frames};
  while (rows.first < rows.last && time.time_s(rows.first) < plan.first_time_s - slack) ++rows.first;
  while (rows.last > rows.first && time.time_s(rows.last - 1) > plan.last_time_s + slack) --rows.last;
  const bool between = rows.first < time.frames && time.time_s(rows.first) > plan.first_time_s + slack;
  if (plan.from_row_before && between && rows.first > 0) --rows.first;
  return rows;
}

/// The files of an analysis, and everything that they are made of.
class Results {
 public:
  Results(const AnalysisPlan& plan, const data::ModelDescription& model, const workflow::DynamicsFound& found,
          const RowRange& rows)
      : plan_(plan), found_(found), rows_(rows) {
    if (!plan.kinematics_name.empty()) add_kinematics();
    if (found.bodies) add_bodies(model, *found.bodies);
    if (!plan.torque_file.empty()) add_torques();
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<data::Table>& tables() const { return tables_; }

 private:
  void add_kinematics() {
    const auto& motion = found_.motion;
    const std::array values{&motion.q, &motion.qd, &motion.qdd};
    for (int k = 0; k < 3; ++k)
      add(
          fmt::format("{}_{}_{}", plan_.name, plan_.kinematics_name, kRates[at(k)]),
          [&, k](const Array<double>& v) {
            constexpr std::array kNames{"Coordinates", "Speeds", "Accelerations"};
            return coordinate_rates_table(kNames[at(k)], motion, v, plan_.coordinates,
                                          plan_.kinematics_in_degrees, rows_);
          },
          *values[at(k)], found_.sd[at(k)]);
  }

  void add_bodies(const data::ModelDescription& model, const motion::BodyMotion& bodies) {
    if (!plan_.bodies_name.empty())
      for (int order = 0; order < 3; ++order)
        add(
            fmt::format("{}_{}_{}_{}", plan_.name, plan_.bodies_name, kOrders[at(order)],
                        order > 0 && plan_.follow.rates_in_body ? "bodyLocal" : "global"),
            [&, order](const Array<double>& v) {
              return bodies_table(model, bodies, v, plan_.follow.body_idx, plan_.mass_centre, order,
                                  plan_.bodies_in_degrees, rows_);
            },
            bodies.value, bodies.sd);
    for (std::size_t p = 0; p < plan_.point_names.size(); ++p)
      for (int order = 0; order < 3; ++order)
        add(
            fmt::format("{}_{}_{}_{}", plan_.name, plan_.point_names[p], plan_.follow.points[p].name,
                        kOrders[at(order)]),
            [&, p, order](const Array<double>& v) {
              return point_table(bodies, v, static_cast<std::int64_t>(p), order, rows_);
            },
            bodies.value, bodies.sd);
  }

  void add_torques() {
    names_.push_back(plan_.torque_file);
    tables_.push_back(rows_of(torques_table(found_.motion), rows_));
    if (found_.motion.tau_sd.empty()) return;
    names_.push_back(fs::path(plan_.torque_file).stem().string() + "_sd.sto");
    tables_.push_back(rows_of(torque_deviations_table(found_.motion), rows_));
  }

  template <class Make>
  void add(const std::string& name, const Make& make, const Array<double>& values, const Array<double>& sd) {
    names_.push_back(name + ".sto");
    tables_.push_back(make(values));
    if (sd.empty()) return;
    names_.push_back(name + "_sd.sto");
    tables_.push_back(make(sd));
    tables_.back().name = "Standard deviations: " + tables_.back().name;
  }

  const AnalysisPlan& plan_;
  const workflow::DynamicsFound& found_;
  RowRange rows_;
  std::vector<std::string> names_;
  std::vector<data::Table> tables_;
};

Status check_names(const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const auto& name : names) {
    if (fs::path(name).filename() != name)
      return fail(Code::usage, fmt::format("'{}' cannot be the name of a file; need names without / of the "
                                           "setup, its analyses and points",
                                           name));
    if (!seen.insert(name).second)
      return fail(Code::usage,
                  fmt::format("two results would be written as {}; give points and analyses names "
                              "of their own",
                              name));
  }
  return {};
}

nlohmann::ordered_json record_of(const AnalysisJob& job, const AnalysisOutcome& out,
                                 const std::vector<std::string>& names) {
  nlohmann::ordered_json json;
  json["schema"] = "kinemark.analysis";
  json["version"] = std::string(kVersion);
  json["command"] = job.command_line;
  json["inputs"] = report::inputs_json(out.inputs);
  json["rows"] = out.time.frames;
  json["rate_hz"] = out.time.rate_hz;
  json["start_s"] = out.time.t0_s;
  for (const auto& [name, value] : out.facts) json["facts"][name] = value;
  json["warnings"] = out.warnings;
  json["files"] = names;
  return json;
}

Status add_input(const char* role, const fs::path& path, AnalysisOutcome& out) {
  if (path.empty()) return {};
  auto record = io::record_input(role, path);
  if (!record) return std::unexpected(record.error());
  out.inputs.push_back(std::move(*record));
  return {};
}

workflow::DynamicsOptions options_of(const AnalysisPlan& plan) {
  workflow::DynamicsOptions options;
  static_cast<motion::BodyMotionOptions&>(options) = plan.follow;
  options.mass_centre = !plan.bodies_name.empty();
  options.torques = !plan.torque_file.empty();
  options.cutoff_hz = plan.cutoff_hz;
  return options;
}

}  // namespace

data::Table coordinate_rates_table(std::string name, const data::JointMotion& motion,
                                   const Array<double>& values, const std::vector<int>& columns,
                                   bool in_degrees, const RowRange& rows) {
  data::Table table = begin_table(std::move(name), motion.time, rows);
  table.in_degrees = in_degrees;
  std::vector<double> unit;
  for (const int c : columns) {
    table.columns.push_back(motion.coordinates[at(c)]);
    const bool keeps_radians = !motion.keeps_radians.empty() && motion.keeps_radians[at(c)];
    unit.push_back(in_degrees && motion.is_rotation[at(c)] && !keeps_radians ? kDegPerRad : 1.0);
  }
  for (auto f = rows.first; f < rows.last; ++f)
    for (std::size_t k = 0; k < columns.size(); ++k)
      table.values.push_back(unit[k] * values[motion.index(f, columns[k])]);
  return table;
}

data::Table bodies_table(const data::ModelDescription& model, const motion::BodyMotion& bodies,
                         const Array<double>& values, const std::vector<int>& body_idx, bool mass_centre,
                         int order, bool in_degrees, const RowRange& rows) {
  data::Table table = begin_table(kHeadings[at(order)], bodies.time, rows);
  table.in_degrees = in_degrees;
  for (const int idx : body_idx)
    for (const char* axis : {"_X", "_Y", "_Z", "_Ox", "_Oy", "_Oz"})
      table.columns.push_back(model.bodies[at(idx)].name + axis);
  if (mass_centre)
    for (const char* axis : {"_X", "_Y", "_Z"}) table.columns.push_back(std::string("center_of_mass") + axis);
  const double angle = in_degrees ? kDegPerRad : 1.0;
  for (auto f = rows.first; f < rows.last; ++f) {
    const double* row = values.data() + bodies.index(f, order, 0);
    for (std::int64_t k = 0; k < std::ssize(table.columns); ++k)
      table.values.push_back(row[k] * (k < 6 * bodies.bodies && k % 6 >= 3 ? angle : 1.0));
  }
  return table;
}

data::Table point_table(const motion::BodyMotion& bodies, const Array<double>& values, std::int64_t point,
                        int order, const RowRange& rows) {
  data::Table table = begin_table(kPointOrders[at(order)], bodies.time, rows);
  table.columns = {"state_0", "state_1", "state_2"};
  for (auto f = rows.first; f < rows.last; ++f)
    for (std::int64_t axis = 0; axis < 3; ++axis)
      table.values.push_back(values[bodies.index(f, order, 6 * bodies.bodies + 3 + 3 * point + axis)]);
  return table;
}

data::Table rows_of(data::Table table, const RowRange& rows) {
  const auto K = std::ssize(table.columns);
  table.values = {table.values.begin() + rows.first * K, table.values.begin() + rows.last * K};
  table.time_s = {table.time_s.begin() + rows.first, table.time_s.begin() + rows.last};
  return table;
}

Result<AnalysisOutcome> run_analysis(const AnalysisJob& job) {
  // Read.
  auto inputs = internal::read_analysis_inputs(job);
  if (!inputs) return std::unexpected(inputs.error());
  AnalysisOutcome out;
  auto description = io::read_osim(inputs->plan.model);
  if (!description) return std::unexpected(description.error());
  if (auto s = add_input("model", inputs->plan.model, out); !s) return std::unexpected(s.error());
  if (auto s = add_input("setup", job.setup, out); !s) return std::unexpected(s.error());
  auto plan = internal::plan_analysis(job, std::move(*inputs), *description);
  if (!plan) return std::unexpected(plan.error());
  out.warnings = plan->notes;
  const auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(plan->model.string(), model.error());
  auto read = read_motion(plan->motion, plan->forces, *model, plan->cutoff_hz);
  if (!read) return std::unexpected(read.error());
  std::ranges::move(read->inputs, std::back_inserter(out.inputs));
  std::ranges::move(read->notes, std::back_inserter(out.warnings));
  const auto& time = read->given.motion.time;
  const RowRange rows = rows_in(*plan, time);
  if (rows.size() == 0)
    return fail(Code::usage, fmt::format("{}: no row lies between {:g} and {:g} s; it has {:g} to {:g} s",
                                         plan->motion.string(), plan->first_time_s, plan->last_time_s,
                                         time.time_s(0), time.time_s(time.frames - 1)));
  out.time = {.rate_hz = time.rate_hz, .t0_s = time.time_s(rows.first), .frames = rows.size()};
  // Compute.
  auto found = workflow::dynamics(*model, read->given, options_of(*plan));
  if (!found) return std::unexpected(found.error());
  out.facts = std::move(found->facts);
  std::ranges::move(found->remarks.warnings, std::back_inserter(out.warnings));
  out.gates = std::move(found->remarks.gates);
  for (const auto& gate : out.gates)
    if (!gate.passed && gate.name != "contradictions")  // each of those is said
      out.warnings.push_back(gate.sentence);
  // Write.
  const Results results(*plan, model->description(), *found, rows);
  auto names = results.names();
  names.push_back(plan->name + "_analysis.json");
  if (auto s = check_names(names); !s) return std::unexpected(s.error());
  if (auto s = check_folder(plan->output, "tables are"); !s) return std::unexpected(s.error());
  auto staging = Staging::create_in(plan->output, names, job, {job.setup, job.forces});
  if (!staging) return std::unexpected(staging.error());
  staging->add_inputs(out.inputs);
  std::vector<ResultFile> files;
  SetDigest digest;
  digest.add("analyze").add(out.inputs).add(out.facts);
  for (std::size_t i = 0; i < results.tables().size(); ++i) {
    const auto& table = results.tables()[i];
    digest.add(table);
    files.push_back(table_file(staging->targets()[i], [&table] { return table; }));
  }
  files.push_back(json_file(staging->targets().back(), [&] { return record_of(job, out, names); }));
  auto written = write_results(*staging, files, job.progress, "the analysis", digest.hex());
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return out;
}

}  // namespace kinemark::pipeline

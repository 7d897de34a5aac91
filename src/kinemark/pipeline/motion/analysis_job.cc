// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/analysis_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/version.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/motion/analysis_tables.h"
#include "kinemark/pipeline/motion/internal/analysis_plan.h"
#include "kinemark/pipeline/motion/rated_motion.h"
#include "kinemark/pipeline/motion/torques.h"
#include "kinemark/stages/motion/smoother/rates.h"

namespace kinemark::pipeline {
namespace {

using internal::AnalysisPlan;
namespace fs = std::filesystem;

constexpr std::array kRates{"q", "u", "dudt"};
constexpr std::array kOrders{"pos", "vel", "acc"};

/// Where the motion has no number, nor have its coordinates and torques.
void withdraw_filled(const RatedMotion& read, data::JointMotion& motion) {
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      if (read.is_filled[motion.index(f, c)] == 0) continue;
      for (auto* values : {&motion.q, &motion.qd, &motion.qdd}) (*values)[motion.index(f, c)] = kNaN;
      for (auto* forces : {&motion.tau, &motion.tau_sd})
        if (!forces->empty()) std::fill_n(forces->begin() + motion.index(f, 0), motion.size(), kNaN);
    }
}

RowRange rows_in(const AnalysisPlan& plan, const TimeBase& time) {
  const double slack = 1e-3 / time.rate_hz;
  RowRange rows{0, time.frames};
  while (rows.first < rows.last && time.time_s(rows.first) < plan.first_time_s - slack) ++rows.first;
  while (rows.last > rows.first && time.time_s(rows.last - 1) > plan.last_time_s + slack) --rows.last;
  const bool between = rows.first < time.frames && time.time_s(rows.first) > plan.first_time_s + slack;
  if (plan.from_row_before && between && rows.first > 0) --rows.first;
  return rows;
}

/// Derivatives of a coordinate (order 0), its speed (1) or acceleration (2) by q, qd, qdd of the one that it
/// is coupled to; without the coupling's third derivative.
Eigen::Vector3d coupled_derivatives(const math::ScalarFunction& coupling, double q, double qd, double qdd,
                                    int order) {
  const auto at_q = coupling(q);
  if (order == 0) return {at_q.df, 0.0, 0.0};
  if (order == 1) return {at_q.ddf * qd, at_q.df, 0.0};
  return {at_q.ddf * qdd, 2.0 * at_q.ddf * qd, at_q.df};
}

/// Standard deviation of q, qd or qdd of every coordinate; NaN where it is not determined.
Array<double> deviations_of(const model::Model& model, const RatedMotion& read, int order) {
  const auto& motion = read.motion;
  Array<double> sd(motion.q.size(), kNaN);
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    const auto& coordinate = model.coordinates()[at(c)];
    const auto from = coordinate.source >= 0 ? coordinate.source : c;
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto i = motion.index(f, from);
      if (motion.determined[i] == 0) continue;
      const auto p = motion::covariance_as_held(motion, read.errors, f, from);
      Eigen::Matrix3d covariance;
      covariance << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
      const Eigen::Vector3d by = from == c ? Eigen::Vector3d(Eigen::Vector3d::Unit(order))
                                           : coupled_derivatives(coordinate.coupling, motion.q[i],
                                                                 motion.qd[i], motion.qdd[i], order);
      sd[motion.index(f, c)] = std::sqrt(std::max(0.0, by.dot(covariance * by)));
    }
  }
  return sd;
}

/// The files of an analysis, and everything that they are made of.
class Results {
 public:
  Results(const AnalysisPlan& plan, const model::Model& model, const RatedMotion& read, const RowRange& rows)
      : plan_(plan), model_(model), read_(read), rows_(rows) {}

  void add_kinematics() {
    const auto& motion = read_.motion;
    const std::array values{&motion.q, &motion.qd, &motion.qdd};
    for (int k = 0; k < 3; ++k)
      add(
          fmt::format("{}_{}_{}", plan_.name, plan_.kinematics_name, kRates[at(k)]),
          [this, k](const Array<double>& v) {
            constexpr std::array kNames{"Coordinates", "Speeds", "Accelerations"};
            return coordinate_rates_table(kNames[at(k)], read_.motion, v, plan_.coordinates,
                                          plan_.kinematics_in_degrees, rows_);
          },
          *values[at(k)], deviations_of(model_, read_, k));
  }

  void add_bodies(const motion::BodyMotion& bodies) {
    if (!plan_.bodies_name.empty())
      for (int order = 0; order < 3; ++order)
        add(
            fmt::format("{}_{}_{}_{}", plan_.name, plan_.bodies_name, kOrders[at(order)],
                        order > 0 && plan_.follow.rates_in_body ? "bodyLocal" : "global"),
            [&, order](const Array<double>& v) {
              return bodies_table(model_.description(), bodies, v, plan_.follow.body_idx, plan_.mass_centre,
                                  order, plan_.bodies_in_degrees, rows_);
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

  void add_torques(const data::JointMotion& motion) {
    names_.push_back(plan_.torque_file);
    tables_.push_back(rows_of(torques_table(motion), rows_));
    if (motion.tau_sd.empty() || !plan_.follow.error_bars) return;
    names_.push_back(fs::path(plan_.torque_file).stem().string() + "_sd.sto");
    tables_.push_back(rows_of(torque_deviations_table(motion), rows_));
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<data::Table>& tables() const { return tables_; }

 private:
  template <class Make>
  void add(const std::string& name, const Make& make, const Array<double>& values, const Array<double>& sd) {
    names_.push_back(name + ".sto");
    tables_.push_back(make(values));
    if (!plan_.follow.error_bars) return;
    names_.push_back(name + "_sd.sto");
    tables_.push_back(make(sd));
    tables_.back().name = "Standard deviations: " + tables_.back().name;
  }

  const AnalysisPlan& plan_;
  const model::Model& model_;
  const RatedMotion& read_;
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
  json["inputs"] = nlohmann::ordered_json::array();
  for (const auto& input : out.inputs)
    json["inputs"].push_back({{"role", input.role},
                              {"path", input.path},
                              {"bytes", input.bytes},
                              {"hash", input.hash},
                              {"hash_kind", input.hash_kind}});
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
  auto record = record_input(role, path);
  if (!record) return std::unexpected(record.error());
  out.inputs.push_back(std::move(*record));
  return {};
}

/// How rates and deviations were found, in a sentence each.
void tell_method(const AnalysisPlan& plan, const RatedMotion& read, AnalysisOutcome& out) {
  if (plan.cutoff_hz > 0.0) {
    out.facts.emplace_back("low-pass",
                           fmt::format("Butterworth, third order, both ways, {:g} Hz", plan.cutoff_hz));
    out.warnings.push_back(fmt::format(
        "coordinates were low-passed at {:g} Hz: what that leaves of their noise is not known, and no "
        "deviations are written",
        plan.cutoff_hz));
  }
  out.facts.emplace_back("rates", "each coordinate smoothed by itself, its bandwidth from its likelihood");
  out.facts.emplace_back("deviations", !plan.follow.error_bars    ? "none"
                                       : read.motion.q_sd.empty() ? "from the noise found in each coordinate"
                                                                  : "from those of the motion");
}

Status add_torque_facts(const AnalysisPlan& plan, const TorqueAccount& account, AnalysisOutcome& out) {
  for (const auto& file : account.files)
    if (auto s = add_input("forces", file, out); !s) return s;
  if (!plan.forces.empty() && account.files.empty())
    if (auto s = add_input("forces", plan.forces, out); !s) return s;
  out.facts.insert(out.facts.end(), account.facts.begin(), account.facts.end());
  out.warnings.insert(out.warnings.end(), account.warnings.begin(), account.warnings.end());
  return {};
}

}  // namespace

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
  auto read = read_rated_motion(plan->motion, *model, plan->cutoff_hz);
  if (!read) return std::unexpected(read.error());
  std::ranges::move(read->inputs, std::back_inserter(out.inputs));
  std::ranges::move(read->notes, std::back_inserter(out.warnings));
  const RowRange rows = rows_in(*plan, read->motion.time);
  if (rows.size() == 0)
    return fail(Code::usage, fmt::format("{}: no row lies between {:g} and {:g} s; it has {:g} to {:g} s",
                                         plan->motion.string(), plan->first_time_s, plan->last_time_s,
                                         read->motion.time.time_s(0),
                                         read->motion.time.time_s(read->motion.frames() - 1)));
  out.time = {.rate_hz = read->motion.time.rate_hz,
              .t0_s = read->motion.time.time_s(rows.first),
              .frames = rows.size()};
  tell_method(*plan, *read, out);
  // Compute.
  std::optional<motion::BodyMotion> bodies;
  if (!plan->bodies_name.empty() || !plan->point_names.empty()) {
    auto followed = motion::body_motion(*model, read->motion, plan->follow, read->errors, read->is_filled);
    if (!followed) return fail_at(plan->motion.string(), followed.error());
    bodies = std::move(*followed);
  }
  if (!plan->torque_file.empty()) {
    const auto account =
        add_torques(*model, read->motion, plan->forces,
                    {.error_bars = plan->follow.error_bars, .threads = job.threads}, &read->errors);
    if (!account) return std::unexpected(account.error());
    if (auto s = add_torque_facts(*plan, *account, out); !s) return std::unexpected(s.error());
  }
  withdraw_filled(*read, read->motion);
  // Write.
  Results results(*plan, *model, *read, rows);
  if (!plan->kinematics_name.empty()) results.add_kinematics();
  if (bodies) results.add_bodies(*bodies);
  if (!plan->torque_file.empty()) results.add_torques(read->motion);
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

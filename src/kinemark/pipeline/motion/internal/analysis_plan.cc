// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/internal/analysis_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/io/place.h"
#include "kinemark/pipeline/files/output_check.h"

namespace kinemark::pipeline::internal {
namespace {

/// The index of a body, data::kGround for the ground.
Result<int> find_body(const data::ModelDescription& model, const std::string& name, std::string_view user) {
  if (name == "ground") return data::kGround;
  const int idx = model.find_body(name);
  if (idx < 0)
    return fail(Code::usage,
                fmt::format("{} names body '{}', which model '{}' does not have", user, name, model.name));
  return idx;
}

bool names_all(const std::vector<std::string>& names) {
  return std::ranges::find(names, "all") != names.end();
}

Status plan_bodies(const data::ModelDescription& model, const io::BodyKinematicsAnalysis& asked,
                   AnalysisPlan& plan) {
  plan.bodies_name = asked.name;
  plan.bodies_in_degrees = asked.in_degrees;
  plan.follow.rates_in_body = asked.in_body;
  plan.mass_centre = names_all(asked.bodies);
  if (plan.mass_centre) {
    plan.follow.body_idx.resize(model.bodies.size());
    std::iota(plan.follow.body_idx.begin(), plan.follow.body_idx.end(), 0);
    return {};
  }
  for (const auto& name : asked.bodies) {
    if (name == "center_of_mass") {
      plan.mass_centre = true;
      continue;
    }
    const auto idx = find_body(model, name, asked.name);
    if (!idx) return std::unexpected(idx.error());
    if (*idx < 0)
      return fail(Code::usage, fmt::format("{} names the ground, which does not move", asked.name));
    plan.follow.body_idx.push_back(*idx);
  }
  return {};
}

Status plan_point(const data::ModelDescription& model, const io::PointKinematicsAnalysis& asked,
                  AnalysisPlan& plan) {
  const auto user = fmt::format("point '{}'", asked.point.empty() ? asked.name : asked.point);
  const auto body = find_body(model, asked.body, user);
  if (!body) return std::unexpected(body.error());
  const auto relative_to = find_body(model, asked.relative_to, user);
  if (!relative_to) return std::unexpected(relative_to.error());
  plan.point_names.push_back(asked.name);
  plan.follow.points.push_back({.name = asked.point,
                                .body_idx = *body,
                                .x_in_body = asked.x_in_body,
                                .relative_to_idx = *relative_to});
  return {};
}

Status plan_coordinates(const data::ModelDescription& model, const io::KinematicsAnalysis& asked,
                        AnalysisPlan& plan) {
  plan.kinematics_name = asked.name;
  plan.kinematics_in_degrees = asked.in_degrees;
  if (names_all(asked.coordinates)) {
    plan.coordinates.resize(model.coordinates.size());
    std::iota(plan.coordinates.begin(), plan.coordinates.end(), 0);
    return {};
  }
  for (const auto& name : asked.coordinates) {
    const int idx = model.find_coordinate(name);
    if (idx < 0)
      return fail(Code::usage, fmt::format("{} names coordinate '{}', which model '{}' does not have",
                                           asked.name, name, model.name));
    plan.coordinates.push_back(idx);
  }
  return {};
}

Status check_times(const AnalysisPlan& plan) {
  if (std::isnan(plan.first_time_s) || std::isnan(plan.last_time_s) || plan.first_time_s > plan.last_time_s)
    return fail(Code::usage, fmt::format("{} to {} s is no range of time; need the earlier one first",
                                         plan.first_time_s, plan.last_time_s));
  return {};
}

}  // namespace

Result<AnalysisInputs> read_analysis_inputs(const AnalysisJob& job) {
  AnalysisInputs inputs;
  auto& plan = inputs.plan;
  plan.motion = job.motion;
  plan.model = job.model;
  plan.forces = job.forces;
  plan.output = job.output;
  plan.cutoff_hz = job.cutoff_hz;
  plan.first_time_s = job.first_time_s;
  plan.last_time_s = job.last_time_s;
  if (!job.setup.empty()) {
    auto setup = io::read_analysis_setup(job.setup);
    if (!setup) return std::unexpected(setup.error());
    if (plan.motion.empty()) plan.motion = setup->coordinates_file;
    if (plan.model.empty()) plan.model = setup->model_file;
    if (plan.forces.empty() && setup->torques) plan.forces = setup->external_loads_file;
    if (plan.output.empty() && !setup->results_directory.empty()) {
      if (auto s = io::check_below(job.setup, setup->results_directory, "results_directory"); !s)
        return std::unexpected(s.error());
      plan.output = setup->results_directory;
    }
    if (plan.cutoff_hz == 0.0) plan.cutoff_hz = setup->cutoff_hz;
    plan.from_row_before = std::isinf(plan.first_time_s);
    if (plan.from_row_before) plan.first_time_s = setup->time_begin_s;
    if (std::isinf(plan.last_time_s)) plan.last_time_s = setup->time_end_s;
    plan.notes = setup->notes;
    inputs.setup = std::move(*setup);
  }
  const auto missing = plan.motion.empty()   ? "motion: give a .mot or .sto"
                       : plan.model.empty()  ? "model: give --model"
                       : plan.output.empty() ? "folder for the results: give --output"
                                             : nullptr;
  if (missing) return fail(Code::usage, fmt::format("no {}, or a --setup that names one", missing));
  if (auto s = check_times(plan); !s) return std::unexpected(s.error());
  plan.name = inputs.setup && !inputs.setup->name.empty() ? inputs.setup->name : plan.motion.stem().string();
  return inputs;
}

Result<AnalysisPlan> plan_analysis(const AnalysisJob& job, AnalysisInputs inputs,
                                   const data::ModelDescription& model) {
  AnalysisPlan plan = std::move(inputs.plan);
  // Without a setup everything is of interest; with one, what it lists and what the job adds.
  io::AnalysisSetup asked =
      inputs.setup.value_or(io::AnalysisSetup{.kinematics = io::KinematicsAnalysis{.coordinates = {"all"}},
                                              .bodies = io::BodyKinematicsAnalysis{.bodies = {"all"}}});
  if (!job.bodies.empty()) {
    if (!asked.bodies) asked.bodies.emplace();
    asked.bodies->bodies = job.bodies;
  }
  for (const auto& point : job.points)
    asked.points.push_back(
        {.point = point.name, .body = point.body, .relative_to = "ground", .x_in_body = point.x_in_body});
  if (asked.kinematics)
    if (auto s = plan_coordinates(model, *asked.kinematics, plan); !s) return std::unexpected(s.error());
  if (asked.bodies)
    if (auto s = plan_bodies(model, *asked.bodies, plan); !s) return std::unexpected(s.error());
  for (const auto& point : asked.points)
    if (auto s = plan_point(model, point, plan); !s) return std::unexpected(s.error());
  if (asked.torques || job.torques || !job.forces.empty())
    plan.torque_file = asked.force_file.empty() ? plan.name + "_inverse_dynamics.sto" : asked.force_file;
  else
    plan.forces.clear();
  plan.follow.error_bars = job.error_bars;
  plan.follow.threads = job.threads;
  if (plan.kinematics_name.empty() && plan.bodies_name.empty() && plan.point_names.empty() &&
      plan.torque_file.empty())
    return fail(Code::bad_input,
                fmt::format("{}: lists no analysis that is computed; need Kinematics, BodyKinematics, "
                            "PointKinematics or InverseDynamics",
                            job.setup.string()));
  return plan;
}

}  // namespace kinemark::pipeline::internal

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/problem.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>

#include "kinemark/core/counted.h"
#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/likely_pairs.h"
#include "kinemark/data/name_index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {
namespace {

std::string list(const std::vector<std::string>& names) {
  return names.empty() ? "none" : join_some(names, 12);
}

bool ever_seen(const data::Trajectories& markers, std::int64_t m) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (markers.present(f, m)) return true;
  return false;
}

/// Markers of the model that the recording probably has under other names.
void note_likely_names(const std::vector<data::MarkerDescription>& described,
                       const std::vector<std::string>& recorded, data::MarkerFit& fit) {
  std::vector<std::string> names;
  for (const auto& marker : described) names.push_back(marker.name);
  const auto pairs = data::find_likely_pairs(names, recorded);
  if (const auto option = data::rename_option(pairs); !option.empty())
    fit.warnings.push_back(fmt::format("{} of the model, not in the recording, may be there under {}: {}",
                                       counted(std::ssize(pairs), "marker"),
                                       pairs.size() == 1 ? "another name" : "other names", option));
}

Status match_markers(const model::Model& model, const data::Trajectories& markers, const IkOptions& options,
                     Problem& problem, data::ModelDescription& reduced) {
  const auto& described = model.description().markers;
  const data::NameIndex index(markers.names);
  std::map<std::string, double, std::less<>> weights;
  for (const auto& [name, weight] : options.marker_weights) {
    if (model.description().find_marker(name) < 0 && index.find(name) < 0)
      return fail(Code::bad_input, fmt::format("a weight names marker '{}', which neither the model nor the "
                                               "recording has; the recording has {}",
                                               name, index.instead_of(name)));
    weights[name] = weight;
  }
  std::vector<bool> used(markers.names.size(), false);
  reduced.markers.clear();
  auto& fit = problem.fit;
  std::vector<data::ExcludedMarker> model_only;
  std::vector<double> used_weights;
  for (const auto& marker : described) {
    const auto recorded = index.find(marker.name);
    if (recorded < 0) {
      const bool several = index.ambiguous(marker.name);
      model_only.push_back({marker.name, std::string(several ? data::kAmbiguous : data::kNotInRecording)});
      continue;
    }
    used[at(recorded)] = true;
    const auto w = weights.find(marker.name);
    const double weight = w == weights.end() ? options.default_marker_weight : w->second;
    const bool seen = ever_seen(markers, recorded);
    if (weight == 0.0 || !seen) {
      fit.excluded.push_back({marker.name, std::string(seen ? data::kNoWeight : data::kNeverSeen)});
      continue;
    }
    reduced.markers.push_back(marker);
    problem.data_marker.push_back(static_cast<int>(recorded));
    used_weights.push_back(weight);
    fit.markers.push_back(
        {.name = marker.name, .name_in_data = markers.names[at(recorded)], .weight = weight});
  }
  if (described.empty())
    return fail(Code::bad_input,
                fmt::format("model '{}' has no markers; need at least one", model.description().name));
  if (reduced.markers.empty() && !fit.excluded.empty()) {
    std::vector<std::string> names;
    for (const auto& marker : fit.excluded) names.push_back(marker.name);
    return fail(
        Code::bad_input,
        fmt::format("every marker that model and recording share has the weight 0 or is never seen: {}",
                    list(names)));
  }
  if (reduced.markers.empty()) {
    std::vector<std::string> names;
    for (const auto& marker : described) names.push_back(marker.name);
    return fail(Code::bad_input,
                fmt::format("no marker in common: the model has {}; the recording has {}{}", list(names),
                            list(markers.names), data::rename_proposal(names, markers.names)));
  }
  if (!model_only.empty()) note_likely_names(described, markers.names, fit);
  std::ranges::move(model_only, std::back_inserter(fit.excluded));
  for (std::size_t m = 0; m < used.size(); ++m)
    if (!used[m]) fit.excluded.push_back({markers.names[m], std::string(data::kNotInModel)});
  problem.weight =
      Eigen::Map<const Eigen::VectorXd>(used_weights.data(), static_cast<Eigen::Index>(used_weights.size()));
  return {};
}

Status set_coordinate_tasks(const model::Model& model, const IkOptions& options, Problem& problem) {
  for (const auto& task : options.coordinate_tasks) {
    const int c = model.description().find_coordinate(task.coordinate);
    if (c < 0)
      return fail(Code::bad_input, fmt::format("a task names coordinate '{}', which the model does not have",
                                               task.coordinate));
    if (!task.values.empty() && static_cast<std::int64_t>(task.values.size()) != problem.frames)
      return fail(Code::bad_input, fmt::format("the task of coordinate '{}' has {} values for {} frames",
                                               task.coordinate, task.values.size(), problem.frames));
    if (std::any_of(task.values.begin(), task.values.end(), [](double v) { return !std::isfinite(v); }))
      return fail(Code::bad_input, fmt::format("the task of coordinate '{}' has a value that is not a number",
                                               task.coordinate));
    if (task.weight > 0.0) problem.coordinate_tasks.push_back({c, task.weight, task.value, task.values});
  }
  return {};
}

void find_limits(const model::Model& model, const IkOptions& options, Problem& problem) {
  const int n = model.speed_count();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  problem.fixed_speed.assign(static_cast<std::size_t>(n), 0);
  problem.lower.setConstant(n, -infinity);
  problem.upper.setConstant(n, infinity);
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& described = model.description().coordinates[static_cast<std::size_t>(c)];
    const int speed = model.coordinates()[static_cast<std::size_t>(c)].speed_idx;
    if (speed < 0) continue;
    if (described.held()) problem.fixed_speed[static_cast<std::size_t>(speed)] = 1;
    if (options.limits && described.clamped && !described.held()) {
      problem.lower[speed] = described.range_min;
      problem.upper[speed] = described.range_max;
    }
  }
}

Status find_prescribed(const model::Model& model, const TimeBase& time, Problem& problem) {
  for (int c = 0; c < model.coordinate_count(); ++c) {
    const auto& described = model.description().coordinates[at(c)];
    const auto& coordinate = model.coordinates()[at(c)];
    if (!described.prescribed || coordinate.speed_idx < 0) continue;
    Problem::Prescribed values{.name = described.name, .state = coordinate.state_idx, .values = {}};
    for (std::int64_t f = 0; f < problem.frames; ++f) {
      const double t = time.time_s(problem.first_frame + f), value = (*described.prescribed)(t).f;
      if (!std::isfinite(value))
        return fail(Code::bad_input,
                    fmt::format("the function that prescribes coordinate '{}' has no finite value at {} s",
                                described.name, t));
      values.values.push_back(value);
    }
    problem.prescribed.push_back(std::move(values));
  }
  return {};
}

void name_bodies(const model::Model& model, data::MarkerFit& fit) {
  for (std::size_t m = 0; m < fit.markers.size(); ++m) {
    const int body = model.markers()[m].body;
    const auto& bodies = model.description().bodies;
    fit.markers[m].body = body < 0 ? "ground" : bodies[at(model.bodies()[at(body)].description_idx)].name;
  }
}

/// RMS distance of points from their centre.
double spread(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& p : points) centre += p / static_cast<double>(points.size());
  double squares = 0.0;
  for (const auto& p : points) squares += (p - centre).squaredNorm();
  return std::sqrt(squares / static_cast<double>(points.size()));
}

// Motion of a body changes the spread of its markers, but never a hundredfold: the unit must be wrong.
Status check_units(const Problem& problem, const data::Trajectories& markers) {
  model::Workspace w(problem.model);
  model::kinematics(problem.model, w, problem.model.default_state());
  for (std::int64_t f = 0; f < problem.frames; ++f) {
    std::vector<Eigen::Vector3d> recorded, modelled;
    for (std::size_t m = 0; m < problem.data_marker.size(); ++m) {
      if (!markers.present(problem.first_frame + f, problem.data_marker[m])) continue;
      recorded.emplace_back(markers.x(problem.first_frame + f, problem.data_marker[m]));
      modelled.emplace_back(w.marker.col(static_cast<Eigen::Index>(m)));
    }
    if (2 * recorded.size() <= problem.data_marker.size() || recorded.size() < 3) continue;
    const double ratio = spread(recorded) / spread(modelled);
    if (ratio < 100.0 && ratio > 0.01) return {};
    return fail(
        Code::bad_input,
        fmt::format(
            "the recorded markers spread over {:.3g} m, the model's over {:.3g} m; a factor of {:.3g} looks "
            "like a wrong unit",
            spread(recorded), spread(modelled), ratio > 1.0 ? ratio : 1.0 / ratio));
  }
  return {};
}

}  // namespace

int Problem::speed_of(int coordinate) const {
  const auto coordinates = model.coordinates();
  while (coordinates[static_cast<std::size_t>(coordinate)].source >= 0)
    coordinate = coordinates[static_cast<std::size_t>(coordinate)].source;
  return coordinates[static_cast<std::size_t>(coordinate)].speed_idx;
}

void Problem::prescribe(std::int64_t frame, Eigen::Ref<Eigen::VectorXd> x) const {
  for (const auto& one : prescribed) x[one.state] = one.values[at(frame)];
}

void Problem::observe(const data::Trajectories& markers, std::int64_t f, Eigen::Matrix3Xd& y,
                      Eigen::VectorXd& w) const {
  for (std::size_t m = 0; m < data_marker.size(); ++m) {
    const auto i = static_cast<Eigen::Index>(m);
    const bool seen = markers.present(first_frame + f, data_marker[m]);
    w[i] = seen ? weight[i] : 0.0;
    if (seen)
      y.col(i) = markers.x(first_frame + f, data_marker[m]);
    else
      y.col(i).setZero();
  }
}

Result<Problem> make_problem(const model::Model& model, const data::Trajectories& markers,
                             const IkOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  if (auto status = markers.validate(); !status) return std::unexpected(status.error());
  Problem problem;
  const double slack = kTimeSlack / markers.time.rate_hz;
  std::int64_t last = -1;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const double t = markers.time.time_s(f);
    if (t < options.first_time_s - slack || t > options.last_time_s + slack) continue;
    if (last < 0) problem.first_frame = f;
    last = f;
  }
  if (last < 0) {
    const auto bound = [](double t) {
      return std::abs(t) < 1e299 ? fmt::format("{} s", t) : std::string("the end");
    };
    return fail(
        Code::bad_input,
        fmt::format("no frame in the time range from {} to {}; the recording has {} frames from {} to {} s",
                    options.first_time_s > -1e299 ? bound(options.first_time_s) : "the beginning",
                    bound(options.last_time_s), markers.frames(), markers.time.t0_s,
                    markers.time.time_s(std::max<std::int64_t>(0, markers.frames() - 1))));
  }
  problem.frames = last - problem.first_frame + 1;
  data::ModelDescription reduced = model.description();
  if (auto status = match_markers(model, markers, options, problem, reduced); !status)
    return std::unexpected(status.error());
  if (auto status = set_coordinate_tasks(model, options, problem); !status)
    return std::unexpected(status.error());
  auto compiled = model::Model::compile(std::move(reduced), {.free_roots = !model.free_joints().empty()});
  if (!compiled) return std::unexpected(compiled.error());
  problem.model = std::move(*compiled);
  problem.fit.first_frame = problem.first_frame;
  name_bodies(problem.model, problem.fit);
  find_limits(problem.model, options, problem);
  if (auto status = find_prescribed(problem.model, markers.time, problem); !status)
    return std::unexpected(status.error());
  if (auto status = check_units(problem, markers); !status) return std::unexpected(status.error());
  return problem;
}

}  // namespace kinemark::motion::internal

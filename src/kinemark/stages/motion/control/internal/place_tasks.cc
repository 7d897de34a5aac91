// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/place_tasks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/motion/control/internal/body_name.h"
#include "kinemark/stages/motion/control/internal/goal_task.h"
#include "kinemark/stages/motion/control/tasks.h"

namespace kinemark::motion::internal {
namespace {

using Kind = NamedTask::Kind;

constexpr double kHeldLever_m = 1.0;  // a held angle of 1 rad counts like a marker's metre

/// What a task asks of the model, so that the same is found again under another name.
struct Wanted {
  std::string key;                   // empty: nothing yet
  std::string what;                  // as a sentence calls it
  std::vector<std::string> markers;  // that its goal is made of
};

template <class Described>
std::vector<std::string> names_of(const std::vector<Described>& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

std::unexpected<Error> absent(const NamedTask& task, const std::string& what, const std::string& name,
                              const std::vector<std::string>& names) {
  return fail(Code::usage, fmt::format("task '{}' names {} '{}', which the model does not have{}", task.text,
                                       what, name, nearest_of(name, names)));
}

Result<Wanted> find_body(const model::Model& model, const NamedTask& task) {
  const auto body = body_by_name(model, task.name);
  if (!body) return absent(task, "body", task.name, names_of(model.description().bodies));
  Wanted wanted{.key = fmt::format("body {}", *body), .what = fmt::format("orientation of '{}'", task.name)};
  for (int m = 0; m < model.marker_count(); ++m)
    if (model.markers()[at(m)].body == *body)
      wanted.markers.push_back(model.description().markers[at(m)].name);
  return wanted;
}

/// Two markers, in their order in the text.
Result<std::pair<std::string, std::string>> split_pair(const model::Model& model, const NamedTask& task) {
  const auto known = [&](const std::string& name) { return model.description().find_marker(name) >= 0; };
  std::pair<std::string, std::string> pair, guess;
  for (auto dash = task.name.find('-'); dash != std::string::npos; dash = task.name.find('-', dash + 1)) {
    pair = {task.name.substr(0, dash), task.name.substr(dash + 1)};
    if (known(pair.first) && known(pair.second)) return pair;
    if (guess.first.empty() || known(pair.first) || known(pair.second)) guess = pair;
  }
  return absent(task, "marker", known(guess.first) ? guess.second : guess.first,
                names_of(model.description().markers));
}

Result<Wanted> find_distance(const model::Model& model, const NamedTask& task) {
  auto pair = split_pair(model, task);
  if (!pair) return std::unexpected(pair.error());
  Wanted wanted{.key = {},
                .what = fmt::format("distance of '{}' and '{}'", pair->first, pair->second),
                .markers = {pair->first, pair->second}};
  if (pair->second < pair->first) std::swap(pair->first, pair->second);
  wanted.key = fmt::format("distance {}\n{}", pair->first, pair->second);
  return wanted;
}

Status check_value(const data::CoordinateDescription& coordinate, const NamedTask& task, bool limits) {
  const bool wrong = task.unit == (coordinate.is_rotation ? NamedTask::Unit::length : NamedTask::Unit::angle);
  if (wrong)
    return fail(Code::usage, fmt::format("task '{}': coordinate '{}' is {}; give it in {}", task.text,
                                         coordinate.name, coordinate.is_rotation ? "an angle" : "a length",
                                         coordinate.is_rotation ? "deg or rad" : "m or mm"));
  if (!limits || !coordinate.clamped ||
      !(task.value < coordinate.range_min || task.value > coordinate.range_max))
    return {};
  const double unit = coordinate.is_rotation ? kDegPerRad : 1.0;
  return fail(Code::usage,
              fmt::format("task '{}': coordinate '{}' ranges from {:.4g} to {:.4g} {} in the model",
                          task.text, coordinate.name, unit * coordinate.range_min,
                          unit * coordinate.range_max, coordinate.is_rotation ? "deg" : "m"));
}

Result<Wanted> find_coordinate(const model::Model& model, const NamedTask& task,
                               const TrackOptions& options) {
  const auto& description = model.description();
  const int c = description.find_coordinate(task.name);
  if (c < 0) return absent(task, "coordinate", task.name, names_of(description.coordinates));
  const auto& coordinate = description.coordinates[at(c)];
  if (model.coordinates()[at(c)].speed_idx < 0)
    return fail(
        Code::usage,
        fmt::format("task '{}': coordinate '{}' belongs to a free root or follows another one; name an "
                    "orientation, or the coordinate that it follows",
                    task.text, task.name));
  if (coordinate.held() || std::ranges::find(options.locked, task.name) != options.locked.end())
    return fail(Code::usage, fmt::format("task '{}': coordinate '{}' is locked and cannot be moved to a goal",
                                         task.text, task.name));
  if (auto status = check_value(coordinate, task, options.limits); !status)
    return std::unexpected(status.error());
  return Wanted{.key = fmt::format("coordinate {}", c), .what = fmt::format("coordinate '{}'", task.name)};
}

Result<Wanted> find_axis(const NamedTask& task) {
  if (task.name != "x" && task.name != "y" && task.name != "z")
    return fail(Code::usage, fmt::format("task '{}' names axis '{}'; need x, y or z", task.text, task.name));
  if (task.unit == NamedTask::Unit::angle)
    return fail(Code::usage,
                fmt::format("task '{}': a centre of mass has no angle; give it in m or mm", task.text));
  return Wanted{.key = "mass centre " + task.name, .what = fmt::format("centre of mass along {}", task.name)};
}

Result<Wanted> find_wanted(const model::Model& model, const NamedTask& task, const TrackOptions& options) {
  switch (task.kind) {
    case Kind::orientation:
      return find_body(model, task);
    case Kind::coordinate:
      return find_coordinate(model, task, options);
    case Kind::distance:
      return find_distance(model, task);
    case Kind::mass_centre:
      break;
  }
  return find_axis(task);
}

}  // namespace

std::string nearest_of(const std::string& name, const std::vector<std::string>& names) {
  const auto near = nearest_names(name, names, 1);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near.front());
}

Result<std::set<std::string>> markers_of_tasks(const model::Model& model, const TrackOptions& options) {
  std::set<std::string> markers;
  std::map<std::string, std::size_t> level_of;
  for (std::size_t i = 0; i < options.levels.size(); ++i)
    for (const auto& task : options.levels[i].named) {
      const auto wanted = find_wanted(model, task, options);
      if (!wanted) return std::unexpected(wanted.error());
      const auto [other, fresh] = level_of.try_emplace(wanted->key, i);
      if (!fresh)
        return fail(Code::usage,
                    fmt::format("{} is asked for in level {} and again in level {}; once is enough",
                                wanted->what, other->second + 1, i + 1));
      markers.insert(wanted->markers.begin(), wanted->markers.end());
    }
  return markers;
}

void place_named(const TrackLevel& asked, const Eigen::VectorXd& rest, Plan& plan, Plan::Level& level) {
  const auto& model = plan.problem.model;
  const TimeBase still{.rate_hz = plan.rate_hz, .t0_s = 0.0, .frames = 1};
  for (const auto& task : asked.named) {
    Plan::Level::About about{.text = task.text};
    std::shared_ptr<GoalTask> made;
    switch (task.kind) {
      case Kind::orientation:
        made = orientation_of_markers(task.name, plan.problem.weight);
        about.is_angle = true;
        break;
      case Kind::distance: {
        const auto pair = split_pair(model, task);
        // A marker that is not tracked is named by the task itself.
        const auto dash = task.name.find('-');
        made = pair ? distance_of_markers(pair->first, pair->second)
                    : distance_of_markers(task.name.substr(0, dash), task.name.substr(dash + 1));
        break;
      }
      case Kind::coordinate: {
        const int c = model.description().find_coordinate(task.name);
        const double value = std::isnan(task.value) ? rest[c] : task.value;
        level.tasks.push_back(coordinate_task(task.name, {value}, still, kHeldLever_m));
        about.is_angle = model.description().coordinates[at(c)].is_rotation;
        about.is_held = true;
        plan.held.push_back({.coordinate = c, .value = value});
        break;
      }
      case Kind::mass_centre:
        // It moves with all of them; a single one would be too light beside the damping.
        about.points = std::max(1.0, static_cast<double>(model.marker_count()));
        level.tasks.push_back(mass_centre_task(task.name.front() - 'x', {task.value}, still, about.points));
        about.is_held = true;
        break;
    }
    about.made = made.get();
    if (made) level.tasks.push_back(std::move(made));
    level.about.push_back(std::move(about));
  }
}

}  // namespace kinemark::motion::internal

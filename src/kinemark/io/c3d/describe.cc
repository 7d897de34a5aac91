// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/describe.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "kinemark/core/distinct_names.h"
#include "kinemark/io/c3d/force_plates.h"
#include "kinemark/io/c3d/internal/count.h"

namespace kinemark::io {
namespace {

using Warnings = std::vector<std::string>;

/// Cut or fill up to `count` names, then make each one unique.
std::vector<std::string> settle_names(std::vector<std::string> names, std::int64_t count,
                                      std::string_view what, std::string_view parameter, Warnings& warnings) {
  const auto n = static_cast<std::size_t>(count);
  names.resize(n);
  std::size_t unnamed = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!names[i].empty()) continue;
    ++unnamed;
    names[i] = fmt::format("{} {}", what, i + 1);
  }
  const RepeatedNames repeated = make_distinct(names);
  if (unnamed > 0)
    warnings.push_back(fmt::format("{} names {} of {} {}s; the others are called '{} n'", parameter,
                                   n - unnamed, n, what, what));
  if (repeated.changed > 0)
    warnings.push_back(fmt::format("{} repeats {} names ('{}' is the first); a number is added to each",
                                   parameter, repeated.changed, repeated.example));
  return names;
}

std::string maker(const C3dParameters& p) {
  const std::string company = p.text("MANUFACTURER", "COMPANY");
  std::string software = p.text("MANUFACTURER", "SOFTWARE");
  if (software.empty()) software = p.text("MANUFACTURER", "SOFTWARE_VERSION");
  if (company.empty() || software.starts_with(company)) return software;
  return software.empty() ? company : company + " " + software;
}

/// Vicon's group holds times on the recording's clock as (minutes, seconds); BKIN's looks the same.
bool events_from_group(const C3dParameters& p, std::string_view group, data::Trial& trial) {
  const std::vector<double> times = p.numbers(group, "TIMES");
  const auto used = p.number(group, "USED");
  const std::size_t there = times.size() / 2;
  const std::size_t n = used ? internal::bounded_count(*used, there) : there;
  if (used && *used > static_cast<double>(there))
    trial.warnings.push_back(
        fmt::format("{}:USED states {} events, {}:TIMES holds {}", group, *used, group, there));
  if (n == 0) return false;
  const std::vector<std::string> labels = p.texts(group, "LABELS");
  const std::vector<std::string> contexts = p.texts(group, "CONTEXTS");
  for (std::size_t i = 0; i < n; ++i) {
    const double time_s = 60.0 * times[2 * i] + times[2 * i + 1];
    if (!std::isfinite(time_s)) continue;
    trial.events.push_back({.label = i < labels.size() ? labels[i] : "",
                            .context = i < contexts.size() ? contexts[i] : "",
                            .time_s = time_s});
  }
  return true;
}

void read_events(const C3dHeader& header, const C3dParameters& p, data::Trial& trial) {
  if (events_from_group(p, "EVENT", trial) || events_from_group(p, "EVENTS", trial)) return;
  // The header counts from the first frame of the file.
  for (const C3dHeaderEvent& event : header.events)
    trial.events.push_back(
        {.label = event.label, .context = "", .time_s = trial.markers.time.t0_s + event.time_s});
}

}  // namespace

void describe_trial(const C3dHeader& header, const C3dParameters& parameters, const C3dLayout& layout,
                    data::Trial& trial) {
  Warnings& warnings = trial.warnings;
  trial.format = "C3D";
  trial.units_in_file = layout.units;
  trial.software = maker(parameters);
  trial.first_frame = layout.first_frame;
  trial.markers.time = {
      .rate_hz = layout.rate_hz,
      .t0_s = static_cast<double>(std::max<std::int64_t>(0, layout.first_frame - 1)) / layout.rate_hz,
      .frames = layout.frames};
  trial.markers.names =
      settle_names(parameters.texts("POINT", "LABELS"), layout.points, "point", "POINT:LABELS", warnings);
  trial.analog.names = settle_names(parameters.texts("ANALOG", "LABELS"), layout.analog_channels, "channel",
                                    "ANALOG:LABELS", warnings);
  trial.analog.units = parameters.texts("ANALOG", "UNITS");
  trial.analog.units.resize(trial.analog.names.size());
  trial.analog.rate_hz = layout.rate_hz * static_cast<double>(layout.samples_per_frame);
  if (layout.points == 0)
    warnings.push_back(parameters.has_group("ROTATION")
                           ? "has no points, only a ROTATION group (orientations of segments), which "
                             "'kinemark ik --orientations' reads"
                           : "has no points");
  read_events(header, parameters, trial);
  trial.force_plates = find_force_plates(parameters, layout, warnings);
  trial.unloaded_s = unloaded_times(parameters, trial.markers.time, warnings);
}

}  // namespace kinemark::io

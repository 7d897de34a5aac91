// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/describe.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

namespace kinemark::io {
namespace {

using Warnings = std::vector<std::string>;

/// Cut or fill up to `count` names, then make each one unique.
std::vector<std::string> settle_names(std::vector<std::string> names, std::int64_t count,
                                      std::string_view what, std::string_view parameter, Warnings& warnings) {
  const auto n = static_cast<std::size_t>(count);
  names.resize(n);
  std::set<std::string, std::less<>> used;
  std::size_t unnamed = 0;
  std::size_t twice = 0;
  std::string example;
  for (std::size_t i = 0; i < n; ++i) {
    if (names[i].empty()) {
      ++unnamed;
      names[i] = fmt::format("{} {}", what, i + 1);
    }
    if (used.insert(names[i]).second) continue;
    ++twice;
    if (example.empty()) example = names[i];
    std::string other;
    int suffix = 2;
    do other = fmt::format("{}_{}", names[i], suffix++);
    while (!used.insert(other).second);
    names[i] = std::move(other);
  }
  if (unnamed > 0)
    warnings.push_back(fmt::format("{} names {} of {} {}s; the others are called '{} n'", parameter,
                                   n - unnamed, n, what, what));
  if (twice > 0)
    warnings.push_back(fmt::format("{} repeats {} names ('{}' is the first); a number is added to each",
                                   parameter, twice, example));
  return names;
}

std::string maker(const C3dParameters& p) {
  const std::string company = p.text("MANUFACTURER", "COMPANY");
  std::string software = p.text("MANUFACTURER", "SOFTWARE");
  if (software.empty()) software = p.text("MANUFACTURER", "SOFTWARE_VERSION");
  if (company.empty() || software.starts_with(company)) return software;
  return software.empty() ? company : company + " " + software;
}

/// A count that a file gives as any number, NaN included.
std::size_t bounded(double value, std::size_t most) {
  return value >= 0.0 ? static_cast<std::size_t>(std::min(value, static_cast<double>(most))) : 0;
}

/// Vicon's group holds times on the recording's clock as (minutes, seconds); BKIN's looks the same.
bool events_from_group(const C3dParameters& p, std::string_view group, data::Trial& trial) {
  const std::vector<double> times = p.numbers(group, "TIMES");
  const auto used = p.number(group, "USED");
  const std::size_t there = times.size() / 2;
  const std::size_t n = used ? bounded(*used, there) : there;
  if (used && *used > static_cast<double>(there))
    trial.warnings.push_back(
        fmt::format("{}:USED promises {} events, {}:TIMES holds {}", group, *used, group, there));
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

std::size_t channels_of_type(int type, std::size_t rows) {
  switch (type) {
    case 1:
    case 2:
    case 4:
      return std::min<std::size_t>(6, rows);
    case 3:
    case 5:
    case 7:
      return std::min<std::size_t>(8, rows);
    default:
      return rows;
  }
}

Eigen::Vector3d metres3(const std::vector<double>& values, std::size_t at, double metres) {
  return at + 3 <= values.size()
             ? Eigen::Vector3d(metres * Eigen::Map<const Eigen::Vector3d>(values.data() + at))
             : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

void read_force_plates(const C3dParameters& p, const C3dLayout& layout, data::Trial& trial) {
  constexpr double kFar = 1000.0;  // m; a corner further away is a number gone wrong
  const std::size_t used = bounded(p.number("FORCE_PLATFORM", "USED").value_or(0.0), 255);
  const C3dParameter* channels = p.find("FORCE_PLATFORM", "CHANNEL");
  const C3dParameter* calibrations = p.find("FORCE_PLATFORM", "CAL_MATRIX");
  const std::vector<double> types = p.numbers("FORCE_PLATFORM", "TYPE");
  const std::vector<double> corners = p.numbers("FORCE_PLATFORM", "CORNERS");
  const std::vector<double> origins = p.numbers("FORCE_PLATFORM", "ORIGIN");
  const std::size_t rows =
      channels != nullptr && !channels->dims.empty() ? static_cast<std::size_t>(channels->dims[0]) : 0;
  for (std::size_t i = 0; i < used; ++i) {
    data::ForcePlate plate;
    plate.type = i < types.size() ? static_cast<int>(bounded(types[i], 1000)) : 0;
    bool good = plate.type > 0 && rows > 0;
    for (std::size_t r = 0; good && r < channels_of_type(plate.type, rows); ++r) {
      const std::size_t at = i * rows + r;
      const double channel = at < channels->numbers.size() ? channels->numbers[at] : 0.0;
      good = channel >= 1.0 && channel <= static_cast<double>(layout.analog_channels);
      if (good) plate.channel_idx.push_back(static_cast<int>(channel) - 1);
    }
    if (!good) {
      trial.warnings.push_back(
          fmt::format("force plate {} is left out: its type or its analog channels make no sense", i + 1));
      continue;
    }
    bool sound = true;
    for (std::size_t c = 0; c < 4; ++c) {
      plate.corners_in_world[c] = metres3(corners, 12 * i + 3 * c, layout.metres_per_unit);
      sound = sound && plate.corners_in_world[c].cwiseAbs().maxCoeff() < kFar;
    }
    plate.origin_in_plate = metres3(origins, 3 * i, layout.metres_per_unit);
    sound = sound && plate.origin_in_plate.cwiseAbs().maxCoeff() < kFar;
    if (calibrations != nullptr && calibrations->dims.size() >= 2) {
      const std::size_t size =
          static_cast<std::size_t>(calibrations->dims[0]) * static_cast<std::size_t>(calibrations->dims[1]);
      if (size > 0 && (i + 1) * size <= calibrations->numbers.size()) {
        const auto begin = calibrations->numbers.begin() + static_cast<std::ptrdiff_t>(i * size);
        plate.calibration.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
      }
    }
    if (!sound)
      trial.warnings.push_back(
          fmt::format("force plate {} has corners or an origin that make no sense", i + 1));
    trial.force_plates.push_back(std::move(plate));
  }
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
    warnings.push_back(
        parameters.has_group("ROTATION")
            ? "has no points, only a ROTATION group (orientations of segments), which is not read"
            : "has no points");
  read_events(header, parameters, trial);
  read_force_plates(parameters, layout, trial);
}

}  // namespace kinemark::io

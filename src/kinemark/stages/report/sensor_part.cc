// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/sensor_part.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/json_parts.h"

namespace kinemark::report::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDecimals = 4;  // of degrees

Json degrees(double rad) { return number(kDegPerRad * rad, kDecimals); }

/// Angles added up.
struct AngleSum {
  double squares = 0.0, largest = kNaN;
  std::int64_t count = 0, largest_at = -1;

  void add(double angle, std::int64_t where) {
    if (std::isnan(angle)) return;
    squares += angle * angle;
    ++count;
    if (largest >= angle) return;
    largest = angle;
    largest_at = where;
  }
  [[nodiscard]] double rms() const {
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : kNaN;
  }
};

}  // namespace

double sensor_error_deg(const ReportSensors& sensors, std::int64_t frame, std::int64_t sensor) {
  return kDegPerRad * sensors.error_rad[at(frame * std::ssize(sensors.rows) + sensor)];
}

double sensor_rms_deg(const ReportSensors& sensors, std::int64_t frame) {
  AngleSum sum;
  for (std::int64_t s = 0; s < std::ssize(sensors.rows); ++s) sum.add(sensor_error_deg(sensors, frame, s), s);
  return sum.rms();
}

Json sensors_json(const ReportSensors& sensors, const TimeBase& time) {
  Json rows = Json::array();
  AngleSum all;
  for (std::int64_t s = 0; s < std::ssize(sensors.rows); ++s) {
    AngleSum sum;
    for (std::int64_t f = 0; f < time.frames; ++f) {
      sum.add(sensor_error_deg(sensors, f, s), f);
      all.add(sensor_error_deg(sensors, f, s), f);
    }
    const auto& row = sensors.rows[at(s)];
    rows.push_back({{"name", row.name},
                    {"body", row.body},
                    {"placed_by", row.placed_by},
                    {"seen_frames", sum.count},
                    {"rejected_samples", row.rejected_samples},
                    {"rms_deg", number(sum.rms(), kDecimals)},
                    {"max_deg", number(sum.largest, kDecimals)},
                    {"max_time_s", number(sum.largest_at < 0 ? kNaN : time.time_s(sum.largest_at), 6)}});
  }
  return {
      {"heading_deg", degrees(sensors.heading_rad)},   {"heading_sd_deg", degrees(sensors.heading_sd_rad)},
      {"heading_from", sensors.heading_from},          {"pose_drift_deg", degrees(sensors.pose_drift_rad)},
      {"noise_sd_deg", degrees(sensors.noise_sd_rad)}, {"rms_deg", number(all.rms(), kDecimals)},
      {"max_deg", number(all.largest, kDecimals)},     {"rows", std::move(rows)}};
}

data::Trajectories sensor_points(const ReportSensors& sensors, const SceneBodies& bodies,
                                 const TimeBase& time) {
  std::vector<std::int64_t> drawn, carriers;
  std::vector<std::string> names;
  for (std::int64_t s = 0; s < std::ssize(sensors.rows); ++s) {
    const auto body = std::ranges::find(bodies.names, sensors.rows[at(s)].body);
    if (body == bodies.names.end()) continue;
    drawn.push_back(s);
    carriers.push_back(body - bodies.names.begin());
    names.push_back(sensors.rows[at(s)].name);
  }
  auto out = data::Trajectories::all_missing(names, time);
  for (std::int64_t f = 0; f < time.frames; ++f)
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const auto m = static_cast<std::int64_t>(i);
      const auto place = 3 * at(f * std::ssize(bodies.names) + carriers[i]);
      const Eigen::Map<const Eigen::Vector3d> origin(bodies.origin_in_world.data() + place),
          end(bodies.end_in_world.data() + place);
      out.x(f, m) = 0.5 * (origin + end);
      out.state[out.index(f, m)] = sensors.state[at(f * std::ssize(sensors.rows) + drawn[i])];
    }
  return out;
}

}  // namespace kinemark::report::internal

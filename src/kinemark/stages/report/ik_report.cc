// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/ik_report.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/curve_block.h"
#include "kinemark/stages/report/internal/ik_scene.h"
#include "kinemark/stages/report/internal/page.h"
#include "kinemark/stages/report/internal/plot_points.h"
#include "kinemark/stages/report/internal/sensor_part.h"

namespace kinemark::report {

namespace {

using Json = nlohmann::ordered_json;
using data::JointMotion;
using data::SampleState;
using internal::PlotPoints;

/// Codes of the gap map, the worse the larger, so that a thinned point shows its worst frame.
enum class GapCode : std::uint8_t { measured, filled, missing, rejected };

GapCode gap_code(SampleState state) {
  switch (state) {
    case SampleState::measured:
      return GapCode::measured;
    case SampleState::interpolated:
    case SampleState::model_filled:
    case SampleState::upsampled:
      return GapCode::filled;
    case SampleState::missing:
      return GapCode::missing;
    case SampleState::rejected:
      return GapCode::rejected;
  }
  return GapCode::missing;
}

/// Ranks of data::FrameStatus, the worse the larger.
std::uint8_t status_rank(data::FrameStatus status) {
  switch (status) {
    case data::FrameStatus::converged:
      return 0;
    case data::FrameStatus::underdetermined:
      return 1;
    case data::FrameStatus::not_converged:
      return 2;
    case data::FrameStatus::no_markers:
      return 3;
  }
  return 3;
}

/// One series at a time is gathered here from the frame-first arrays, so that memory stays at one column.
struct Column {
  std::vector<double> values;
  std::vector<std::uint8_t> codes;

  explicit Column(std::int64_t frames) : values(frames, kNaN), codes(frames, 0) {}
};

/// What a plot shows, on the points of the page; a vector is empty where there is no such number.
struct Curve {
  std::vector<float> value, sd;
  std::vector<std::uint8_t> undetermined;
  double usual_step = internal::kUsualStep_mm;
};

struct Curves {
  std::vector<Curve> coordinates, torques, errors, sensors;
  Curve rms, sensor_rms;
  std::vector<std::vector<std::uint8_t>> gaps, sensor_gaps;
  std::vector<std::uint8_t> status;
};

Curve coordinate_curve(const JointMotion& motion, std::int64_t coordinate, const PlotPoints& points,
                       Column& column) {
  const bool is_rotation = motion.is_rotation[static_cast<std::size_t>(coordinate)];
  const double unit = is_rotation ? kDegPerRad : 1.0;
  bool any_undetermined = false, any_sd = false;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const std::size_t i = motion.index(f, coordinate);
    const bool determined = motion.determined.empty() || motion.determined[i] != 0;
    column.values[f] = determined ? unit * motion.q[i] : kNaN;
    column.codes[f] = determined ? 0 : 1;
    any_undetermined = any_undetermined || !determined;
  }
  Curve out{.value = points.extremes(column.values),
            .sd = {},
            .undetermined = {},
            .usual_step = is_rotation ? internal::kUsualStep_deg : internal::kUsualStep_m};
  if (any_undetermined) out.undetermined = points.worst(column.codes);
  for (std::int64_t f = 0; f < motion.frames() && !motion.q_sd.empty(); ++f) {
    column.values[f] = column.codes[f] == 0 ? unit * motion.q_sd[motion.index(f, coordinate)] : kNaN;
    any_sd = any_sd || std::isfinite(column.values[f]);
  }
  if (any_sd) out.sd = points.largest(column.values);
  return out;
}

/// N m or N of one coordinate and its standard deviation; nothing where the motion has none.
Curve torque_curve(const JointMotion& motion, std::int64_t coordinate, const PlotPoints& points,
                   Column& column) {
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    column.values[f] = motion.tau[motion.index(f, coordinate)];
  if (std::ranges::none_of(column.values, [](double v) { return std::isfinite(v); })) return {};
  Curve out{.value = points.extremes(column.values),
            .sd = {},
            .undetermined = {},
            .usual_step = internal::kUsualStep_nm};
  if (motion.tau_sd.empty()) return out;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    column.values[f] = motion.tau_sd[motion.index(f, coordinate)];
  out.sd = points.largest(column.values);
  return out;
}

std::vector<Curve> error_curves(const JointMotion& motion, const PlotPoints& points, Column& column) {
  std::vector<Curve> out;
  const std::size_t M = motion.markers.size();
  for (std::size_t m = 0; m < M && !motion.marker_error.empty(); ++m) {
    for (std::size_t f = 0; f < column.values.size(); ++f) {
      const double* e = motion.marker_error.data() + 3 * (f * M + m);
      column.values[f] = 1e3 * std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    }
    out.push_back({.value = points.extremes(column.values),
                   .sd = {},
                   .undetermined = {},
                   .usual_step = internal::kUsualStep_mm});
  }
  return out;
}

Curve rms_curve(const JointMotion& motion, const PlotPoints& points, Column& column) {
  const std::size_t M = motion.markers.size();
  for (std::size_t f = 0; f < column.values.size(); ++f) {
    double squares = 0.0;
    int seen = 0;
    for (std::size_t m = 0; m < M && !motion.marker_error.empty(); ++m) {
      const double* e = motion.marker_error.data() + 3 * (f * M + m);
      const double square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
      if (std::isnan(square)) continue;
      squares += square;
      ++seen;
    }
    column.values[f] = seen == 0 ? kNaN : 1e3 * std::sqrt(squares / seen);
  }
  return {.value = points.extremes(column.values),
          .sd = {},
          .undetermined = {},
          .usual_step = internal::kUsualStep_mm};
}

/// A row of the gap map per marker: from the states where they are given, otherwise seen or not.
std::vector<std::vector<std::uint8_t>> gap_rows(const IkReport& report, const PlotPoints& points,
                                                Column& column) {
  const JointMotion& motion = *report.motion;
  std::vector<std::vector<std::uint8_t>> out;
  const std::size_t M = motion.markers.size();
  for (std::size_t row = 0; row < report.summary.markers.size(); ++row) {
    const std::int64_t marker =
        report.markers == nullptr ? -1 : report.markers->find(report.summary.markers[row].name);
    if (marker < 0 && (row >= M || motion.marker_error.empty())) {
      out.emplace_back();
      continue;
    }
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const GapCode code = marker >= 0 ? gap_code(report.markers->state[report.markers->index(f, marker)])
                           : std::isnan(motion.marker_error[3 * (static_cast<std::size_t>(f) * M + row)])
                               ? GapCode::missing
                               : GapCode::measured;
      column.codes[f] = static_cast<std::uint8_t>(code);
    }
    out.push_back(points.worst(column.codes));
  }
  return out;
}

/// Angles between sensors and model, and a row of the gap map per sensor.
void gather_sensors(const ReportSensors& sensors, const PlotPoints& points, Column& column, Curves& out) {
  const auto F = static_cast<std::int64_t>(column.values.size());
  const auto add = [&](Curve& curve, const auto& value) {
    for (std::int64_t f = 0; f < F; ++f) column.values[at(f)] = value(f);
    curve = {.value = points.extremes(column.values),
             .sd = {},
             .undetermined = {},
             .usual_step = internal::kUsualStep_deg};
  };
  const auto S = std::ssize(sensors.rows);
  for (std::int64_t s = 0; s < S; ++s) {
    add(out.sensors.emplace_back(),
        [&](std::int64_t f) { return internal::sensor_error_deg(sensors, f, s); });
    for (std::int64_t f = 0; f < F; ++f)
      column.codes[at(f)] = static_cast<std::uint8_t>(gap_code(sensors.state[at(f * S + s)]));
    out.sensor_gaps.push_back(points.worst(column.codes));
  }
  add(out.sensor_rms, [&](std::int64_t f) { return internal::sensor_rms_deg(sensors, f); });
}

Curves gather(const IkReport& report, const PlotPoints& points) {
  const JointMotion& motion = *report.motion;
  Column column(motion.frames());
  Curves out;
  for (std::int64_t j = 0; j < motion.size(); ++j)
    out.coordinates.push_back(coordinate_curve(motion, j, points, column));
  for (std::int64_t j = 0; j < motion.size() && !motion.tau.empty(); ++j)
    out.torques.push_back(torque_curve(motion, j, points, column));
  out.rms = rms_curve(motion, points, column);
  out.errors = error_curves(motion, points, column);
  out.gaps = gap_rows(report, points, column);
  if (report.sensors != nullptr) gather_sensors(*report.sensors, points, column, out);
  std::ranges::fill(column.codes, std::uint8_t{0});
  std::ranges::transform(motion.status, column.codes.begin(), status_rank);
  out.status = points.worst(column.codes);
  return out;
}

Json pack_value(const Curve& curve, const PlotPoints& thinned) {
  const auto value = thinned.extremes(curve.value);
  return internal::pack_curve(value, internal::curve_step(value, curve.sd, curve.usual_step));
}

Json pack_deviation(const Curve& curve, const PlotPoints& thinned) {
  if (curve.sd.empty()) return nullptr;
  return internal::pack_deviations(thinned.largest(curve.sd));
}

Json pack_worst(const std::vector<std::uint8_t>& codes, const PlotPoints& thinned) {
  return codes.empty() ? Json(nullptr) : internal::pack_codes(thinned.worst(codes));
}

/// @param frame_step  of the curves, before they are thinned further
Json pack_curves(const Curves& curves, std::int64_t frame_step, const PlotPoints& thinned) {
  Json coordinates = Json::array(), torques = Json::array(), errors = Json::array(), gaps = Json::array();
  for (const Curve& c : curves.coordinates)
    coordinates.push_back({{"value", pack_value(c, thinned)},
                           {"sd", pack_deviation(c, thinned)},
                           {"undetermined", pack_worst(c.undetermined, thinned)}});
  for (const Curve& c : curves.torques)
    torques.push_back(c.value.empty()
                          ? Json(nullptr)
                          : Json{{"value", pack_value(c, thinned)}, {"sd", pack_deviation(c, thinned)}});
  for (const Curve& c : curves.errors) errors.push_back(pack_value(c, thinned));
  for (const auto& codes : curves.gaps) gaps.push_back(pack_worst(codes, thinned));
  Json sensors = Json::array(), sensor_gaps = Json::array();
  for (const Curve& c : curves.sensors) sensors.push_back(pack_value(c, thinned));
  for (const auto& codes : curves.sensor_gaps) sensor_gaps.push_back(pack_worst(codes, thinned));
  Json out = {{"frame_step", frame_step * thinned.step()},
              {"points", thinned.size()},
              {"coordinates", std::move(coordinates)},
              {"torques", std::move(torques)},
              {"rms_error_mm", pack_value(curves.rms, thinned)},
              {"marker_error_mm", std::move(errors)},
              {"gaps", std::move(gaps)},
              {"status", internal::pack_codes(thinned.worst(curves.status))}};
  if (curves.sensors.empty()) return out;
  out["sensor_error_deg"] = std::move(sensors);
  out["sensor_rms_deg"] = pack_value(curves.sensor_rms, thinned);
  out["sensor_gaps"] = std::move(sensor_gaps);
  return out;
}

}  // namespace

nlohmann::ordered_json report_json(const IkReport& report, const ReportOptions& options) {
  check(report.motion != nullptr, "a report needs a joint motion");
  check(options.check().has_value(), "report options are out of range");
  const JointMotion& motion = *report.motion;
  check(motion.validate().has_value(), "a report needs a valid joint motion");
  check(std::ssize(report.summary.coordinates) == motion.size() &&
            report.summary.markers.size() >= motion.markers.size() && report.summary.time == motion.time,
        "a report needs the summary of its own joint motion");
  check(report.markers == nullptr || report.markers->time == motion.time,
        "a report needs markers and joint motion of the same frames");
  check(report.sensors == nullptr ||
            (report.sensors->error_rad.size() == at(motion.frames()) * report.sensors->rows.size() &&
             report.sensors->state.size() == report.sensors->error_rad.size()),
        "a report needs an angle and a state of each sensor in each frame");

  // Half of the room is for the curves, the other for the space view.
  const PlotPoints points(motion.frames(), options.max_points);
  const Curves curves = gather(report, points);
  Json series = internal::pack_within(
      points.size(), options.max_data_bytes / 2,
      [&](const PlotPoints& thinned) { return pack_curves(curves, points.step(), thinned); });
  return {{"summary", summary_json(report.summary)},
          {"series", std::move(series)},
          {"cycles", cycles_json(report.cycles)},
          {"scene", internal::ik_scene_json(report, options.max_data_bytes / 2)},
          {"sensors",
           report.sensors == nullptr ? Json(nullptr) : internal::sensors_json(*report.sensors, motion.time)}};
}

std::string report_html(const IkReport& report, const ReportOptions& options) {
  return internal::fill_page(report_json(report, options));
}

}  // namespace kinemark::report

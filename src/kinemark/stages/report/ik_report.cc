// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/ik_report.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/report/internal/base64.h"
#include "kinemark/stages/report/internal/ik_scene.h"
#include "kinemark/stages/report/internal/page.h"
#include "kinemark/stages/report/internal/plot_points.h"

namespace kinemark::report {

namespace {

using Json = nlohmann::ordered_json;
using data::JointMotion;
using data::SampleState;
using internal::base64;
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

Json coordinate_series(const JointMotion& motion, std::int64_t coordinate, const PlotPoints& points,
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
  Json out = {{"value", base64(points.extremes(column.values))}, {"sd", nullptr}, {"undetermined", nullptr}};
  if (any_undetermined) out["undetermined"] = base64(points.worst(column.codes));
  for (std::int64_t f = 0; f < motion.frames() && !motion.q_sd.empty(); ++f) {
    column.values[f] = column.codes[f] == 0 ? unit * motion.q_sd[motion.index(f, coordinate)] : kNaN;
    any_sd = any_sd || std::isfinite(column.values[f]);
  }
  if (any_sd) out["sd"] = base64(points.largest(column.values));
  return out;
}

/// N m or N of one coordinate and its standard deviation; null where the motion has none.
Json torque_series(const JointMotion& motion, std::int64_t coordinate, const PlotPoints& points,
                   Column& column) {
  if (motion.tau.empty()) return nullptr;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    column.values[f] = motion.tau[motion.index(f, coordinate)];
  if (std::ranges::none_of(column.values, [](double v) { return std::isfinite(v); })) return nullptr;
  Json out = {{"value", base64(points.extremes(column.values))}, {"sd", nullptr}};
  if (motion.tau_sd.empty()) return out;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    column.values[f] = motion.tau_sd[motion.index(f, coordinate)];
  out["sd"] = base64(points.largest(column.values));
  return out;
}

Json error_series(const JointMotion& motion, const PlotPoints& points, Column& column) {
  Json out = Json::array();
  const std::size_t M = motion.markers.size();
  for (std::size_t m = 0; m < M && !motion.marker_error.empty(); ++m) {
    for (std::size_t f = 0; f < column.values.size(); ++f) {
      const double* e = motion.marker_error.data() + 3 * (f * M + m);
      column.values[f] = 1e3 * std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    }
    out.push_back(base64(points.extremes(column.values)));
  }
  return out;
}

std::string rms_series(const JointMotion& motion, const PlotPoints& points, Column& column) {
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
  return base64(points.extremes(column.values));
}

/// A row of the gap map per marker: from the states where they are given, otherwise seen or not.
Json gap_series(const IkReport& report, const PlotPoints& points, Column& column) {
  const JointMotion& motion = *report.motion;
  Json out = Json::array();
  const std::size_t M = motion.markers.size();
  for (std::size_t row = 0; row < report.summary.markers.size(); ++row) {
    const std::int64_t marker =
        report.markers == nullptr ? -1 : report.markers->find(report.summary.markers[row].name);
    if (marker < 0 && (row >= M || motion.marker_error.empty())) {
      out.push_back(nullptr);
      continue;
    }
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const GapCode code = marker >= 0 ? gap_code(report.markers->state[report.markers->index(f, marker)])
                           : std::isnan(motion.marker_error[3 * (static_cast<std::size_t>(f) * M + row)])
                               ? GapCode::missing
                               : GapCode::measured;
      column.codes[f] = static_cast<std::uint8_t>(code);
    }
    out.push_back(base64(points.worst(column.codes)));
  }
  return out;
}

std::string status_series(const JointMotion& motion, const PlotPoints& points, Column& column) {
  std::ranges::fill(column.codes, std::uint8_t{0});
  std::ranges::transform(motion.status, column.codes.begin(), status_rank);
  return base64(points.worst(column.codes));
}

PlotPoints plot_grid(const IkReport& report, const ReportOptions& options) {
  check(report.motion != nullptr, "a report needs a joint motion");
  check(options.check().has_value(), "report options are out of range");
  // Per point: value, SD and flag of a coordinate; error and gap code of a marker; RMS and status. Base64
  // adds a third.
  const auto coordinates = report.motion->size();
  const auto markers = std::ssize(report.summary.markers);
  const std::int64_t bytes =
      ((report.motion->tau.empty() ? 9 : 17) * coordinates + 5 * markers + 5) * 4 / 3 + 1;
  return {report.motion->frames(),
          std::max<std::int64_t>(2, std::min(options.max_points, options.max_series_bytes / bytes))};
}

}  // namespace

nlohmann::ordered_json report_json(const IkReport& report, const ReportOptions& options) {
  check(report.motion != nullptr, "a report needs a joint motion");
  const JointMotion& motion = *report.motion;
  check(motion.validate().has_value(), "a report needs a valid joint motion");
  check(std::ssize(report.summary.coordinates) == motion.size() &&
            report.summary.markers.size() >= motion.markers.size() && report.summary.time == motion.time,
        "a report needs the summary of its own joint motion");
  check(report.markers == nullptr || report.markers->time == motion.time,
        "a report needs markers and joint motion of the same frames");

  const PlotPoints points = plot_grid(report, options);
  Column column(motion.frames());
  Json coordinates = Json::array();
  for (std::int64_t j = 0; j < motion.size(); ++j)
    coordinates.push_back(coordinate_series(motion, j, points, column));
  Json torques = Json::array();
  for (std::int64_t j = 0; j < motion.size() && !motion.tau.empty(); ++j)
    torques.push_back(torque_series(motion, j, points, column));
  return {{"summary", summary_json(report.summary)},
          {"series",
           {{"frame_step", points.step()},
            {"points", points.size()},
            {"coordinates", std::move(coordinates)},
            {"torques", std::move(torques)},
            {"rms_error_mm", rms_series(motion, points, column)},
            {"marker_error_mm", error_series(motion, points, column)},
            {"gaps", gap_series(report, points, column)},
            {"status", status_series(motion, points, column)}}},
          {"scene", internal::ik_scene_json(report)}};
}

std::string report_html(const IkReport& report, const ReportOptions& options) {
  return internal::fill_page(report_json(report, options));
}

}  // namespace kinemark::report

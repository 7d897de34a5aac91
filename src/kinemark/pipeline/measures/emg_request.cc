// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/emg_request.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/table_cell.h"
#include "kinemark/stages/analysis/gait/cycle_curves.h"

namespace kinemark::pipeline {
namespace {

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// "L...", "R...", or a name with left or right in it; empty: neither.
std::string side_of_channel(const std::string& name) {
  const auto text = lowered(name);
  if (text.find("left") != std::string::npos) return "Left";
  if (text.find("right") != std::string::npos) return "Right";
  if (name.size() < 2 || text.starts_with("lat") || text.starts_with("rec")) return {};
  return name[0] == 'L' ? "Left" : name[0] == 'R' ? "Right" : "";
}

}  // namespace

Status EmgRequest::check() const {
  const auto ending = ending_of(write);
  if (!write.empty() && ending != ".sto" && ending != ".csv")
    return fail(Code::usage, fmt::format("{}: envelopes are written as .sto or .csv", write.string()));
  if (!write_cycles.empty() && ending_of(write_cycles) != ".csv")
    return fail(Code::usage, fmt::format("{}: cycles are written as .csv", write_cycles.string()));
  return {};
}

Result<workflow::EmgChoice> emg_choice(const EmgRequest& request) {
  workflow::EmgChoice out{
      .channels = request.channels, .envelope = request.envelope, .to_maximum = request.maximum == "trial"};
  if (request.maximum.empty() || out.to_maximum) return out;
  auto input = io::read_marker_input({.path = request.maximum});
  if (!input) return std::unexpected(input.error());
  out.maximum = std::make_shared<const data::Trial>(std::move(input->trial));
  out.maximum_name = request.maximum;
  return out;
}

data::Table envelope_table(const data::Trial& trial, const analysis::EmgMeasures& measured, bool per_cent) {
  data::Table out{.name = "EMG envelopes", .columns = measured.names};
  const auto& time = trial.markers.time;
  const double per_frame = trial.analog.rate_hz / time.rate_hz;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const auto sample =
        std::min<std::int64_t>(trial.analog.samples - 1, std::llround(static_cast<double>(f) * per_frame));
    out.time_s.push_back(time.time_s(f));
    for (const auto& envelope : measured.envelopes)
      out.values.push_back((per_cent ? 100.0 : 1.0) * envelope[sample]);
  }
  return out;
}

std::string envelope_csv(const data::Table& table) {
  std::string out = "time_s";
  for (const auto& name : table.columns) out += "," + table_cell(name);
  out += "\n";
  for (std::int64_t r = 0; r < table.rows(); ++r) {
    out += fmt::format("{:.6f}", table.time_s[at(r)]);
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      out += "," + table_cell(table(r, static_cast<std::int64_t>(c)));
    out += "\n";
  }
  return out;
}

std::vector<data::CycleCurves> envelope_cycles(const data::Trial& trial,
                                               const analysis::EmgMeasures& measured,
                                               std::span<const analysis::GaitCycle> cycles, bool per_cent) {
  std::vector<data::CycleCurves> out;
  const auto table = envelope_table(trial, measured, false);
  for (std::size_t c = 0; c < measured.names.size(); ++c) {
    analysis::CycleSeries series{.id = measured.names[c],
                                 .quantity = per_cent ? data::Quantity::share : data::Quantity::voltage,
                                 .time_s = {table.time_s.begin(), table.time_s.end()}};
    for (std::int64_t r = 0; r < table.rows(); ++r)
      series.values.push_back(table(r, static_cast<std::int64_t>(c)));
    const auto of = side_of_channel(measured.names[c]);
    for (const auto side : data::kBothSides)
      if (of.empty() || of == data::to_string(side)) {
        auto curves = analysis::cut_into_cycles(series, cycles, side);
        if (curves.count() > 0) out.push_back(std::move(curves));
      }
  }
  return out;
}

}  // namespace kinemark::pipeline

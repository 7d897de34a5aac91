// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/segment_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/workflow/segments/subject_values.h"

namespace kinemark::pipeline {
namespace {

using analysis::SegmentMotion;
using analysis::SegmentSeries;
using analysis::SubjectQuantity;

std::string column(const SegmentSeries& series, std::size_t k) {
  return series.labels.empty() ? series.name : series.name + "_" + series.labels[k];
}

// Tables are in degrees and metres.
double per_si(const SegmentSeries& series) {
  return series.quantity == SubjectQuantity::angle ? 180.0 / std::numbers::pi : 1.0;
}

data::Table table_of(const SeriesList& list, const TimeBase& time, std::string name,
                     const Array<double> SegmentSeries::* what) {
  data::Table table{.name = std::move(name), .in_degrees = true};
  for (std::int64_t f = 0; f < time.frames; ++f) table.time_s.push_back(time.time_s(f));
  for (const auto* series : list)
    for (std::size_t k = 0; k < series->size(); ++k) table.columns.push_back(column(*series, k));
  for (std::int64_t f = 0; f < time.frames; ++f)
    for (const auto* series : list)
      for (std::size_t k = 0; k < series->size(); ++k)
        table.values.push_back((series->*what)[static_cast<std::size_t>(f) * series->size() + k] *
                               per_si(*series));
  return table;
}

std::string_view table_unit(const SegmentSeries& series) {
  if (!series.unit.empty()) return series.unit;
  if (series.quantity == SubjectQuantity::length) return "m";
  return workflow::shown_unit(series.quantity);
}

data::Quantity quantity_of(const SegmentSeries& series) {
  if (series.quantity == SubjectQuantity::angle) return data::Quantity::angle;
  if (series.unit == "N m/kg") return data::Quantity::moment_per_mass;
  if (series.unit == "W/kg") return data::Quantity::power_per_mass;
  return series.quantity == SubjectQuantity::length ? data::Quantity::length : data::Quantity::ratio;
}

data::ChannelKind kind_of(const SegmentSeries& series) {
  if (series.quantity == SubjectQuantity::angle) return data::ChannelKind::angle;
  if (series.unit.starts_with("N m")) return data::ChannelKind::moment;
  if (series.unit.starts_with("N")) return data::ChannelKind::force;
  if (series.unit.starts_with("W")) return data::ChannelKind::power;
  return data::ChannelKind::scalar;
}

// Of each component over the frames that have one; null without any.
nlohmann::ordered_json root_mean_squares(const SegmentSeries& series, const Array<double>& values) {
  auto out = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < series.size(); ++k) {
    double squares = 0.0;
    std::int64_t seen = 0;
    for (std::size_t i = k; i < values.size(); i += series.size())
      if (std::isfinite(values[i])) {
        squares += values[i] * values[i];
        ++seen;
      }
    out.push_back(
        seen > 0 ? nlohmann::ordered_json(std::sqrt(squares / static_cast<double>(seen)) * per_si(series))
                 : nlohmann::ordered_json(nullptr));
  }
  return out;
}

}  // namespace

SeriesList series_of(const SegmentMotion& motion) {
  SeriesList out;
  for (const auto& series : motion.angles) out.push_back(&series);
  for (const auto& series : motion.values) out.push_back(&series);
  return out;
}

SeriesList series_of(const analysis::JointLoads& loads) {
  SeriesList out;
  for (const auto& series : loads.series) out.push_back(&series);
  return out;
}

data::Table series_table(const SeriesList& list, const TimeBase& time, const std::string& name) {
  return table_of(list, time, name, &SegmentSeries::value);
}

data::Table deviations_table(const SeriesList& list, const TimeBase& time, const std::string& name) {
  return table_of(list, time, name, &SegmentSeries::sd);
}

std::vector<analysis::CycleSeries> cycle_series(const SeriesList& list, const TimeBase& time) {
  std::vector<analysis::CycleSeries> out;
  for (const auto* series : list)
    for (std::size_t k = 0; k < series->size(); ++k) {
      analysis::CycleSeries one{.id = column(*series, k), .quantity = quantity_of(*series)};
      for (std::int64_t f = 0; f < time.frames; ++f) {
        const auto i = static_cast<std::size_t>(f) * series->size() + k;
        one.time_s.push_back(time.time_s(f));
        one.values.push_back(series->value[i]);
        one.sd.push_back(series->sd[i]);
      }
      out.push_back(std::move(one));
    }
  return out;
}

std::string series_csv(const SeriesList& list, const TimeBase& time) {
  std::string out = "time_s,name,component,value,sd,unit,state\n";
  const auto cell = [](double x) { return std::isfinite(x) ? format_number(x) : std::string(); };
  for (const auto* series : list)
    for (std::int64_t f = 0; f < time.frames; ++f)
      for (std::size_t k = 0; k < series->size(); ++k) {
        const auto i = static_cast<std::size_t>(f) * series->size() + k;
        out += fmt::format("{},{},{},{},{},{},{}\n", format_number(time.time_s(f)), series->name,
                           series->labels.empty() ? "" : series->labels[k],
                           cell(series->value[i] * per_si(*series)), cell(series->sd[i] * per_si(*series)),
                           table_unit(*series), data::to_string(series->state[static_cast<std::size_t>(f)]));
      }
  return out;
}

data::Trial points_trial(const SegmentMotion& motion, const data::Trial& recording) {
  data::Trial out;
  out.source = recording.source;
  out.format = recording.format;
  out.units_in_file = recording.units_in_file;
  out.first_frame = recording.first_frame;
  out.markers = motion.points;
  for (std::int64_t f = 0; f < motion.points.frames(); ++f)
    for (std::int64_t m = 0; m < motion.points.markers(); ++m)
      if (motion.points.present(f, m)) out.markers.set_method(f, m, "segments");
  return out;
}

data::Trial trial_with(const SegmentMotion& motion, const analysis::JointLoads& loads,
                       data::Trial recording) {
  auto& channels = recording.channels;
  const auto frames = static_cast<std::size_t>(motion.time.frames);
  std::set<std::string> ours(motion.points.names.begin(), motion.points.names.end());
  SeriesList list = series_of(motion);
  std::ranges::copy(series_of(loads), std::back_inserter(list));
  for (const auto* series : list) ours.insert(series->name);
  // Channels that stay, then ours.
  data::Channels made{.rate_hz = motion.time.rate_hz, .frames = motion.time.frames};
  std::vector<std::size_t> kept;
  if (channels.frames == motion.time.frames)
    for (std::size_t c = 0; c < channels.names.size(); ++c)
      if (!ours.contains(channels.names[c])) kept.push_back(c);
  for (const auto c : kept) {
    made.names.push_back(channels.names[c]);
    made.kinds.push_back(channels.kinds[c]);
    made.units.push_back(channels.units[c]);
  }
  for (const auto* series : list) {
    made.names.push_back(series->name);
    made.kinds.push_back(kind_of(*series));
    made.units.emplace_back(table_unit(*series));
  }
  for (std::size_t f = 0; f < frames; ++f) {
    for (const auto c : kept)
      for (std::size_t k = 0; k < 3; ++k)
        made.values.push_back(channels.values[(f * channels.names.size() + c) * 3 + k]);
    for (const auto* series : list) {
      for (std::size_t k = 0; k < 3; ++k)
        made.values.push_back(k < series->size() ? series->value[f * series->size() + k] * per_si(*series)
                                                 : 0.0);
      // A point whose first component is missing is missing.
      if (!std::isfinite(made.values[made.values.size() - 3]))
        for (std::size_t k = 1; k < 3; ++k) made.values[made.values.size() - k] = kNaN;
    }
  }
  channels = std::move(made);

  const auto& points = motion.points;
  const data::Trajectories old = recording.markers;
  std::vector<std::int64_t> markers;
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < old.markers(); ++m)
    if (!ours.contains(old.names[static_cast<std::size_t>(m)])) {
      markers.push_back(m);
      names.push_back(old.names[static_cast<std::size_t>(m)]);
    }
  names.insert(names.end(), points.names.begin(), points.names.end());
  auto all = data::Trajectories::all_missing(std::move(names), motion.time);
  for (std::int64_t f = 0; f < motion.time.frames; ++f) {
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const auto m = static_cast<std::int64_t>(i);
      all.state[all.index(f, m)] = old.state[old.index(f, markers[i])];
      all.x(f, m) = old.x(f, markers[i]);
    }
    for (std::int64_t p = 0; p < points.markers(); ++p) {
      const auto m = std::ssize(markers) + p;
      all.state[all.index(f, m)] = points.state[points.index(f, p)];
      all.x(f, m) = points.x(f, p);
    }
  }
  recording.markers = std::move(all);
  recording.residual_m.clear();
  recording.camera_mask.clear();
  return recording;
}

nlohmann::ordered_json parameters_json(const SegmentMotion& motion) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& p : motion.parameters)
    out.push_back({{"name", p.name},
                   {"value", p.value / workflow::per_shown(p.quantity)},
                   {"unit", workflow::shown_unit(p.quantity)},
                   {"sd", p.sd > 0.0 ? nlohmann::ordered_json(p.sd / workflow::per_shown(p.quantity))
                                     : nlohmann::ordered_json(nullptr)},
                   {"from", p.from},
                   {"assumed", p.assumed}});
  return out;
}

nlohmann::ordered_json series_json(const SeriesList& list) {
  auto out = nlohmann::ordered_json::array();
  for (const auto* one_series : list) {
    const auto& series = *one_series;
    nlohmann::ordered_json one{
        {"name", series.name}, {"components", series.labels}, {"unit", table_unit(series)}};
    for (const auto state :
         {data::SampleState::measured, data::SampleState::interpolated, data::SampleState::missing})
      one[std::string(data::to_string(state))] = std::ranges::count(series.state, state);
    one["sd"] = root_mean_squares(series, series.sd);
    // Loads have none.
    if (!series.constant_sd.empty()) one["constant_sd"] = root_mean_squares(series, series.constant_sd);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace kinemark::pipeline

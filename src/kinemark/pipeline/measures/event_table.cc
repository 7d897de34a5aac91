// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/event_table.h"

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/table_cell.h"
#include "kinemark/stages/analysis/gait/cycle_curves.h"

namespace kinemark::pipeline {
namespace {

using analysis::CycleSeries;
using data::Side;

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

// Of "LKneeAngles" or "knee_angle_l"; none of others.
std::optional<Side> side_of(std::string_view name) {
  if (name.ends_with("_l")) return Side::left;
  if (name.ends_with("_r")) return Side::right;
  if (name.size() > 1 && is_upper(name[1]) && name[0] == 'L') return Side::left;
  if (name.size() > 1 && is_upper(name[1]) && name[0] == 'R') return Side::right;
  return std::nullopt;
}

void add_channels(const data::Trial& trial, std::vector<CycleSeries>& out) {
  const auto& channels = trial.channels;
  const std::int64_t count = channels.count();
  for (std::int64_t c = 0; c < count; ++c) {
    if (channels.kinds[at(c)] != data::ChannelKind::angle) continue;
    const double si = channels.units[at(c)] == "rad" ? 1.0 : kRadPerDeg;
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      CycleSeries one{.id = fmt::format("{} {}", channels.names[at(c)], "xyz"[axis])};
      for (std::int64_t f = 0; f < channels.frames; ++f) {
        one.time_s.push_back(trial.markers.time.t0_s + static_cast<double>(f) / channels.rate_hz);
        one.values.push_back(si * channels.values[at(3 * (f * count + c) + axis)]);
      }
      out.push_back(std::move(one));
    }
  }
}

Status add_motion(const std::filesystem::path& path, std::vector<CycleSeries>& out) {
  const auto table = io::read_table(path);
  if (!table) return std::unexpected(table.error());
  const auto beside_it = beside(path, "_sd.sto");
  std::optional<data::Table> deviations;
  if (std::filesystem::exists(beside_it)) {
    auto read = io::read_table(beside_it);
    if (!read) return std::unexpected(read.error());
    if (read->rows() == table->rows()) deviations = std::move(*read);
  }
  const double per_angle = table->in_degrees || !table->degrees_stated ? kRadPerDeg : 1.0;
  for (std::size_t k = 0; k < table->columns.size(); ++k) {
    const auto& name = table->columns[k];
    const bool moves = name.ends_with("_tx") || name.ends_with("_ty") || name.ends_with("_tz");
    CycleSeries one{.id = name, .quantity = moves ? data::Quantity::length : data::Quantity::angle};
    one.time_s.assign(table->time_s.begin(), table->time_s.end());
    const double si = moves ? 1.0 : per_angle;
    const auto of_sd = deviations ? deviations->find(name) : -1;
    for (std::int64_t r = 0; r < table->rows(); ++r) {
      one.values.push_back(si * (*table)(r, static_cast<std::int64_t>(k)));
      if (of_sd >= 0) one.sd.push_back(si * (*deviations)(r, of_sd));
    }
    out.push_back(std::move(one));
  }
  return {};
}

std::string_view method_of(analysis::PathEventKind kind) {
  return kind == analysis::PathEventKind::cycle_start ? "upward crossing of the mean"
                                                      : "5 % of the peak speed";
}

bool is_of_feet(const EventRow& event) { return event.subject.empty(); }

bool is_of_feet(const data::Event& event, TimeBase time) {
  time.t0_s = event.time_s, time.frames = 1;
  return !analysis::events_of_file(std::vector{event}, time).events.empty();
}

}  // namespace

Result<std::vector<data::CycleCurves>> gait_curves(const data::Trial& trial,
                                                   const std::vector<analysis::GaitCycle>& cycles,
                                                   const std::filesystem::path& motion) {
  if (cycles.empty()) return fail(Code::bad_input, "there is no cycle from strike to strike");
  std::vector<CycleSeries> series;
  if (motion.empty())
    add_channels(trial, series);
  else if (auto s = add_motion(motion, series); !s)
    return std::unexpected(s.error());
  if (series.empty())
    return fail(Code::bad_input,
                "the recording holds no angles to cut into cycles of walking; need --angles FILE.mot, or "
                "--events movement "
                "for the markers' own movements");
  std::vector<data::CycleCurves> out;
  for (const auto& one : series) {
    const auto side = side_of(one.id);
    for (const Side of : data::kBothSides) {
      if (side && *side != of) continue;
      auto curves = analysis::cut_into_cycles(one, cycles, of);
      if (curves.count() > 0) out.push_back(std::move(curves));
    }
  }
  return out;
}

std::string curves_csv_columns(const RecordingName& recording) {
  return name_columns() + ",subject,curve,context,region,cycle,percent,value,sd,sd_between,unit" +
         more_columns(recording) + "\n";
}

std::string curves_csv_rows(const std::vector<RegionCurves>& curves, const RecordingName& recording) {
  const auto first = name_cells(recording), last = more_cells(recording);
  std::string out;
  for (const auto& [region, all] : curves)
    for (const auto& one : all) {
      const auto unit = data::shown_unit(one.quantity);
      const auto row = [&](const std::string& cycle, std::int64_t p, double value, double sd,
                           double between) {
        out += fmt::format("{},{},{},{},{},{},{:g},{},{},{},{}{}\n", first, table_cell(one.subject),
                           table_cell(one.id), one.context, table_cell(region), cycle,
                           100.0 * static_cast<double>(p) / static_cast<double>(one.points - 1),
                           table_cell(unit.per_si * value), table_cell(unit.per_si * sd),
                           table_cell(unit.per_si * between), unit.name, last);
      };
      const auto sd = [&](std::int64_t c, std::int64_t p) {
        return one.sd.empty() ? kNaN : one.sd[at(c * one.points + p)];
      };
      for (std::int64_t c = 0; c < one.count(); ++c)
        for (std::int64_t p = 0; p < one.points; ++p)
          row(fmt::to_string(c + 1), p, one(c, p), sd(c, p), kNaN);
      const auto mean = analysis::mean_of_cycles(one);
      for (std::int64_t p = 0; p < one.points; ++p) {
        double squares = 0.0;
        std::int64_t count = 0;
        for (std::int64_t c = 0; c < one.count(); ++c)
          if (std::isfinite(one(c, p))) squares += sd(c, p) * sd(c, p), ++count;
        row("mean", p, mean.mean[at(p)], std::sqrt(squares) / static_cast<double>(count), mean.sd[at(p)]);
      }
    }
  return out;
}

std::string curves_csv(const std::vector<RegionCurves>& curves, const RecordingName& recording) {
  return curves_csv_columns(recording) + curves_csv_rows(curves, recording);
}

std::vector<EventRow> events_of(const analysis::Gait& gait, const TimeBase& time) {
  std::vector<EventRow> out;
  for (const auto& event : gait.events)
    out.push_back({.subject = {},
                   .context = std::string(data::to_string(event.side)),
                   .region = {},
                   .label = std::string(data::to_string(event.what)),
                   .time_s = event.time_s,
                   .frame = time.number(time.nearest_frame(event.time_s)),
                   .sd_s = event.sd_s,
                   .source = std::string(data::to_string(event.source)),
                   .method = event.method});
  return out;
}

std::vector<EventRow> events_of(const std::vector<analysis::PathRhythm>& rhythms, const TimeBase& time) {
  std::vector<EventRow> out;
  for (const auto& rhythm : rhythms)
    for (const auto& event : rhythm.events)
      out.push_back({.subject = rhythm.subject,
                     .context = {},
                     .region = rhythm.region,
                     .label = std::string(analysis::to_string(event.kind)),
                     .time_s = event.time_s,
                     .frame = time.number(time.nearest_frame(event.time_s)),
                     .sd_s = event.sd_s,
                     .source = std::string(data::to_string(data::EventSource::kinematics)),
                     .method = std::string(method_of(event.kind))});
  return out;
}

std::string events_csv_columns(const RecordingName& recording) {
  return name_columns() + ",subject,context,region,label,time_s,frame,sd_s,source,method" +
         more_columns(recording) + "\n";
}

std::string events_csv_rows(const std::vector<EventRow>& events, const RecordingName& recording) {
  const auto first = name_cells(recording), last = more_cells(recording);
  std::string out;
  for (const auto& event : events)
    out += fmt::format("{},{},{},{},{},{:.6f},{},{},{},{}{}\n", first, table_cell(event.subject),
                       event.context, table_cell(event.region), table_cell(event.label), event.time_s,
                       event.frame, std::isfinite(event.sd_s) ? fmt::format("{:.6f}", event.sd_s) : "",
                       event.source, table_cell(event.method), last);
  return out;
}

std::string events_csv(const std::vector<EventRow>& events, const RecordingName& recording) {
  return events_csv_columns(recording) + events_csv_rows(events, recording);
}

data::Trial with_events(data::Trial trial, const std::vector<EventRow>& events) {
  const bool of_feet = std::ranges::any_of(events, [](const EventRow& event) { return is_of_feet(event); });
  std::erase_if(trial.events, [&](const data::Event& old) {
    return (of_feet && is_of_feet(old, trial.markers.time)) ||
           std::ranges::any_of(
               events, [&](const EventRow& event) { return !is_of_feet(event) && event.label == old.label; });
  });
  for (const auto& event : events)
    trial.events.push_back({.label = event.label,
                            .context = event.context.empty() ? "General" : event.context,
                            .time_s = event.time_s});
  std::ranges::stable_sort(trial.events, {}, &data::Event::time_s);
  return trial;
}

nlohmann::ordered_json rhythms_json(const std::vector<analysis::PathRhythm>& rhythms) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& rhythm : rhythms) {
    nlohmann::ordered_json one{{"subject", rhythm.subject}};
    if (!rhythm.region.empty()) one["region"] = rhythm.region;
    one["periodic"] = rhythm.periodic;
    one["period_s"] = json_number(rhythm.period_s);
    one["verdict"] = rhythm.verdict;
    one["events"] = nlohmann::ordered_json::array();
    for (const auto& event : rhythm.events)
      one["events"].push_back({{"label", analysis::to_string(event.kind)},
                               {"time_s", event.time_s},
                               {"sd_s", json_number(event.sd_s)}});
    out.push_back(std::move(one));
  }
  return out;
}

std::string rhythms_text(const std::vector<analysis::PathRhythm>& rhythms) {
  std::string out;
  for (const auto& rhythm : rhythms) {
    out += fmt::format("{}{}: {}\n", rhythm.subject, rhythm.region.empty() ? "" : ", " + rhythm.region,
                       rhythm.verdict);
    for (const auto& event : rhythm.events)
      out += fmt::format(
          "  {:<15} {:9.4f} {} s\n", analysis::to_string(event.kind), event.time_s,
          std::isfinite(event.sd_s) ? fmt::format("+- {:.4f}", event.sd_s) : std::string("         "));
  }
  return out;
}

}  // namespace kinemark::pipeline

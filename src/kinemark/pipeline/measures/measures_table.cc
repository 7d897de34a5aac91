// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/pipeline/files/table_cell.h"
#include "kinemark/stages/analysis/path/noise_sentences.h"
#include "kinemark/workflow/measures/asked.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json filter_json(const analysis::PathNoise& noise, bool agreed) {
  const auto& model = noise.model;
  return {{"agreed", agreed},
          {"form", math::name_of(model.form, model.order)},
          {"order", model.order},
          {"cutoff_hz", json_number(noise.cutoff_hz.middle)},
          {"low_hz", json_number(noise.cutoff_hz.low)},
          {"high_hz", json_number(noise.cutoff_hz.high)},
          {"half_amplitude_hz", json_number(model.half * noise.rate_hz)}};
}

using Json = nlohmann::ordered_json;

// As many digits as the interval's width supports, two of it, and four significant ones without.
std::string rounded(double value, double width) {
  if (!std::isfinite(value)) return "not determined";
  if (!(width > 0.0)) return fmt::format("{:.4g}", value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(width))), 0, 9);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string interval_text(const data::Measure& measure, double factor) {
  const auto& interval = measure.interval;
  const double low = factor * interval.low, high = factor * interval.high, value = factor * measure.value;
  const char* about = interval.approximate ? "about " : "";
  switch (interval.kind) {
    case data::IntervalKind::none:
      return {};
    case data::IntervalKind::at_most:
      return fmt::format(" [{}at most {}]", about, rounded(high, std::abs(high - value)));
    case data::IntervalKind::at_least:
      return fmt::format(" [{}at least {}]", about, rounded(low, std::abs(high - value)));
    case data::IntervalKind::two_sided:
      return fmt::format(" [{}{} to {}]", about, rounded(low, high - low), rounded(high, high - low));
  }
  return {};
}

std::string value_text(const data::Measure& measure) {
  if (measure.quantity == data::Quantity::count && std::isfinite(measure.value)) {
    const auto& ends = measure.interval;
    const bool same = ends.kind != data::IntervalKind::two_sided || ends.low == ends.high;
    return fmt::format("{:.0f}", measure.value) +
           (same ? "" : fmt::format(" [{:.0f} to {:.0f}]", ends.low, ends.high));
  }
  const auto unit = data::shown_unit(measure.quantity);
  const auto& interval = measure.interval;
  const double width = interval.kind == data::IntervalKind::two_sided ? interval.high - interval.low
                       : interval.kind == data::IntervalKind::at_most
                           ? std::abs(interval.high - measure.value)
                           : kNaN;
  std::string out =
      rounded(unit.per_si * measure.value, unit.per_si * width) + interval_text(measure, unit.per_si);
  if (!unit.name.empty() && std::isfinite(measure.value)) out += fmt::format(" {}", unit.name);
  return out;
}

std::string own_columns() {
  return name_columns() +
         ",subject,context,region,cycle,start_s,end_s,measure,value,unit,low,high,level,interval,approximate,"
         "sd,uncorrected,share_not_measured,method,remark";
}

}  // namespace

Json noises_json(std::span<const analysis::PathNoise> noises) {
  Json out = Json::array();
  const auto shared = analysis::find_shared_filter(noises);
  for (std::size_t i = 0; i < noises.size(); ++i) {
    const auto& noise = noises[i];
    const auto& model = noise.model;
    const auto mm = [](double m) { return json_number(1e3 * m); };
    Json one{{"subject", noise.subject},
             {"source", to_string(noise.source)},
             {"kind", math::to_string(model.kind)},
             {"sd_mm", mm(noise.sd_m())},
             {"found_mm", mm(noise.found_sd_m)}};
    if (std::isfinite(noise.sample_sd_m)) one["sample_sd_mm"] = mm(noise.sample_sd_m);
    if (noise.stated_sd_m > 0.0) one["stated_mm"] = mm(noise.stated_sd_m);
    if (model.correlation > 0.0) {
      one["correlation"] = json_number(model.correlation);
      one["correlation_time_s"] = json_number(-1.0 / std::log(model.correlation) / noise.rate_hz);
    }
    if (noise.filtered())
      one["filter"] = filter_json(noise, noise.source == analysis::NoiseSource::filter ||
                                             std::ranges::find(shared.members, i) != shared.members.end());
    if (model.floor > 0.0) one["floor_mm"] = mm(std::sqrt(model.floor));
    if (noise.rounding_step_m > 0.0) one["rounding_step_mm"] = mm(noise.rounding_step_m);
    one["slow_noise_mm"] = {{"low", mm(noise.slow_sd_m.low)},
                            {"middle", mm(noise.slow_sd_m.middle)},
                            {"high", mm(noise.slow_sd_m.high)}};
    one["slow_noise_unknown"] = noise.slow_is_unknown();
    one["outliers"] = noise.outliers;
    out.push_back(std::move(one));
  }
  return out;
}

std::string measures_csv_columns(const RecordingName& recording) {
  return own_columns() + more_columns(recording) + span_columns(recording) + "\n";
}

void name_span_columns(RecordingName& recording) {
  name_apart(recording.spans, own_columns() + more_columns(recording));
}

std::string measures_csv_rows(std::span<const data::Measure> measures, const RecordingName& recording) {
  const auto first = name_cells(recording), last = more_cells(recording);
  std::string out;
  for (const auto& m : measures) {
    const auto unit = data::shown_unit(m.quantity);
    const auto shown = [&unit](double si) { return table_cell(unit.per_si * si); };
    out +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{:g},{},{},{},{},{},{},{}{}{}\n", first,
                    table_cell(m.subject), table_cell(m.context), table_cell(m.region),
                    m.cycle < 0 ? "" : fmt::to_string(m.cycle), table_cell(m.start_s), table_cell(m.end_s),
                    m.id, shown(m.value), unit.name, shown(m.interval.low), shown(m.interval.high),
                    m.interval.level, data::to_string(m.interval.kind), m.interval.approximate ? "yes" : "no",
                    shown(m.sd), shown(m.uncorrected), table_cell(m.share_not_measured), table_cell(m.method),
                    table_cell(m.remark), last, span_cells(recording, m.region));
  }
  return out;
}

std::string measures_csv(std::span<const data::Measure> measures, const RecordingName& recording) {
  return measures_csv_columns(recording) + measures_csv_rows(measures, recording);
}

nlohmann::ordered_json measures_json(std::span<const data::Measure> measures) {
  Json out = Json::array();
  for (const auto& m : measures) {
    const auto unit = data::shown_unit(m.quantity);
    const auto shown = [&unit](double si) { return json_number(unit.per_si * si); };
    Json one{{"measure", m.id}, {"subject", m.subject}};
    if (!m.context.empty()) one["context"] = m.context;
    if (!m.region.empty()) one["region"] = m.region;
    if (m.cycle >= 0) one["cycle"] = m.cycle;
    one["start_s"] = json_number(m.start_s);
    one["end_s"] = json_number(m.end_s);
    one["value"] = shown(m.value);
    one["unit"] = unit.name;
    one["interval"] = {{"kind", data::to_string(m.interval.kind)},
                       {"low", shown(m.interval.low)},
                       {"high", shown(m.interval.high)},
                       {"level", m.interval.level},
                       {"approximate", m.interval.approximate}};
    one["sd"] = shown(m.sd);
    one["uncorrected"] = shown(m.uncorrected);
    one["share_not_measured"] = json_number(m.share_not_measured);
    one["method"] = m.method;
    if (!m.remark.empty()) one["remark"] = m.remark;
    out.push_back(std::move(one));
  }
  return out;
}

std::string shown_value(const data::Measure& measure) { return value_text(measure); }

std::string title_of_measure(const std::string& id) {
  const auto* known = workflow::find_measure(id);
  return known != nullptr ? std::string(known->what.title) : id;
}

std::string title_of_measure(const data::Measure& measure) {
  return title_of_measure(measure.id) + (measure.context.empty() ? "" : ", " + measure.context);
}

std::string measures_text(std::span<const data::Measure> measures) {
  std::string out;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const auto& m = measures[i];
    const bool same = i > 0 && measures[i - 1].subject == m.subject && measures[i - 1].region == m.region &&
                      measures[i - 1].cycle == m.cycle;
    if (!same)
      out += fmt::format(
          "{}{}{}, {:.3f} to {:.3f} s{}\n", i > 0 ? "\n" : "", m.subject.empty() ? "Walking" : m.subject,
          m.region.empty() ? "" : fmt::format(", {}", m.region), m.start_s, m.end_s,
          m.share_not_measured > 0.0 ? fmt::format(", {:.1f} % not measured", 100.0 * m.share_not_measured)
                                     : "");
    out += fmt::format("  {:<40} {}{}\n", title_of_measure(m), shown_value(m),
                       m.remark.empty() ? "" : fmt::format("  ({})", m.remark));
  }
  return out;
}

std::string measure_list(workflow::MeasuresOf of) {
  std::string out;
  for (const auto& known : workflow::known_measures()) {
    if (!known.is_of(of)) continue;
    const auto& what = known.what;
    const auto unit = data::shown_unit(what.quantity).name;
    out += fmt::format("{:<20} {}{}: {} ({})\n", what.id, what.title,
                       unit.empty() ? "" : fmt::format(", {}", unit), what.formula, what.source);
  }
  return out;
}

nlohmann::ordered_json measure_list_json(workflow::MeasuresOf of) {
  Json out = Json::array();
  for (const auto& known : workflow::known_measures()) {
    if (!known.is_of(of)) continue;
    const auto& what = known.what;
    out.push_back({{"measure", what.id},
                   {"group", what.group},
                   {"title", what.title},
                   {"unit", data::shown_unit(what.quantity).name},
                   {"formula", what.formula},
                   {"source", what.source}});
  }
  return out;
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/report/internal/clean_text.h"
#include "kinemark/stages/report/internal/json_parts.h"

namespace kinemark::report {

namespace {

using internal::millimetres;
using internal::number;
using internal::significant;

using Json = nlohmann::ordered_json;
using data::SampleState;

constexpr int kSchemaVersion = 2;

Json counts_json(const std::array<std::int64_t, 6>& counts) {
  Json out = Json::object();
  for (std::size_t s = 0; s < counts.size(); ++s)
    out[std::string(data::to_string(static_cast<SampleState>(s)))] = counts[s];
  return out;
}

Json all_counts_json(const CleanReport& report, std::array<std::int64_t, 6> CleanCounts::* which) {
  std::array<std::int64_t, 6> sum{};
  for (const CleanCounts& c : report.counts)
    for (std::size_t s = 0; s < sum.size(); ++s) sum[s] += (c.*which)[s];
  return counts_json(sum);
}

/// Values that span decades, in another unit.
Json decades(const std::vector<double>& values, double scale) {
  Json out = Json::array();
  for (const double v : values) out.push_back(significant(scale * v, 5));
  return out;
}

/// Unit of a criterion is in its name, so it is not scaled.
Json tried_json(const data::MarkerAccount& m) {
  Json out = Json::array();
  for (const data::FilterCandidate& t : m.candidates)
    out.push_back({{"order", t.order},
                   {"cutoff_hz", number(t.cutoff_hz, 4)},
                   {"criterion", significant(t.criterion, 8)}});
  return out;
}

template <class Values>
Json rounded(const Values& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(number(v, 4));
  return out;
}

/// What a marker's gaps add up to.
struct GapSum {
  std::int64_t filled = 0, open = 0;
  double longest_open_s = 0.0;
  double largest_sd_m = kNaN;  ///< of the filled ones
};

/// One a marker.
std::vector<GapSum> sum_gaps(const CleanReport& report) {
  std::vector<GapSum> out(report.account.names.size());
  for (const data::GapAccount& g : report.account.gaps) {
    GapSum& sum = out[at(g.marker)];
    ++(g.filled ? sum.filled : sum.open);
    if (g.filled)
      sum.largest_sd_m = std::fmax(sum.largest_sd_m, g.max_sd_m);
    else
      sum.longest_open_s = std::max(sum.longest_open_s, internal::length_s(g, report.time));
  }
  return out;
}

Json marker_json(const CleanReport& report, std::size_t marker, const GapSum& gaps) {
  const data::MarkerAccount& m = report.account.markers[marker];
  const data::UpsamplingAccount& recorder = report.account.upsampling;
  const data::Upsampling made = recorder.markers.empty() ? data::Upsampling{} : recorder.markers[marker];
  const std::string_view band =
      recorder.marker_bands.empty() ? "" : to_string(recorder.marker_bands[marker].verdict);
  return {{"name", m.name},
          {"before", counts_json(report.counts[marker].before)},
          {"after", counts_json(report.counts[marker].after)},
          {"gaps_filled", gaps.filled},
          {"gaps_open", gaps.open},
          {"longest_open_s", number(gaps.longest_open_s, 6)},
          {"largest_fill_sd_mm", millimetres(gaps.largest_sd_m)},
          {"method", m.used.method},
          {"order", m.used.order},
          {"cutoff_hz", number(m.used.cutoff_hz, 4)},
          {"noise_sd_mm", significant(1e3 * m.used.noise_sd_m, 5)},
          {"noise_from", m.noise_from},
          {"words", m.description},
          {"criterion", m.criterion_name},
          {"tried", tried_json(m)},
          {"residual_rms_mm", significant(1e3 * m.residual_rms_m, 5)},
          {"autocorrelation", rounded(m.autocorrelation)},
          {"autocorrelation_if_white", rounded(m.white_autocorrelation)},
          {"white", m.judged() ? Json(!m.coloured()) : Json()},
          {"white_p", significant(m.white_p, 4)},
          {"white_departure", number(m.white_departure, 4)},
          {"bar_scale", rounded(m.bar_scale)},
          {"gap_bar_scale", rounded(m.gap_bar_scale)},
          {"bad_variances", m.bad_variances},
          {"upsampling_factor", made.factor},
          {"upsampling_kernel", made.found() ? to_string(made.kernel) : ""},
          {"band", band},
          {"spectrum",
           {{"frequency_hz", decades(m.spectrum.frequency_hz, 1.0)},
            {"raw_mm2_per_hz", decades(m.spectrum.raw_m2_per_hz, 1e6)},
            {"residual_mm2_per_hz", decades(m.spectrum.residual_m2_per_hz, 1e6)}}}};
}

Json markers_json(const CleanReport& report) {
  const std::vector<GapSum> gaps = sum_gaps(report);
  Json out = Json::array();
  for (std::size_t m = 0; m < report.account.markers.size(); ++m)
    out.push_back(marker_json(report, m, gaps[m]));
  return out;
}

Json gap_json(const CleanReport& report, const data::GapAccount& g) {
  const TimeBase& time = report.time;
  Json weights = Json::array();
  for (const data::GapWeight& w : g.weights)
    weights.push_back({{"name", w.name},
                       {"weight", number(w.weight, 4)},
                       {"rms_mm", millimetres(w.rms_m)},
                       {"guarded", w.guarded}});
  return {{"marker", report.account.name_of(g.marker)},
          {"first_frame", time.number(g.first_frame)},
          {"last_frame", time.number(g.last_frame)},
          {"first_time_s", number(time.time_s(g.first_frame), 6)},
          {"last_time_s", number(time.time_s(g.last_frame), 6)},
          {"length_s", number(internal::length_s(g, time), 6)},
          {"at_edge", g.at_edge},
          {"filled", g.filled},
          {"method", g.method},
          {"how", internal::how_filled(g)},
          {"weights", std::move(weights)},
          {"sd_mm", millimetres(g.sd_m)},
          {"max_sd_mm", millimetres(g.max_sd_m)},
          {"windows", g.windows},
          {"window_s", number(g.window_s, 6)},
          {"predictors", g.predictors},
          {"dropped", g.dropped},
          {"why_open", g.why_open}};
}

Json defect_json(const CleanReport& report, const data::Defect& d) {
  const TimeBase& time = report.time;
  const data::Finding& f = d.finding;
  return {{"kind", to_string(f.kind)},
          {"marker", f.subject},
          {"other_marker", f.partner},
          {"first_frame", time.number(f.first_frame)},
          {"last_frame", time.number(f.last_frame)},
          {"first_time_s", number(time.time_s(f.first_frame), 6)},
          {"last_time_s", number(time.time_s(f.last_frame), 6)},
          {"confidence", number(f.confidence, 4)},
          {"sentence", sentence_of(f, time)},
          {"done", d.done},
          {"handled", d.handled}};
}

}  // namespace

nlohmann::ordered_json clean_summary_json(const CleanReport& report) {
  const data::CleanAccount& account = report.account;
  check(account.validate().has_value(), "a report needs an account that validates");
  const CleanRun& run = report.run;
  const data::UpsamplingAccount& up = account.upsampling;
  const std::vector<Notice> findings = clean_findings(report);
  const bool serious =
      std::ranges::any_of(findings, [](const Notice& f) { return f.level == Verdict::attention; });
  Json gaps = Json::array(), defects = Json::array();
  for (const data::GapAccount& g : account.gaps) gaps.push_back(gap_json(report, g));
  for (const data::Defect& d : account.defects) defects.push_back(defect_json(report, d));
  return {{"schema", "kinemark.clean_report"},
          {"schema_version", kSchemaVersion},
          {"trial", run.trial},
          {"gap_method", run.gap_method},
          {"filter_method", run.filter_method},
          {"verdict", to_string(serious ? Verdict::attention : Verdict::good)},
          {"exit_status", run.exit_status},
          {"frames", report.time.frames},
          {"rate_hz", number(report.time.rate_hz, 6)},
          {"first_time_s", number(report.time.t0_s, 6)},
          {"first_frame", report.time.first_number},
          {"clean_s", number(run.clean_s, 9)},
          {"threads", run.threads},
          {"seed", run.seed},
          {"version", run.version},
          {"command_line", run.command_line},
          {"before", all_counts_json(report, &CleanCounts::before)},
          {"after", all_counts_json(report, &CleanCounts::after)},
          {"findings", internal::findings_json(findings)},
          {"gates", internal::gates_json(run.gates)},
          {"upsampling",
           {{"looked", up.looked},
            {"factor", up.factor()},
            {"done", up.done},
            {"handled", up.handled},
            {"sentences", up.sentences}}},
          {"markers", markers_json(report)},
          {"gap_count", account.gaps.size()},
          {"gaps", std::move(gaps)},
          {"defect_count", account.defects.size()},
          {"defects", std::move(defects)},
          {"options", internal::options_json(run.options)},
          {"inputs", inputs_json(run.inputs)},
          {"warnings", run.warnings}};
}

}  // namespace kinemark::report

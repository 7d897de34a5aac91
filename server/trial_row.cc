// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_row.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/info_job.h"
#include "kinemark/pipeline/files/input_list.h"

namespace kinemark::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostReportBytes = 256UL << 20;
constexpr std::size_t kNameLetters = 200;

/// The report that a job wrote beside a file; null without one.
Json report_beside(const fs::path& path) {
  std::error_code ignored;
  const auto file = pipeline::beside(path, "_report.json");
  if (!fs::is_regular_file(file, ignored)) return {};
  const auto text = io::read_text(file, kMostReportBytes);
  auto json = text ? Json::parse(*text, nullptr, false) : Json();
  return json.is_object() ? json : Json();
}

std::string text_at(const Json& json, const char* key) {
  const auto at = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && at != json.end() && at->is_string() ? at->get<std::string>() : "";
}

std::optional<double> number_at(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

bool is_report(const Json& json, std::string_view schema) { return text_at(json, "schema") == schema; }

/// A verdict as reports write it; anything else is none.
std::string verdict_of(const Json& report) {
  const auto verdict = text_at(report, "verdict");
  return verdict == "good" || verdict == "attention" ? verdict : "";
}

void say_first(const std::vector<std::string>& sentences, TrialRow& row) {
  if (sentences.empty()) return;
  row.said = printable_sentence(sentences.front());
  if (sentences.size() > 1) row.said += fmt::format(" (and {} more)", sentences.size() - 1);
}

void fail_row(const Error& error, TrialRow& row) {
  row.state = RowState::unreadable;
  row.said = printable_sentence(error.message);
}

void set_length(std::int64_t frames, std::optional<double> rate_hz, TrialRow& row) {
  row.frames = frames;
  row.rate_hz = rate_hz;
  if (rate_hz && *rate_hz > 0.0) row.duration_s = static_cast<double>(frames) / *rate_hz;
}

void describe_markers(const fs::path& path, TrialRow& row) {
  row.kind = "markers";
  const auto input = io::read_marker_input({.path = path, .rate = io::RateRule::or_unknown});
  if (!input) return fail_row(input.error(), row);
  const auto& markers = input->trial.markers;
  row.markers = markers.markers();
  set_length(markers.frames(), input->rate_known ? std::optional(markers.time.rate_hz) : std::nullopt, row);
  if (const auto samples = markers.state.size(); samples > 0)
    row.measured = static_cast<double>(std::ranges::count(markers.state, data::SampleState::measured)) /
                   static_cast<double>(samples);
  say_first(input->trial.warnings, row);
  const Json report = report_beside(path);
  const auto set = pipeline::set_in(path);
  if (is_report(report, "kinemark.clean_report") && !set.empty() &&
      set == pipeline::set_in(pipeline::beside(path, "_report.json"))) {
    row.kind = "cleaned markers";
    row.verdict = verdict_of(report);
  }
}

void describe_solved(const fs::path& path, const Json& report, TrialRow& row) {
  row.kind = "solved trial";
  row.verdict = verdict_of(report);
  const auto frames = number_at(report, "frames");
  if (frames) set_length(static_cast<std::int64_t>(*frames), number_at(report, "rate_hz"), row);
  if (const auto markers = report.find("markers"); markers != report.end() && markers->is_array())
    row.markers = std::ranges::count_if(*markers, [](const Json& marker) {
      return marker.is_object() && marker.value("used", Json()) == true;
    });
  say_first(pipeline::find_strangers(path), row);
}

void describe_facts(const pipeline::TableFacts& facts, TrialRow& row) {
  row.kind = "table";
  row.frames = facts.rows;
  if (facts.rows > 1 && *facts.last_time_s > *facts.first_time_s)
    set_length(facts.rows, static_cast<double>(facts.rows - 1) / (*facts.last_time_s - *facts.first_time_s),
               row);
}

void describe_facts(const pipeline::OrientationFacts& facts, TrialRow& row) {
  row.kind = "orientations";
  set_length(facts.frames, facts.rate_hz, row);
}

void describe_facts(const pipeline::RecordingFacts& facts, TrialRow& row) {
  row.kind = "recording";
  if (facts.counts) set_length(facts.counts->frames, facts.counts->rate_hz, row);
}

void describe_facts(const pipeline::ModelFacts& facts, TrialRow& row) {
  row.kind = "model";
  row.markers = static_cast<std::int64_t>(facts.markers);
}

void describe_facts(const io::Vsk& facts, TrialRow& row) {
  row.kind = "skeleton";
  row.markers = std::ssize(facts.markers);
}

void describe_facts(const pipeline::MarkerFileFacts&, TrialRow& row) { row.kind = "markers"; }

void describe_other(const fs::path& path, TrialRow& row) {
  pipeline::InfoJob job;
  job.file = path;
  job.edits = io::kEditsNone;
  const auto info = pipeline::run_info(job);
  if (!info) return fail_row(info.error(), row);
  std::visit([&](const auto& facts) { describe_facts(facts, row); }, info->facts);
  say_first(info->contradicted.empty() ? info->warnings : info->contradicted, row);
}

Json or_null(const auto& value) { return value ? Json(*value) : Json(); }
Json or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

}  // namespace

TrialRow unread_row(const fs::path& path) {
  TrialRow row;
  row.name = printable(path.filename().string(), kNameLetters);
  row.folder = printable(path.parent_path().string(), kNameLetters);
  return row;
}

bool is_solved(const fs::path& path) {
  return pipeline::ending_of(path) == ".mot" && is_report(report_beside(path), "kinemark.ik_report");
}

TrialRow describe_trial(const fs::path& path) {
  TrialRow row = unread_row(path);
  row.state = RowState::read;
  const auto ending = pipeline::ending_of(path);
  const auto of_markers = pipeline::marker_endings();
  if (std::ranges::find(of_markers, ending) != of_markers.end()) {
    describe_markers(path, row);
    return row;
  }
  const Json report = ending == ".mot" ? report_beside(path) : Json();
  if (is_report(report, "kinemark.ik_report"))
    describe_solved(path, report, row);
  else
    describe_other(path, row);
  return row;
}

Json row_json(const TrialRow& row) {
  const char* state = row.state == RowState::reading ? "reading"
                      : row.state == RowState::read  ? "read"
                                                     : "unreadable";
  return {{"number", row.number},
          {"name", row.name},
          {"folder", row.folder},
          {"page", fmt::format("/trial/{}", row.number)},
          {"state", state},
          {"kind", or_null(row.kind)},
          {"markers", or_null(row.markers)},
          {"frames", or_null(row.frames)},
          {"rate_hz", or_null(row.rate_hz)},
          {"duration_s", or_null(row.duration_s)},
          {"measured", or_null(row.measured)},
          {"verdict", or_null(row.verdict)},
          {"said", or_null(row.said)}};
}

}  // namespace kinemark::server

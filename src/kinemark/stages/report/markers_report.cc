// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/markers_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/internal/clean_text.h"
#include "kinemark/stages/report/internal/json_parts.h"
#include "kinemark/stages/report/internal/page.h"
#include "kinemark/stages/report/neural_part.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;
using data::SampleState;
using data::Trajectories;

/// Channels, events and remarks in a page; its tables and its size stay usable.
constexpr std::size_t kMostOfAKind = 2000;
constexpr double kMuchMissing = 0.2;

/// What there is of one marker.
struct Tally {
  std::array<std::int64_t, 6> states{};  ///< by SampleState
  std::int64_t gaps = 0;                 ///< stretches without coordinates
  std::int64_t longest_first = -1, longest = 0;

  [[nodiscard]] std::int64_t of(SampleState state) const { return states[static_cast<std::size_t>(state)]; }
  [[nodiscard]] std::int64_t absent() const { return of(SampleState::missing) + of(SampleState::rejected); }
  [[nodiscard]] std::int64_t made() const {
    return of(SampleState::interpolated) + of(SampleState::model_filled) + of(SampleState::upsampled);
  }
};

std::vector<Tally> tally_markers(const Trajectories& t) {
  std::vector<Tally> tallies(static_cast<std::size_t>(t.markers()));
  std::vector<std::int64_t> began(tallies.size(), -1);
  for (std::int64_t f = 0; f <= t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      Tally& tally = tallies[static_cast<std::size_t>(m)];
      auto& first = began[static_cast<std::size_t>(m)];
      const bool there = f == t.frames() || t.present(f, m);
      if (f < t.frames()) ++tally.states[static_cast<std::size_t>(t.state[t.index(f, m)])];
      if (!there && first < 0) first = f;
      if (!there || first < 0) continue;
      ++tally.gaps;
      if (f - first > tally.longest) tally.longest = f - first, tally.longest_first = first;
      first = -1;
    }
  return tallies;
}

std::string count_of(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

Json counts_json(const Tally& tally) {
  Json out = Json::object();
  for (std::size_t s = 0; s < tally.states.size(); ++s)
    out[std::string(data::to_string(static_cast<SampleState>(s)))] = tally.states[s];
  return out;
}

Json markers_json(const Trajectories& t, const std::vector<Tally>& tallies) {
  Json out = Json::array();
  for (std::size_t m = 0; m < tallies.size(); ++m) {
    const Tally& tally = tallies[m];
    const bool any = tally.longest > 0;
    out.push_back(
        {{"name", t.names[m]},
         {"labelled", !data::is_unlabelled(t.names[m])},
         {"states", counts_json(tally)},
         {"gaps", tally.gaps},
         {"longest_gap_s",
          any ? internal::number(static_cast<double>(tally.longest) / t.time.rate_hz, 6) : Json(nullptr)},
         {"longest_gap_time_s",
          any ? internal::number(t.time.time_s(tally.longest_first), 6) : Json(nullptr)}});
  }
  return out;
}

Json channels_json(const data::Trial& trial) {
  Json out = Json::array();
  for (std::size_t c = 0; c < trial.channels.names.size() && out.size() < kMostOfAKind; ++c)
    out.push_back({{"name", trial.channels.names[c]},
                   {"kind", data::to_string(trial.channels.kinds[c])},
                   {"unit", trial.channels.units[c]},
                   {"rate_hz", internal::number(trial.channels.rate_hz, 6)}});
  for (std::size_t c = 0; c < trial.analog.names.size() && out.size() < kMostOfAKind; ++c)
    out.push_back({{"name", trial.analog.names[c]},
                   {"kind", "analog"},
                   {"unit", c < trial.analog.units.size() ? trial.analog.units[c] : ""},
                   {"rate_hz", internal::number(trial.analog.rate_hz, 6)}});
  return out;
}

Json events_json(const data::Trial& trial) {
  Json out = Json::array();
  for (const auto& event : trial.events) {
    if (out.size() == kMostOfAKind) break;
    out.push_back(
        {{"label", event.label}, {"context", event.context}, {"time_s", internal::number(event.time_s, 6)}});
  }
  return out;
}

Json summary_of(const MarkersReport& report) {
  const data::Trial& trial = *report.recording;
  const Trajectories& t = trial.markers;
  const auto groups = markers_notices(report);
  return {{"schema", "kinemark.markers_report"},
          {"schema_version", 1},
          {"trial", report.trial},
          {"format", trial.format},
          {"units", trial.units_in_file},
          {"software", trial.software},
          {"verdict", to_string(verdict_of(groups))},
          {"frames", t.frames()},
          {"rate_hz", internal::number(t.time.rate_hz, 9)},
          {"rate_known", report.rate_known},
          {"first_time_s", internal::number(t.time.t0_s, 9)},
          {"first_frame", trial.first_frame},
          {"version", report.version},
          {"command_line", report.command_line},
          {"groups", internal::groups_json(groups)},
          {"markers", markers_json(t, tally_markers(t))},
          {"channel_count", trial.channels.names.size() + trial.analog.names.size()},
          {"channels", channels_json(trial)},
          {"event_count", trial.events.size()},
          {"events", events_json(trial)},
          {"cycles", cycle_spans_json(report.cycles)},
          {"inputs", inputs_json(report.inputs)}};
}

}  // namespace

std::vector<NoticeGroup> markers_notices(const MarkersReport& report) {
  check(report.recording != nullptr, "a report needs a recording");
  const Trajectories& t = report.recording->markers;
  const auto tallies = tally_markers(t);
  std::vector<Notice> never, much, partly, made, rejected, unnamed, remarks;
  const auto frames = t.frames();
  for (std::size_t m = 0; m < tallies.size() && frames > 0; ++m) {
    const Tally& tally = tallies[m];
    const std::string& name = t.names[m];
    const auto of_frames = [&](std::int64_t n) {
      return fmt::format("{} of {} frames ({:.1f} %)", n, frames,
                         100.0 * static_cast<double>(n) / static_cast<double>(frames));
    };
    const double when = tally.longest > 0 ? t.time.time_s(tally.longest_first) : kNaN;
    Notice notice{.subject = name, .time_s = when};
    if (data::is_unlabelled(name)) {
      notice.text = fmt::format("{}: there in {}", name, of_frames(frames - tally.absent()));
      notice.time_s = kNaN;
      unnamed.push_back(std::move(notice));
      continue;
    }
    if (tally.absent() == frames) {
      notice.text = fmt::format("{}: in no frame", name);
      notice.time_s = kNaN;
      never.push_back(std::move(notice));
    } else if (tally.absent() > 0) {
      notice.text = fmt::format("{}: missing in {}, {}, the longest {:.3f} s from {:.3f} s", name,
                                of_frames(tally.absent()),
                                count_of(static_cast<std::size_t>(tally.gaps), "gap", "gaps"),
                                static_cast<double>(tally.longest) / t.time.rate_hz, when);
      const bool is_much = static_cast<double>(tally.absent()) > kMuchMissing * static_cast<double>(frames);
      (is_much ? much : partly).push_back(std::move(notice));
    }
    if (tally.made() > 0)
      made.push_back({.subject = name, .text = fmt::format("{}: made in {}", name, of_frames(tally.made()))});
    if (tally.of(SampleState::rejected) > 0)
      rejected.push_back(
          {.subject = name,
           .text = fmt::format("{}: rejected in {}", name, of_frames(tally.of(SampleState::rejected)))});
  }
  for (const auto* list : {&report.recording->warnings, &report.warnings})
    for (const auto& sentence : *list) remarks.push_back({.text = sentence});
  std::vector<NoticeGroup> groups;
  if (t.markers() == 0 || frames == 0)
    add_group(groups, Verdict::attention, "file", "recording without markers", "",
              {{.text = fmt::format("The file holds {} markers and {} frames.", t.markers(), frames)}});
  if (!report.rate_known)
    add_group(groups, Verdict::attention, "file", "frame rate that is not known", "",
              {{.text = "The file tells no frame rate: frames are counted at 1 Hz. Give one with --rate."}});
  add_group(groups, Verdict::attention, "marker", "marker in no frame", "markers in no frame",
            std::move(never));
  add_group(groups, Verdict::attention, "marker", "marker missing in more than a fifth of the frames",
            "markers missing in more than a fifth of the frames", std::move(much));
  add_group(groups, Verdict::good, "marker", "marker partly missing", "markers partly missing",
            std::move(partly));
  add_group(groups, Verdict::good, "marker", "marker with rejected samples", "markers with rejected samples",
            std::move(rejected));
  add_group(groups, Verdict::good, "marker", "marker with samples that were made",
            "markers with samples that were made", std::move(made));
  add_group(groups, Verdict::good, "marker", "point that nobody named", "points that nobody named",
            std::move(unnamed));
  add_group(groups, Verdict::good, "warning", "remark about the file", "remarks about the file",
            std::move(remarks));
  return groups;
}

Json markers_report_json(const MarkersReport& report, const SceneOptions& options) {
  check(report.recording != nullptr, "a report needs a recording");
  const Scene scene{.markers = &report.recording->markers,
                    .before = report.before,
                    .forces = report.forces,
                    .plates = report.recording->force_plates,
                    .up = report.up,
                    .up_from = report.up_from};
  Json json{{"summary", summary_of(report)}, {"scene", scene_json(scene, options)}};
  const auto& time = report.recording->markers.time;
  if (report.neural != nullptr && time.frames > 1)
    if (auto lanes = neural_json(*report.neural, time.t0_s, time.time_s(time.frames - 1)); !lanes.is_null())
      json["neural"] = std::move(lanes);
  if (!report.editing.is_null()) json["editing"] = report.editing;
  return json;
}

std::string markers_report_html(const MarkersReport& report, const SceneOptions& options) {
  return internal::fill_page(markers_report_json(report, options));
}

}  // namespace kinemark::report

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/report/internal/clean_text.h"

namespace kinemark::report {

namespace {

using internal::length_s;

constexpr double kLargeSdM = 0.010;  ///< a fill beyond this is of no use for joint angles
constexpr double kMuchColour =
    0.1;  ///< share of the noise power at other frequencies that a person should know of
constexpr double kHighCutoff = 0.4;  ///< of the rate: above this a filter takes next to nothing away
constexpr std::size_t kNamesListed = 6;
constexpr double kCyclesAtLeast = 2.0;  ///< a cut-off with fewer cycles in the recording leaves only drift

std::string count_text(std::int64_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

void add(std::vector<Notice>& out, Verdict level, std::string about, std::string subject, std::string text,
         double time_s = kNaN) {
  out.push_back({level, std::move(about), std::move(subject), std::move(text), time_s});
}

void add_gates(const CleanReport& r, std::vector<Notice>& out) {
  for (const Gate& gate : r.run.gates)
    if (!gate.passed) add(out, Verdict::attention, "gate", gate.name, gate.sentence);
  if (r.run.exit_status != 0 && out.empty())
    add(out, Verdict::attention, "gate", "",
        fmt::format("The run ended with exit status {}.", r.run.exit_status));
}

/// Defects of one kind that ended the same way, together; a single one in its own words.
struct DefectGroup {
  const data::Defect* first = nullptr;
  bool sure = false;
  std::int64_t number = 0;
  std::vector<std::string> markers;
};

void add_defects(const CleanReport& r, std::vector<Notice>& out) {
  std::vector<DefectGroup> groups;
  for (const data::Defect& d : r.account.defects) {
    const bool sure = d.finding.sure();
    auto at = std::ranges::find_if(groups, [&](const DefectGroup& g) {
      return g.sure == sure && g.first->handled == d.handled && g.first->finding.kind == d.finding.kind &&
             g.first->done == d.done;
    });
    if (at == groups.end()) at = groups.insert(at, {&d, sure, 0, {}});
    ++at->number;
    const std::string name = d.finding.subject.empty() ? "all markers" : d.finding.subject;
    if (std::ranges::find(at->markers, name) == at->markers.end()) at->markers.push_back(name);
  }
  for (const DefectGroup& g : groups) {
    const data::Defect& d = *g.first;
    const Verdict level = g.sure && !d.handled ? Verdict::attention : Verdict::good;
    const std::string end = d.done.empty() ? "" : fmt::format(" What was done: {}.", d.done);
    const std::string unsure = g.sure ? "" : " Not certain: somebody should look.";
    std::string text = sentence_of(d.finding, r.time);
    if (g.number > 1)
      text = fmt::format("Defects of the kind \"{}\" in {} places ({}). The first: {}",
                         to_string(d.finding.kind), g.number, join_names(g.markers, kNamesListed), text);
    add(out, level, "marker", d.finding.subject, text + unsure + end, r.time.time_s(d.finding.first_frame));
  }
}

void add_upsampling(const CleanReport& r, std::vector<Notice>& out) {
  const data::UpsamplingAccount& up = r.account.upsampling;
  const std::string end = up.done.empty() ? "" : fmt::format(" What was done: {}.", up.done);
  const Verdict level = up.handled ? Verdict::good : Verdict::attention;
  if (up.recording.found()) {
    add(out, level, "upsampling", "",
        fmt::format("The recorder interpolated this recording: 1 of {} samples was measured.{}",
                    up.recording.factor, end));
    return;
  }
  std::vector<std::string> names;
  for (std::size_t m = 0; m < up.markers.size(); ++m)
    if (up.markers[m].found()) names.push_back(r.account.names[m]);
  if (names.empty()) return;
  add(out, level, "upsampling", names.front(),
      fmt::format("The recorder interpolated {} ({}).{}", count_text(std::ssize(names), "marker", "markers"),
                  join_names(names, kNamesListed), end));
}

/// One line for each marker that has fills nobody should rely on.
void add_uncertain_fills(const CleanReport& r, std::vector<Notice>& out) {
  std::vector<std::pair<const data::GapAccount*, std::int64_t>> worst;  // of a marker, and how many there are
  for (const data::GapAccount& g : r.account.gaps) {
    if (!g.filled || !(g.max_sd_m > kLargeSdM)) continue;
    auto at = std::ranges::find_if(worst, [&](const auto& w) { return w.first->marker == g.marker; });
    if (at == worst.end()) at = worst.insert(at, {&g, 0});
    ++at->second;
    if (g.max_sd_m > at->first->max_sd_m) at->first = &g;
  }
  for (const auto& [gap, number] : worst) {
    const std::string marker = r.account.name_of(gap->marker);
    add(out, Verdict::attention, "gap", marker,
        fmt::format("{} of {} {} filled with a standard deviation above {:.0f} mm; the largest is {:.1f} mm, "
                    "in a gap of {:.3g} s.",
                    count_text(number, "gap", "gaps"), marker, number == 1 ? "was" : "were", 1e3 * kLargeSdM,
                    1e3 * gap->max_sd_m, length_s(*gap, r.time)),
        r.time.time_s(gap->first_frame));
  }
}

void add_open_gaps(const CleanReport& r, std::vector<Notice>& out) {
  const data::GapAccount* longest = nullptr;
  std::int64_t number = 0;
  double sum_s = 0.0;
  std::vector<std::string> names;
  for (const data::GapAccount& g : r.account.gaps) {
    if (g.filled) continue;
    ++number;
    sum_s += length_s(g, r.time);
    if (longest == nullptr || length_s(g, r.time) > length_s(*longest, r.time)) longest = &g;
    std::string name = r.account.name_of(g.marker);
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  if (longest == nullptr) return;
  const std::string why = longest->why_open.empty() ? "" : fmt::format(": {}", longest->why_open);
  const std::string marker = r.account.name_of(longest->marker);
  add(out, Verdict::good, "gap", marker,
      fmt::format("{} left open ({:.3g} s in all, in {}); the longest lasts {:.3g} s in {}{}.",
                  count_text(number, "gap was", "gaps were"), sum_s, join_names(names, kNamesListed),
                  length_s(*longest, r.time), marker, why),
      r.time.time_s(longest->first_frame));
}

/// One line for all markers of which something holds.
void add_of_markers(const CleanReport& r, std::vector<Notice>& out,
                    const std::function<bool(std::size_t)>& holds, std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t m = 0; m < r.account.markers.size(); ++m)
    if (holds(m)) names.push_back(r.account.markers[m].name);
  if (names.empty()) return;
  add(out, Verdict::good, "marker", names.front(),
      fmt::format("{} ({} of {}): {}", join_names(names, kNamesListed), names.size(),
                  count_text(std::ssize(r.account.markers), "marker", "markers"), text));
}

void add_filters(const CleanReport& r, std::vector<Notice>& out) {
  const double seconds = static_cast<double>(r.time.frames) / r.time.rate_hz;
  const auto& markers = r.account.markers;
  const auto chosen = [&](std::size_t m) { return !markers[m].criterion_name.empty(); };
  add_of_markers(
      r, out,
      [&](std::size_t m) { return markers[m].coloured() && markers[m].white_departure >= kMuchColour; },
      "the residual is not white (p < 0.01): more than a tenth of the noise power lies too low in frequency. "
      "The "
      "filter took away more than noise, or the noise is not white: the error bars are too small.");
  add_of_markers(
      r, out,
      [&](std::size_t m) { return markers[m].coloured() && markers[m].white_departure <= -kMuchColour; },
      "the residual is not white (p < 0.01): more than a tenth of the noise power lies too high in "
      "frequency. The "
      "error bars are too large.");
  add_of_markers(
      r, out,
      [&](std::size_t m) { return chosen(m) && markers[m].used.cutoff_hz > kHighCutoff * r.time.rate_hz; },
      "the cut-off found is at the upper end of its range. Next to no noise was there to take away; data "
      "that "
      "were filtered before look like this.");
  add_of_markers(
      r, out,
      [&](std::size_t m) { return chosen(m) && markers[m].used.cutoff_hz * seconds < kCyclesAtLeast; },
      "the cut-off found is at the lower end of its range. The marker hardly moves, or the recording is too "
      "short to tell movement from noise.");
  add_of_markers(
      r, out, [&](std::size_t m) { return markers[m].bad_variances > 0; },
      "some variances were not positive and finite; the marker's median was taken instead.");
}

}  // namespace

std::vector<Notice> clean_findings(const CleanReport& report) {
  check(report.counts.size() == report.account.markers.size(), "add_marker() counts a marker's samples");
  std::vector<Notice> out;
  add_gates(report, out);
  add_defects(report, out);
  add_upsampling(report, out);
  add_uncertain_fills(report, out);
  add_of_markers(
      report, out,
      [&](std::size_t m) {
        constexpr auto kMissing = static_cast<std::size_t>(data::SampleState::missing);
        return report.counts[m].before[kMissing] == report.time.frames && report.time.frames > 0;
      },
      "never seen.");
  add_open_gaps(report, out);
  add_filters(report, out);
  for (const std::string& warning : report.run.warnings) add(out, Verdict::good, "warning", "", warning);
  // Stable order, serious findings first.
  std::vector<Notice> sorted;
  for (const Verdict level : {Verdict::attention, Verdict::good})
    std::ranges::copy_if(out, std::back_inserter(sorted), [&](const Notice& f) { return f.level == level; });
  return sorted;
}

}  // namespace kinemark::report

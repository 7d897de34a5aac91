// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/file_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/files/info_json.h"

namespace kinemark::pipeline {
namespace {

/// Of one file; what it does not have is empty.
struct Size {
  std::string format, holds;
  std::optional<std::int64_t> frames;
  std::optional<double> rate_hz;
  [[nodiscard]] std::optional<double> seconds() const {
    return frames && rate_hz ? std::optional(static_cast<double>(*frames) / *rate_hz) : std::nullopt;
  }
};

std::string count(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

Size size_of(const MarkerFileFacts& facts) {
  return {.format = facts.format,
          .holds = count(static_cast<std::size_t>(facts.points), "marker"),
          .frames = facts.frames,
          .rate_hz = facts.rate_hz};
}

Size size_of(const TableFacts& facts) {
  Size size{.holds = count(facts.labels.size(), "column"), .frames = facts.rows};
  if (facts.rows > 1 && *facts.last_time_s > *facts.first_time_s)
    size.rate_hz = static_cast<double>(facts.rows - 1) / (*facts.last_time_s - *facts.first_time_s);
  return size;
}

Size size_of(const OrientationFacts& facts) {
  return {.holds = count(facts.sensors.size(), "sensor"), .frames = facts.frames, .rate_hz = facts.rate_hz};
}

Size size_of(const ModelFacts& facts) { return {.holds = count(facts.labels.size(), "coordinate")}; }

Size size_of(const RecordingFacts& facts) {
  if (!facts.counts) return {.holds = fmt::format("{} messages", facts.messages)};
  return {.holds = count(facts.counts->labels.size(), "LED"),
          .frames = facts.counts->frames,
          .rate_hz = facts.counts->rate_hz};
}

Size size_of(const io::Vsk& vsk) { return {.holds = count(vsk.segments.size(), "segment")}; }

Size size_of(const CheckedFile& checked) {
  Size size;
  if (checked.facts) size = std::visit([](const auto& facts) { return size_of(facts); }, *checked.facts);
  if (size.format.empty() && checked.facts) {
    size.format = ending_of(checked.file).substr(1);
    std::ranges::transform(size.format, size.format.begin(), [](unsigned char c) { return std::toupper(c); });
  }
  return size;
}

std::string what_is_said_of(const CheckedFile& checked) {
  if (checked.error) return printable_sentence(checked.error->message);
  if (checked.warnings.empty()) return "good";
  const std::string first = printable_sentence(checked.warnings.front());
  return checked.warnings.size() == 1 ? first
                                      : fmt::format("{} (and {} more)", first, checked.warnings.size() - 1);
}

std::vector<std::string> row_of(const CheckedFile& checked, const Size& size) {
  const auto seconds = size.seconds();
  return {printable(checked.file.string()),
          size.format,
          size.holds,
          size.frames ? std::to_string(*size.frames) : "",
          size.rate_hz ? fmt::format("{:.5g}", *size.rate_hz) : "",
          seconds ? fmt::format("{:.2f}", *seconds) : "",
          what_is_said_of(checked)};
}

/// Characters of UTF-8.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.empty() ? 0 : rows.front().size());
  for (const auto& row : rows)
    for (std::size_t c = 0; c < widths.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c + 1 < row.size(); ++c)
      text += row[c] + std::string(widths[c] - width_of(row[c]) + 2, ' ');
    text += row.back() + "\n";
  }
  return text;
}

std::string file_table(const ValidateOutcome& outcome) {
  std::vector<std::vector<std::string>> rows{{"file", "format", "holds", "frames", "Hz", "s", "findings"}};
  std::int64_t good = 0, odd = 0, frames = 0;
  double seconds = 0.0;
  for (const auto& checked : outcome.files) {
    const Size size = size_of(checked);
    rows.push_back(row_of(checked, size));
    good += checked.exit_status() == 0;
    odd += checked.exit_status() == 1;
    frames += size.frames.value_or(0);
    seconds += size.seconds().value_or(0.0);
  }
  return aligned(rows) + fmt::format("{}: {} good, {} with findings, {} not readable; {} frames, {:.2f} s\n",
                                     count(outcome.files.size(), "file"), good, odd,
                                     std::ssize(outcome.files) - good - odd, frames, seconds);
}

nlohmann::ordered_json files_json(const ValidateOutcome& outcome) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& checked : outcome.files) {
    if (checked.facts)
      list.push_back(info_json({{.warnings = checked.warnings}, checked.file, *checked.facts}));
    else
      list.push_back({{"file", checked.file.string()},
                      {"exit_status", checked.exit_status()},
                      {"error", checked.error ? checked.error->message : ""}});
  }
  return list;
}

std::string trial_table(const ManyOutcome& outcome) {
  std::vector<std::vector<std::string>> rows{{"recording", "status", "s", "output", "findings"}};
  std::map<TrialStatus, int> counts;
  for (const auto& trial : outcome.trials) {
    ++counts[trial.status];
    const bool has_output = trial.status != TrialStatus::failed && trial.status != TrialStatus::not_begun;
    std::string said = printable_sentence(trial.said);
    if (trial.warnings > 1) said += fmt::format(" (and {} more)", trial.warnings - 1);
    rows.push_back({printable(trial.input.string()), std::string(to_string(trial.status)),
                    trial.seconds > 0.0 ? fmt::format("{:.2f}", trial.seconds) : "",
                    has_output ? printable(trial.output.string()) : "", std::move(said)});
  }
  std::string totals = count(outcome.trials.size(), "recording") + ":";
  for (const auto& [status, n] : counts)
    totals += fmt::format("{} {} {}", totals.back() == ':' ? "" : ",", n, to_string(status));
  if (counts.contains(TrialStatus::there))
    totals += "; what was there already is as it was, whatever the options now (--force makes it anew)";
  return aligned(rows) + totals + "\n";
}

nlohmann::ordered_json trials_json(const ManyOutcome& outcome) {
  auto trials = nlohmann::ordered_json::array();
  for (const auto& trial : outcome.trials)
    trials.push_back({{"input", trial.input.string()},
                      {"output", trial.output.string()},
                      {"status", to_string(trial.status)},
                      {"exit_status", trial.exit_status},
                      {"seconds", trial.seconds},
                      {"warnings", trial.warnings},
                      {"said", trial.said}});
  return {{"exit_status", outcome.exit_status()}, {"trials", std::move(trials)}};
}

}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/trial_spans.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {
namespace {

constexpr const char* kTrials = "trials";

/// "trial" of "trials".
std::string one_of(const std::string& name) {
  return name.size() > 1 && name.ends_with('s') ? name.substr(0, name.size() - 1) : name;
}

std::unexpected<Error> no_table(const data::Neural& neural, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& table : neural.intervals) names.push_back(table.name);
  const auto near = nearest_names(name, names);
  return fail(Code::usage, fmt::format("--trials: there are no intervals '{}'; {}", name,
                                       names.empty()  ? "the file has none"
                                       : near.empty() ? fmt::format("there are {}", join_names(names, 8))
                                                      : fmt::format("nearest: {}", join(near))));
}

}  // namespace

TrialSpans spans_of(const data::IntervalTable& table, const TimeBase& time) {
  TrialSpans out;
  const std::string one = one_of(table.name);
  std::int64_t left_out = 0, timeless = 0, short_ones = 0;
  if (!table.rows.empty())
    for (const auto& label : table.rows.front().labels) out.labels.columns.push_back(label.column);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    if (std::isnan(row.start_s) || std::isnan(row.stop_s)) {
      ++timeless;
      continue;
    }
    const auto first = time.nearest_frame(row.start_s), last = time.nearest_frame(row.stop_s);
    if (first < 0 || last >= time.frames || last <= first) {
      ++(first < 0 || last >= time.frames ? left_out : short_ones);
      continue;
    }
    const std::string name = fmt::format("{} {}", one, i + 1);
    out.regions.push_back({.name = name, .first_frame = time.number(first), .last_frame = time.number(last)});
    auto& cells = out.labels.cells[name];
    for (const auto& label : row.labels) cells.push_back(label.value);
  }
  const auto kept = static_cast<std::int64_t>(out.regions.size());
  if (kept > 0)
    out.notes.push_back(fmt::format("each of {} of the file is measured (--trials none: the whole recording)",
                                    counted(kept, one)));
  const std::string all = counted(std::ssize(table.rows), one);
  if (left_out > 0)
    out.notes.push_back(
        fmt::format("{} of {} are not wholly in the recording and not measured", left_out, all));
  if (short_ones > 0)
    out.notes.push_back(fmt::format("{} of {} are shorter than a frame and not measured", short_ones, all));
  if (timeless > 0)
    out.notes.push_back(fmt::format("{} of {} have no start or no stop and are not measured", timeless, all));
  return out;
}

Result<TrialSpans> trial_spans(const std::filesystem::path& file, const std::string& name,
                               const TimeBase& time) {
  if (name == kNoTrials) return TrialSpans{};
  if (ending_of(file) != ".nwb") {
    if (name.empty()) return TrialSpans{};
    return fail(Code::usage, fmt::format("--trials: {} is no .nwb and has no intervals", file.string()));
  }
  const auto neural = io::read_neural(file);
  if (!neural) {
    if (!name.empty()) return std::unexpected(neural.error());
    TrialSpans out;
    out.notes.push_back("trials are not looked for: " + neural.error().message);
    return out;
  }
  const auto* table = neural->find_intervals(name.empty() ? kTrials : name);
  if (table == nullptr) return name.empty() ? Result<TrialSpans>(TrialSpans{}) : no_table(*neural, name);
  auto out = spans_of(*table, time);
  if (out.regions.empty() && !name.empty())
    return fail(Code::bad_input, fmt::format("{}: no interval of '{}' is wholly in the recording",
                                             file.string(), table->name));
  return out;
}

}  // namespace kinemark::pipeline

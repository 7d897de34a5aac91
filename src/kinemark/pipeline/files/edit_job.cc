// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/edit_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/workflow/prepare/exchanged_labels.h"

namespace kinemark::pipeline {
namespace {

using data::EditKind;

constexpr double kSlack = 1e-6;  // frames: what times lose in decimal digits

bool is_of_event(EditKind kind) {
  return kind == EditKind::mark_event || kind == EditKind::move_event || kind == EditKind::delete_event;
}

bool is_of_history(EditKind kind) { return kind == EditKind::undo || kind == EditKind::redo; }

/// A frame, not always whole, counted from the recording's first; and whether it was given as a time.
struct Moment {
  double frame = 0.0;
  bool is_time = false;
};

Result<Moment> parse_moment(const std::string& text, const data::Trial& trial) {
  const auto& time = trial.markers.time;
  const bool is_time = text.ends_with('s');
  const auto number = parse_number(is_time ? std::string_view(text).substr(0, text.size() - 1) : text);
  if (!number || !(std::abs(*number) < 1e9) || (!is_time && *number != std::floor(*number)))
    return fail(Code::usage,
                fmt::format("'{}' is no moment; need a frame such as 120, or a time such as 1.5s", text));
  return Moment{.frame = is_time ? (*number - time.t0_s) * time.rate_hz
                                 : *number - static_cast<double>(trial.first_frame),
                .is_time = is_time};
}

/// Time of a moment, s.
Result<double> time_of(const std::string& text, const data::Trial& trial) {
  const auto moment = parse_moment(text, trial);
  if (!moment) return std::unexpected(moment.error());
  if (moment->is_time) return *parse_number(std::string_view(text).substr(0, text.size() - 1));
  return trial.markers.time.time_s(static_cast<std::int64_t>(moment->frame));
}

/// Number of the frame at a moment, or the next within the range.
Result<std::int64_t> frame_of(const std::string& text, const data::Trial& trial, bool is_first) {
  const auto moment = parse_moment(text, trial);
  if (!moment) return std::unexpected(moment.error());
  const double frame = is_first ? std::ceil(moment->frame - kSlack) : std::floor(moment->frame + kSlack);
  return trial.first_frame + static_cast<std::int64_t>(frame);
}

/// Ends and times of the edit, in the recording's frames and on its clock.
Status place_edit(const EditJob& job, const data::Trial& trial, data::Edit& edit) {
  if (is_of_event(edit.kind)) {
    if (job.at.empty()) return fail(Code::usage, "an event needs its time: --at 120, or --at 1.5s");
    const auto at = time_of(job.at, trial);
    if (!at) return std::unexpected(at.error());
    edit.time_s = *at;
    if (edit.kind != EditKind::move_event) return {};
    if (job.to.empty()) return fail(Code::usage, "an event that is moved needs its new time: --to 1.6s");
    const auto to = time_of(job.to, trial);
    if (!to) return std::unexpected(to.error());
    edit.to_s = *to;
    return {};
  }
  for (const auto& [text, frame, is_first] :
       {std::tuple{&job.from, &edit.first_frame, true}, std::tuple{&job.to, &edit.last_frame, false}}) {
    if (text->empty()) continue;
    const auto number = frame_of(*text, trial, is_first);
    if (!number) return std::unexpected(number.error());
    *frame = *number;
  }
  return {};
}

/// The exchanges that a recording needs, one edit each.
Result<std::vector<data::Edit>> find_exchange_edits(const EditJob& job, const data::Trial& trial) {
  const auto swaps = workflow::find_label_swaps(trial);
  if (!swaps) return std::unexpected(swaps.error());
  std::vector<data::Edit> edits;
  for (const auto& swap : workflow::sure_swaps(*swaps)) {
    edits.push_back(workflow::edit_of(swap, trial));
    if (job.edit) {
      edits.back().made = job.edit->made;
      edits.back().author = job.edit->author;
    }
  }
  return edits;
}

}  // namespace

Result<EditOutcome> run_edit(const EditJob& job) {
  EditOutcome outcome;
  outcome.journal = job.edits.empty() ? io::edits_of(job.input) : job.edits;
  const auto recording = io::identify_recording(job.input);
  if (!recording) return std::unexpected(recording.error());
  auto read = io::read_edits_of(outcome.journal, *recording, job.force);
  if (!read) return std::unexpected(read.error());
  auto input = io::read_marker_input({.path = job.input, .rate_hz = job.rate_hz, .unit = job.unit});
  if (!input) return std::unexpected(input.error());
  outcome.list = std::move(read->list);
  outcome.warnings = std::move(read->notes);
  std::vector<data::Edit> more;  // to append
  if (job.exchanges) {
    auto state = outcome.list.edits_in_force();
    if (!state) return fail_at(outcome.journal.string(), state.error());
    auto now = trajectory::apply_edits(trajectory::EditedTrial{.trial = input->trial}, *state,
                                       {.seed = job.seed, .threads = job.threads});
    if (!now) return fail_at(outcome.journal.string(), now.error());
    auto found = find_exchange_edits(job, now->trial);
    if (!found) return fail_at(job.input.string(), found.error());
    more = std::move(*found);
  } else if (job.edit) {
    auto edit = *job.edit;
    if (auto s = place_edit(job, input->trial, edit); !s) return std::unexpected(s.error());
    if (auto s = edit.check(); !s) return fail(Code::usage, s.error().message);
    more.push_back(std::move(edit));
  }
  const auto before = outcome.list.edits.size();
  outcome.list.edits.insert(outcome.list.edits.end(), more.begin(), more.end());
  auto in_force = outcome.list.edits_in_force();
  if (!in_force) return fail_at(outcome.journal.string(), in_force.error());
  auto edited = trajectory::apply_edits(trajectory::EditedTrial{.trial = std::move(input->trial)}, *in_force,
                                        {.seed = job.seed, .threads = job.threads, .progress = job.progress});
  if (!edited) return fail_at(outcome.journal.string(), edited.error());
  outcome.warnings.insert(outcome.warnings.end(), edited->notes.begin(), edited->notes.end());
  outcome.regions = std::move(edited->regions);
  outcome.digest = io::digest_of(*in_force);
  outcome.in_force = std::move(*in_force);
  if (job.exchanges && more.empty())
    outcome.warnings.push_back("no two markers surely carry each other's label: nothing was appended");
  if (more.empty()) return outcome;
  // Tried: now it is made.
  for (std::size_t i = 0; i < more.size(); ++i) {
    auto list = io::append_edit(outcome.journal, *recording, before + i, std::move(more[i]), job.force);
    if (!list) return std::unexpected(list.error());
    outcome.list = std::move(*list);
    ++outcome.appended;
  }
  in_force = outcome.list.edits_in_force();
  if (in_force) outcome.in_force = std::move(*in_force);
  outcome.written = {outcome.journal};
  return outcome;
}

std::string time_of_edit() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  if (::gmtime_r(&now, &utc) == nullptr) return {};
  std::array<char, 32> text{};
  const auto n = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), n};
}

nlohmann::ordered_json edit_json(const EditOutcome& outcome) {
  const auto counts = outcome.list.in_force();
  auto edits = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < outcome.list.edits.size(); ++i) {
    const auto& edit = outcome.list.edits[i];
    auto json = nlohmann::ordered_json::parse(io::format_edit(edit));
    json["words"] = describe(edit);
    if (!is_of_history(edit.kind)) json["in_force"] = counts && std::ranges::binary_search(*counts, i);
    edits.push_back(std::move(json));
  }
  auto regions = nlohmann::ordered_json::array();
  for (const auto& region : outcome.regions)
    regions.push_back({{"name", region.name}, {"first", region.first_frame}, {"last", region.last_frame}});
  const auto depth = outcome.list.depth();
  return {{"journal", outcome.journal.string()}, {"digest", outcome.digest}, {"edits", std::move(edits)},
          {"regions", std::move(regions)},       {"undo", depth.undo},       {"redo", depth.redo},
          {"warnings", outcome.warnings}};
}

}  // namespace kinemark::pipeline

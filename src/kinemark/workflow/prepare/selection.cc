// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/selection.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/name_pattern.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/data/name_index.h"
#include "kinemark/stages/trajectory/edits/part_of_trial.h"

namespace kinemark::workflow {
namespace {

using Indices = std::vector<std::int64_t>;

std::vector<std::string> names_of(const data::Trial& trial) {
  auto names = trial.markers.names;
  names.insert(names.end(), trial.channels.names.begin(), trial.channels.names.end());
  return names;
}

/// Names of markers, then of channels.
class Names {
 public:
  explicit Names(std::vector<std::string> all) : all_(std::move(all)), index_(all_) {}

  /// What a name or pattern stands for.
  [[nodiscard]] Result<Indices> find(const std::string& name) const {
    Indices found;
    if (const auto i = index_.find(name); i >= 0)
      found.push_back(i);  // also a name that looks like a pattern, such as Vicon's *1
    else if (is_name_pattern(name))
      found = like(name);
    if (!found.empty()) return found;
    auto near = nearest_names(name, all_);
    if (index_.ambiguous(name) || near.empty())
      return fail(Code::bad_input,
                  fmt::format("no marker is named '{}'; there are {}", name, index_.instead_of(name)));
    return fail(Code::bad_input, fmt::format("no marker is named '{}'; nearest: {}", name, join(near)));
  }

  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  [[nodiscard]] Indices like(std::string_view pattern) const {
    Indices found;
    for (std::int64_t i = 0; i < std::ssize(all_); ++i)
      if (matches_name_pattern(pattern, all_[at(i)]) ||
          matches_name_pattern(pattern, data::without_prefix(all_[at(i)])))
        found.push_back(i);
    return found;
  }

  std::vector<std::string> all_;
  data::NameIndex index_;
};

/// OLD and NEW of "OLD=NEW"; the last '=' divides.
std::optional<std::pair<std::string, std::string>> parse_rename(const std::string& text) {
  const auto equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) return std::nullopt;
  return std::pair{text.substr(0, equals), text.substr(equals + 1)};
}

/// A frame number, or nothing of "" which means no bound; not finite: no number.
std::optional<double> parse_bound(std::string_view text, double unbounded) {
  if (text.empty()) return unbounded;
  const auto number = parse_number(text);
  return number && *number == std::floor(*number) && std::abs(*number) < 1e15 ? number : std::nullopt;
}

/// First and last number of "101-250".
std::optional<std::pair<double, double>> parse_frames(std::string_view text) {
  const auto dash = text.find('-');
  if (dash == std::string_view::npos || text == "-") return std::nullopt;
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  const auto first = parse_bound(text.substr(0, dash), -kUnbounded),
             last = parse_bound(text.substr(dash + 1), kUnbounded);
  if (!first || !last || *first > *last) return std::nullopt;
  return std::pair{*first, *last};
}

Result<trajectory::FrameSpan> frames_of(const Selection& selection, const data::Trial& trial) {
  const auto& time = trial.markers.time;
  double first = (selection.first_time_s - time.t0_s) * time.rate_hz,
         last = (selection.last_time_s - time.t0_s) * time.rate_hz;
  if (const auto numbers = parse_frames(selection.frames)) {
    first = numbers->first - static_cast<double>(trial.first_frame);
    last = numbers->second - static_cast<double>(trial.first_frame);
  }
  constexpr double kSlack = 1e-6;  // frames: what times lose in decimal digits
  const double end = static_cast<double>(time.frames - 1);
  first = std::ceil(std::clamp(first, 0.0, end + 1.0) - kSlack);
  last = std::floor(std::clamp(last, -1.0, end) + kSlack);
  if (time.frames > 0 && first > last)
    return fail(Code::bad_input,
                fmt::format("no frame lies in the range asked for; the recording has frames {} to {}, "
                            "{:.6g} to {:.6g} s",
                            trial.first_frame, trial.last_frame(), time.t0_s, time.time_s(time.frames - 1)));
  return trajectory::FrameSpan{.first = static_cast<std::int64_t>(first),
                               .count = time.frames > 0 ? static_cast<std::int64_t>(last - first) + 1 : 0};
}

/// Indices of the names that stay.
Result<Indices> kept_names(const Selection& selection, const Names& names) {
  std::vector<bool> keep(names.all().size(), selection.select.empty());
  for (const auto& [list, value] : {std::pair{&selection.select, true}, std::pair{&selection.drop, false}})
    for (const auto& name : *list) {
      const auto found = names.find(name);
      if (!found) return std::unexpected(found.error());
      for (const auto i : *found) keep[at(i)] = value;
    }
  Indices kept;
  for (std::int64_t i = 0; i < std::ssize(keep); ++i)
    if (keep[at(i)]) kept.push_back(i);
  return kept;
}

/// All names after renaming.
Result<std::vector<std::string>> new_names(const Selection& selection, const Names& names,
                                           const Indices& kept) {
  auto renamed = names.all();
  for (const auto& text : selection.rename) {
    const auto pair = parse_rename(text);
    const auto found = names.find(pair->first);
    if (!found) return std::unexpected(found.error());
    renamed[at(found->front())] = pair->second;
  }
  std::vector<std::string> sorted;
  for (const auto i : kept) sorted.push_back(renamed[at(i)]);
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    return fail(Code::bad_input, fmt::format("two markers would be named '{}'", *twice));
  return renamed;
}

}  // namespace

bool Selection::empty() const {
  return select.empty() && drop.empty() && rename.empty() && frames.empty() && std::isinf(first_time_s) &&
         std::isinf(last_time_s);
}

Selection Selection::without_times() const {
  const Selection unbounded;
  Selection out = *this;
  out.first_time_s = unbounded.first_time_s;
  out.last_time_s = unbounded.last_time_s;
  return out;
}

Selection Selection::names_in(const data::Trial& trial) const {
  const Names names(names_of(trial));
  const auto is_there = [&](const std::string& name) { return names.find(name).has_value(); };
  Selection out;
  std::ranges::copy_if(select, std::back_inserter(out.select), is_there);
  if (out.select.empty()) out.select = select;
  std::ranges::copy_if(drop, std::back_inserter(out.drop), is_there);
  std::ranges::copy_if(rename, std::back_inserter(out.rename), [&](const std::string& text) {
    const auto pair = parse_rename(text);
    return pair && is_there(pair->first);
  });
  return out;
}

Status Selection::check() const {
  if (!frames.empty() && !parse_frames(frames))
    return fail(Code::usage, fmt::format("'{}' is no range of frames such as 101-250, 101- or -250", frames));
  if (!frames.empty() && !(std::isinf(first_time_s) && std::isinf(last_time_s)))
    return fail(Code::usage, "a range of frames and one of times: need one of them");
  if (std::isnan(first_time_s) || std::isnan(last_time_s) || first_time_s > last_time_s)
    return fail(Code::usage, fmt::format("no time lies between {} and {} s", first_time_s, last_time_s));
  for (const auto& text : rename) {
    const auto pair = parse_rename(text);
    if (!pair) return fail(Code::usage, fmt::format("'{}' is no new name such as OLD=NEW", text));
    if (is_name_pattern(pair->first))
      return fail(Code::usage, fmt::format("'{}' renames several markers; need one name", text));
  }
  return {};
}

Status take_selection(const Selection& selection, data::Trial& trial) {
  if (auto s = selection.check(); !s) return s;
  if (selection.empty()) return {};
  const Names names(names_of(trial));
  const auto M = trial.markers.markers();
  const auto kept = kept_names(selection, names);
  if (!kept) return std::unexpected(kept.error());
  Indices markers, channels;
  for (const auto i : *kept) (i < M ? markers : channels).push_back(i < M ? i : i - M);
  if (markers.empty()) return fail(Code::bad_input, "no marker is left of the recording");
  const auto renamed = new_names(selection, names, *kept);
  if (!renamed) return std::unexpected(renamed.error());
  const auto frames = frames_of(selection, trial);
  if (!frames) return std::unexpected(frames.error());

  trajectory::keep_part(trial, *frames, markers, channels);
  for (std::size_t i = 0; i < markers.size(); ++i) trial.markers.names[i] = (*renamed)[at(markers[i])];
  for (std::size_t i = 0; i < channels.size(); ++i) trial.channels.names[i] = (*renamed)[at(M + channels[i])];
  return {};
}

}  // namespace kinemark::workflow

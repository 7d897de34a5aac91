// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/edit.h"

#include <fmt/core.h>

#include <cmath>
#include <tuple>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/core/utf8.h"
#include "kinemark/data/frame_list.h"

namespace kinemark::data {
namespace {

constexpr EnumNames<EditKind::redo> kEditKinds{"relabel", "swap", "cut",    "fill",   "unfill", "crop",
                                               "mark",    "move", "delete", "region", "undo",   "redo"};
constexpr std::size_t kLongestName = 400;              // bytes, of markers, labels and regions
constexpr std::int64_t kLargestFrame = 1'000'000'000;  // by its absolute value
constexpr double kLatestTime_s = 1e9;
constexpr int kMostSteps = 1'000'000;  // of undo and redo

/// A name that a file can hold as it is.
Status check_name(const Edit& edit, std::string_view what, const std::string& name, bool needed = true) {
  if (needed && name.empty())
    return fail(Code::bad_input, fmt::format("{} needs {}", to_string(edit.kind), what));
  if (name.size() > kLongestName)
    return fail(Code::bad_input, fmt::format("{} of {}: {} bytes; need {} at most", what,
                                             to_string(edit.kind), name.size(), kLongestName));
  if (name_of_bytes(name) != name)
    return fail(Code::bad_input,
                fmt::format("{} of {} is '{}'; need text without control characters and blanks at its ends",
                            what, to_string(edit.kind), printable(name)));
  return {};
}

Status check_range(const Edit& edit) {
  for (const auto& frame : {edit.first_frame, edit.last_frame})
    if (frame && (*frame > kLargestFrame || *frame < -kLargestFrame))
      return fail(Code::bad_input,
                  fmt::format("{}: frame {} is none of a recording", to_string(edit.kind), *frame));
  if (edit.first_frame && edit.last_frame && *edit.first_frame > *edit.last_frame)
    return fail(Code::bad_input, fmt::format("{} of frames {} to {}: the first lies behind the last",
                                             to_string(edit.kind), *edit.first_frame, *edit.last_frame));
  const bool one = edit.first_frame || edit.last_frame, both = edit.first_frame && edit.last_frame;
  if (edit.kind == EditKind::crop && !one) return fail(Code::bad_input, "crop needs a first or a last frame");
  if (edit.kind == EditKind::region && !both)
    return fail(Code::bad_input, "region needs a first and a last frame");
  return {};
}

Status check_markers(const Edit& edit) {
  if (auto s = check_name(edit, "a marker", edit.marker); !s) return s;
  if (edit.kind != EditKind::relabel && edit.kind != EditKind::swap) return {};
  if (auto s = check_name(edit, edit.kind == EditKind::swap ? "a second marker" : "a new name", edit.other);
      !s)
    return s;
  if (edit.marker == edit.other)
    return fail(Code::bad_input,
                fmt::format("{} of '{}' and itself changes nothing", to_string(edit.kind), edit.marker));
  return {};
}

Status check_event(const Edit& edit) {
  if (auto s = check_name(edit, "a label", edit.label); !s) return s;
  if (auto s = check_name(edit, "a context", edit.context, false); !s) return s;
  for (const double time_s : {edit.time_s, edit.to_s})
    if (!(std::abs(time_s) <= kLatestTime_s))
      return fail(Code::bad_input, fmt::format("{} of event '{}': {} is no time of a recording, in s",
                                               to_string(edit.kind), edit.label, time_s));
  return {};
}

/// The frames of a swap that lists them.
Status check_frames(const Edit& edit) {
  if (edit.frames.empty()) return {};
  if (edit.first_frame || edit.last_frame)
    return fail(Code::bad_input,
                fmt::format("{} has a range and a list of frames; need one of them", to_string(edit.kind)));
  if (const auto frames = parse_frame_list(edit.frames); !frames)
    return fail(Code::bad_input, fmt::format("{}: {}", to_string(edit.kind), frames.error().message));
  return {};
}

std::string words_of_range(const Edit& edit) {
  if (!edit.frames.empty())
    if (const auto frames = parse_frame_list(edit.frames))
      return fmt::format(", {}: {}", counted(std::ssize(*frames), "frame"),
                         words_of_frames(*frames, {.frames = 0, .first_number = 0}));
  if (edit.first_frame && edit.last_frame)
    return *edit.first_frame == *edit.last_frame
               ? fmt::format(", frame {}", *edit.first_frame)
               : fmt::format(", frames {} to {}", *edit.first_frame, *edit.last_frame);
  if (edit.first_frame) return fmt::format(", from frame {} on", *edit.first_frame);
  if (edit.last_frame) return fmt::format(", up to frame {}", *edit.last_frame);
  return "";
}

std::string words_of_event(const Edit& edit) {
  return fmt::format("event '{}'{} at {:.6g} s", edit.label,
                     edit.context.empty() ? "" : fmt::format(" ({})", edit.context), edit.time_s);
}

/// What is in force, and what was undone, the last of each at the back.
struct Stacks {
  std::vector<std::size_t> in_force, undone;
};

void move_last(std::vector<std::size_t>& from, std::vector<std::size_t>& to, int count) {
  for (int i = 0; i < count; ++i) {
    to.push_back(from.back());
    from.pop_back();
  }
}

Result<Stacks> replay(const std::vector<Edit>& edits) {
  Stacks stacks;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const Edit& edit = edits[i];
    const bool is_undo = edit.kind == EditKind::undo;
    if (!is_undo && edit.kind != EditKind::redo) {
      stacks.in_force.push_back(i);
      stacks.undone.clear();
      continue;
    }
    auto& from = is_undo ? stacks.in_force : stacks.undone;
    auto& to = is_undo ? stacks.undone : stacks.in_force;
    if (edit.count < 1 || std::cmp_greater(edit.count, from.size()))
      return fail(Code::bad_input,
                  fmt::format("{}: {} of {}, where there {}", place_of(edit), to_string(edit.kind),
                              counted(edit.count, "operation"),
                              from.empty() ? "is nothing left"
                                           : fmt::format("{} {}", from.size() == 1 ? "is" : "are",
                                                         std::to_string(from.size()))));
    move_last(from, to, edit.count);
  }
  return stacks;
}

}  // namespace

std::string_view to_string(EditKind kind) { return kEditKinds[kind]; }

Result<EditKind> parse_edit_kind(std::string_view name) {
  return kEditKinds.parse(name, "operation", Code::bad_input);
}

Status Edit::check() const {
  for (const auto& [what, text] : {std::pair{"the id", &id}, {"the time", &made}, {"the author", &author}})
    if (auto s = check_name(*this, what, *text, false); !s) return s;
  switch (kind) {
    case EditKind::relabel:
    case EditKind::swap:
    case EditKind::cut:
    case EditKind::fill:
    case EditKind::unfill:
      if (auto s = check_markers(*this); !s) return s;
      if (auto s = check_frames(*this); !s) return s;
      return check_range(*this);
    case EditKind::crop:
      return check_range(*this);
    case EditKind::mark_event:
    case EditKind::move_event:
    case EditKind::delete_event:
      return check_event(*this);
    case EditKind::region:
      if (auto s = check_name(*this, "a name", name); !s) return s;
      return check_range(*this);
    case EditKind::undo:
    case EditKind::redo:
      if (count >= 1 && count <= kMostSteps) return {};
      return fail(Code::bad_input,
                  fmt::format("{} of {} operations; need 1 to {}", data::to_string(kind), count, kMostSteps));
  }
  return {};
}

bool Edit::same_as(const Edit& that) const {
  const auto facts = [](const Edit& e) {
    return std::tie(e.kind, e.marker, e.other, e.first_frame, e.last_frame, e.frames, e.method, e.label,
                    e.context, e.time_s, e.to_s, e.name, e.count);
  };
  return facts(*this) == facts(that);
}

std::string describe(const Edit& edit) {
  const auto kind = to_string(edit.kind);
  switch (edit.kind) {
    case EditKind::relabel:
      return fmt::format("relabel of '{}' to '{}'{}", edit.marker, edit.other, words_of_range(edit));
    case EditKind::swap:
      return fmt::format("swap of '{}' and '{}'{}", edit.marker, edit.other, words_of_range(edit));
    case EditKind::cut:
    case EditKind::unfill:
      return fmt::format("{} of '{}'{}", kind, edit.marker, words_of_range(edit));
    case EditKind::fill:
      return fmt::format("fill of '{}'{} by {}", edit.marker, words_of_range(edit),
                         edit.method.empty() ? "auto" : edit.method);
    case EditKind::crop:
      return fmt::format("crop{}", words_of_range(edit));
    case EditKind::mark_event:
    case EditKind::delete_event:
      return fmt::format("{} {}", kind, words_of_event(edit));
    case EditKind::move_event:
      return fmt::format("{} {} to {:.6g} s", kind, words_of_event(edit), edit.to_s);
    case EditKind::region:
      return fmt::format("region '{}'{}", edit.name, words_of_range(edit));
    case EditKind::undo:
    case EditKind::redo:
      break;
  }
  return fmt::format("{} of {}", kind, counted(edit.count, "operation"));
}

std::string place_of(const Edit& edit) {
  if (edit.line > 0) return fmt::format("line {}", edit.line);
  return edit.id.empty() ? "new edit" : fmt::format("edit '{}'", edit.id);
}

Result<std::vector<std::size_t>> EditList::in_force() const {
  auto stacks = replay(edits);
  if (!stacks) return std::unexpected(stacks.error());
  return std::move(stacks->in_force);
}

Result<std::vector<Edit>> EditList::edits_in_force() const {
  const auto indices = in_force();
  if (!indices) return std::unexpected(indices.error());
  std::vector<Edit> out;
  for (const auto i : *indices) out.push_back(edits[i]);
  return out;
}

EditList::Depth EditList::depth() const {
  const auto stacks = replay(edits);
  if (!stacks) return {};
  return {.undo = stacks->in_force.size(), .redo = stacks->undone.size()};
}

}  // namespace kinemark::data

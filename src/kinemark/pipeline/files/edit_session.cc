// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/edit_session.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/input/journal_input.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kMostStates = 32;

/// Size of the arrays that edits copy.
std::size_t bytes_of(const data::Trial& trial) {
  const auto& m = trial.markers;
  const auto of = [](const auto& array) { return array.size() * sizeof(array[0]); };
  return of(m.x_in_world) + of(m.state) + of(m.covariance) + of(m.method) + of(m.sample_offset_s) +
         of(m.unfiltered_in_world) + of(trial.residual_m) + of(trial.camera_mask) +
         of(trial.channels.values) + of(trial.analog.values);
}

bool begins_with(std::span<const data::Edit> all, std::span<const data::Edit> begin) {
  return begin.size() <= all.size() &&
         std::ranges::equal(begin, all.first(begin.size()),
                            [](const auto& a, const auto& b) { return a.same_as(b); });
}

}  // namespace

Result<EditSession> EditSession::open(const std::filesystem::path& recording,
                                      const EditSessionOptions& options) {
  EditSession session;
  session.options_ = options;
  session.journal_ = io::edits_of(recording);
  auto identity = io::identify_recording(recording);
  if (!identity) return std::unexpected(identity.error());
  session.identity_ = std::move(*identity);
  auto input = io::read_marker_input({.path = recording, .rate = io::RateRule::or_unknown, .record = true});
  if (!input) return std::unexpected(input.error());
  if (!input->rate_known)
    return fail(Code::bad_input,
                fmt::format("{}: tells no frame rate; 'kinemark edit --rate' edits it", recording.string()));
  session.recorded_ = std::move(*input);
  if (auto s = session.refresh(); !s) return std::unexpected(s.error());
  session.last_changes_.clear();
  return session;
}

Result<EditSession::StateIs> EditSession::state_of(std::vector<data::Edit> in_force) const {
  const State* nearest = nullptr;
  for (const auto& kept : kept_) {
    if (!begins_with(in_force, kept->in_force)) continue;
    if (kept->in_force.size() == in_force.size()) return kept;
    if (nearest == nullptr || nearest->in_force.size() < kept->in_force.size()) nearest = kept.get();
  }
  auto begin = nearest != nullptr ? nearest->edited : trajectory::EditedTrial{.trial = recorded_.trial};
  const auto rest = std::span(in_force).subspan(nearest != nullptr ? nearest->in_force.size() : 0);
  auto edited =
      trajectory::apply_edits(std::move(begin), rest, {.seed = options_.seed, .threads = options_.threads});
  if (!edited) return std::unexpected(edited.error());
  std::vector<trajectory::MarkerChange> changes;
  if (!in_force.empty()) changes = trajectory::changes_between(recorded_.trial, edited->trial);
  return std::make_shared<const State>(std::move(in_force), std::move(*edited), std::move(changes));
}

void EditSession::take(data::EditList list, StateIs state) {
  list_ = std::move(list);
  if (now_ == state) return;
  last_changes_ =
      trajectory::changes_between(now_ ? now_->edited.trial : recorded_.trial, state->edited.trial);
  now_ = std::move(state);
  std::erase(kept_, now_);
  kept_.push_front(now_);
  while (kept_.size() > 1 && (kept_.size() > kMostStates || bytes() > options_.most_kept_bytes))
    kept_.pop_back();
}

Status EditSession::refresh() {
  auto read = io::read_edits_of(journal_, identity_);
  if (!read) return std::unexpected(read.error());
  auto in_force = read->list.edits_in_force();
  if (!in_force) return fail_at(journal_.string(), in_force.error());
  auto state = state_of(std::move(*in_force));
  if (!state) return fail_at(journal_.string(), state.error());
  notes_ = std::move(read->notes);
  take(std::move(read->list), std::move(*state));
  return {};
}

Result<bool> EditSession::append(data::Edit edit, std::size_t expected) {
  if (auto s = refresh(); !s) return std::unexpected(s.error());
  if (list_.edits.size() != expected) return false;
  if (auto s = edit.check(); !s) return std::unexpected(s.error());
  auto tried = list_;
  tried.edits.push_back(edit);
  auto in_force = tried.edits_in_force();
  if (!in_force) return std::unexpected(in_force.error());
  auto state = state_of(std::move(*in_force));
  if (!state) return std::unexpected(state.error());
  auto list = io::append_edit(journal_, identity_, expected, std::move(edit));
  if (!list) return std::unexpected(list.error());
  take(std::move(*list), std::move(*state));
  return true;
}

EditOutcome EditSession::outcome() const {
  EditOutcome out;
  out.list = list_;
  out.in_force = now_->in_force;
  out.regions = now_->edited.regions;
  out.digest = io::digest_of(now_->in_force);
  out.journal = journal_;
  out.warnings = notes_;
  out.warnings.insert(out.warnings.end(), now_->edited.notes.begin(), now_->edited.notes.end());
  return out;
}

std::size_t EditSession::bytes() const {
  std::size_t sum = bytes_of(recorded_.trial);
  for (const auto& kept : kept_) sum += bytes_of(kept->edited.trial);
  return sum;
}

}  // namespace kinemark::pipeline

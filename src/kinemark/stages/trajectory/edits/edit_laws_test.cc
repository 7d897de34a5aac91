// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Laws of editing: what is undone was never there, replay does not depend on how it is split.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "kinemark/stages/trajectory/edits/apply_edits.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"

namespace kinemark::trajectory {
namespace {

using data::Edit;
using data::EditKind;
using testing::bytes_of;
using testing::moving_trial;
using testing::random_edit;

/// So many edits that apply, one after the other, from chance.
std::vector<Edit> edits_by_chance(std::uint64_t seed, std::size_t count) {
  Random random(seed, 0);
  std::vector<Edit> edits;
  EditedTrial state{.trial = moving_trial()};
  while (edits.size() < count) {
    const std::vector<Edit> one{random_edit(random)};
    if (auto next = apply_edits(state, one)) {
      edits.push_back(one.front());
      state = std::move(*next);
    }
  }
  return edits;
}

std::string bytes_after(const data::EditList& list, const EditOptions& options = {}) {
  const auto out = apply_edits(moving_trial(), list, options);
  EXPECT_TRUE(out) << out.error().message;
  return out ? bytes_of(*out) : "";
}

TEST(EditLaws, UndoAfterAnyOperationGivesTheBytesBefore) {
  const auto edits = edits_by_chance(1, 60);
  data::EditList list;
  std::map<EditKind, int> kinds;
  auto before = bytes_after(list);
  for (const auto& edit : edits) {
    ++kinds[edit.kind];
    auto undone = list;
    undone.edits.push_back(edit);
    const auto after = bytes_after(undone);
    undone.edits.push_back({.kind = EditKind::undo});
    ASSERT_EQ(bytes_after(undone), before) << describe(edit);
    undone.edits.push_back({.kind = EditKind::redo});
    ASSERT_EQ(bytes_after(undone), after) << describe(edit);
    list.edits.push_back(edit);
    before = after;
  }
  EXPECT_EQ(kinds.size(), 10U) << "every operation was tried";
}

TEST(EditLaws, AHundredEditsUndoneAndRedone) {
  data::EditList list{.edits = edits_by_chance(2, 100)};
  const auto after = bytes_after(list);
  list.edits.push_back({.kind = EditKind::undo, .count = 100});
  EXPECT_EQ(bytes_after(list), bytes_of(moving_trial()));
  for (int i = 0; i < 100; ++i) list.edits.push_back({.kind = EditKind::redo});
  EXPECT_EQ(bytes_after(list), after);
}

TEST(EditLaws, ReplayIsTheSameFromAnySplit) {
  const auto edits = edits_by_chance(3, 40);
  const auto whole = bytes_after({.edits = edits});
  for (std::size_t split = 0; split <= edits.size(); split += 5) {
    const auto first = apply_edits(EditedTrial{.trial = moving_trial()}, std::span(edits).first(split));
    ASSERT_TRUE(first) << first.error().message;
    const auto both = apply_edits(*first, std::span(edits).subspan(split));
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(bytes_of(*both), whole) << split;
  }
}

TEST(EditLaws, TheBitsDoNotDependOnThreads) {
  const std::vector<Edit> edits{
      {.kind = EditKind::cut, .marker = "SACR", .first_frame = 590, .last_frame = 620},
      {.kind = EditKind::fill, .marker = "SACR"},
      {.kind = EditKind::fill, .marker = "LKNE"}};
  EXPECT_EQ(bytes_after({.edits = edits}, {.threads = 1}), bytes_after({.edits = edits}, {.threads = 4}));
}

TEST(EditLaws, SwapTwiceIsNothing) {
  const Edit swap{.kind = EditKind::swap, .marker = "LKNE", .other = "*12", .first_frame = 530};
  EXPECT_NE(bytes_after({.edits = {swap}}), bytes_of(moving_trial()));
  EXPECT_EQ(bytes_after({.edits = {swap, swap}}), bytes_of(moving_trial()));
  auto back = swap;
  std::swap(back.marker, back.other);
  EXPECT_EQ(bytes_after({.edits = {swap, back}}), bytes_of(moving_trial()));
}

TEST(EditLaws, UnfillTakesAFillBack) {
  const Edit cut{.kind = EditKind::cut, .marker = "RKNE", .first_frame = 550, .last_frame = 560};
  Edit fill = cut, unfill = cut;
  fill.kind = EditKind::fill, fill.method = "cubic", unfill.kind = EditKind::unfill;
  const auto before = apply_edits(moving_trial(), {.edits = {cut}}).value();
  const auto after = apply_edits(moving_trial(), {.edits = {cut, fill, unfill}}).value();
  const auto& a = before.trial.markers;
  const auto& b = after.trial.markers;
  for (std::int64_t f = 0; f < a.frames(); ++f)
    for (std::int64_t m = 0; m < a.markers(); ++m) {
      ASSERT_EQ(a.present(f, m), b.present(f, m));
      if (a.present(f, m)) {
        ASSERT_EQ(Eigen::Vector3d(a.x(f, m)), Eigen::Vector3d(b.x(f, m)));
      }
    }
}

}  // namespace
}  // namespace kinemark::trajectory

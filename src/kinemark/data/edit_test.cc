// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kinemark::data {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string why_not(const Edit& edit) {
  const auto s = edit.check();
  EXPECT_FALSE(s) << describe(edit);
  if (s) return "";
  EXPECT_EQ(s.error().code, Code::bad_input);
  return s.error().message;
}

Edit cut_of(const std::string& marker) { return {.kind = EditKind::cut, .marker = marker}; }
Edit undo(int count = 1) { return {.kind = EditKind::undo, .count = count}; }
Edit redo(int count = 1) { return {.kind = EditKind::redo, .count = count}; }

TEST(Edit, KindsAreCalledWhatTheyAreParsedFrom) {
  for (int k = 0; k <= static_cast<int>(EditKind::redo); ++k) {
    const auto kind = static_cast<EditKind>(k);
    EXPECT_EQ(parse_edit_kind(to_string(kind)).value(), kind);
  }
  const auto none = parse_edit_kind("erase");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("operation 'erase'"));
}

TEST(Edit, EveryKindIsDescribedWithWhatItNeeds) {
  EXPECT_EQ(describe({.kind = EditKind::swap, .marker = "A", .other = "B", .first_frame = 120}),
            "swap of 'A' and 'B', from frame 120 on");
  EXPECT_EQ(describe({.kind = EditKind::relabel, .marker = "*1", .other = "LASI", .last_frame = 9}),
            "relabel of '*1' to 'LASI', up to frame 9");
  EXPECT_EQ(
      describe({.kind = EditKind::fill, .marker = "A", .first_frame = 3, .last_frame = 5, .method = "pchip"}),
      "fill of 'A', frames 3 to 5 by pchip");
  EXPECT_EQ(describe({.kind = EditKind::cut, .marker = "A", .first_frame = 3, .last_frame = 3}),
            "cut of 'A', frame 3");
  EXPECT_EQ(
      describe(
          {.kind = EditKind::move_event, .label = "Foot Off", .context = "Left", .time_s = 1.25, .to_s = 2}),
      "move event 'Foot Off' (Left) at 1.25 s to 2 s");
  EXPECT_EQ(describe({.kind = EditKind::region, .first_frame = 1, .last_frame = 2, .name = "gait"}),
            "region 'gait', frames 1 to 2");
  EXPECT_EQ(describe(undo(2)), "undo of 2 operations");
}

TEST(Edit, WhatIsMissingOrNoneIsSaid) {
  EXPECT_THAT(why_not(cut_of("")), HasSubstr("cut needs a marker"));
  EXPECT_THAT(why_not({.kind = EditKind::swap, .marker = "A"}), HasSubstr("swap needs a second marker"));
  EXPECT_THAT(why_not({.kind = EditKind::swap, .marker = "A", .other = "A"}), HasSubstr("changes nothing"));
  EXPECT_THAT(why_not({.kind = EditKind::relabel, .marker = "A"}), HasSubstr("needs a new name"));
  EXPECT_THAT(why_not({.kind = EditKind::crop}), HasSubstr("a first or a last frame"));
  EXPECT_THAT(why_not({.kind = EditKind::region, .first_frame = 1, .name = "x"}),
              HasSubstr("a first and a last frame"));
  EXPECT_THAT(why_not({.kind = EditKind::region, .first_frame = 1, .last_frame = 2}),
              HasSubstr("needs a name"));
  EXPECT_THAT(why_not({.kind = EditKind::mark_event}), HasSubstr("mark needs a label"));
  EXPECT_THAT(why_not({.kind = EditKind::mark_event, .label = "x", .time_s = NAN}),
              HasSubstr("no time of a recording"));
  EXPECT_THAT(why_not({.kind = EditKind::move_event, .label = "x", .to_s = INFINITY}),
              HasSubstr("no time of a recording"));
  EXPECT_THAT(why_not(undo(0)), HasSubstr("undo of 0 operations"));
  auto backwards = cut_of("A");
  backwards.first_frame = 5, backwards.last_frame = 4;
  EXPECT_THAT(why_not(backwards), HasSubstr("the first lies behind the last"));
  backwards.first_frame = std::numeric_limits<std::int64_t>::min();
  EXPECT_THAT(why_not(backwards), HasSubstr("none of a recording"));
}

TEST(Edit, NamesAreTextThatAFileHolds) {
  for (const char* name : {"a\nb", " a", "a ", "a\x01", "\xff\xfe"})
    EXPECT_THAT(why_not(cut_of(name)), HasSubstr("without control characters")) << name;
  EXPECT_THAT(why_not(cut_of(std::string(401, 'x'))), HasSubstr("401 bytes"));
  EXPECT_TRUE(cut_of(std::string(400, 'x')).check());
  EXPECT_TRUE(cut_of("Größe *1").check());
  auto edit = cut_of("A");
  edit.author = "two\nlines";
  EXPECT_THAT(why_not(edit), HasSubstr("the author"));
}

TEST(Edit, DoesTheSameWhoeverMadeIt) {
  auto a = cut_of("A"), b = a;
  b.id = "7", b.made = "2026-11-24T09:30:00Z", b.author = "me", b.line = 9;
  EXPECT_TRUE(a.same_as(b));
  b.first_frame = 1;
  EXPECT_FALSE(a.same_as(b));
}

TEST(EditList, UndoAndRedoMoveTheLastOnes) {
  EditList list;
  list.edits = {cut_of("A"), cut_of("B"), cut_of("C"), undo(2)};
  EXPECT_THAT(list.in_force().value(), ElementsAre(0));
  EXPECT_EQ(list.depth().undo, 1U);
  EXPECT_EQ(list.depth().redo, 2U);
  list.edits.push_back(redo());
  EXPECT_THAT(list.in_force().value(), ElementsAre(0, 1)) << "the one undone last comes back first";
  list.edits.push_back(redo());
  EXPECT_THAT(list.in_force().value(), ElementsAre(0, 1, 2));
  list.edits.push_back(undo(3));
  EXPECT_THAT(list.edits_in_force().value(), IsEmpty());
}

TEST(EditList, ANewOperationEndsWhatCouldBeRedone) {
  EditList list;
  list.edits = {cut_of("A"), undo(), cut_of("B")};
  EXPECT_THAT(list.in_force().value(), ElementsAre(2));
  EXPECT_EQ(list.depth().redo, 0U);
  list.edits.push_back(redo());
  list.edits.back().line = 5;
  const auto wrong = list.in_force();
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, "line 5: redo of 1 operation, where there is nothing left");
  EXPECT_EQ(list.depth().undo, 0U) << "of a list that is wrong";
}

TEST(EditList, UndoOfMoreThanThereIsFails) {
  EditList list;
  list.edits = {cut_of("A"), undo(2)};
  list.edits.back().id = "x";
  const auto wrong = list.edits_in_force();
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, "edit 'x': undo of 2 operations, where there is 1");
}

TEST(EditedRecording, IsItsBytesWhateverItsName) {
  const EditedRecording a{.name = "a.c3d", .bytes = 5, .hash = "12"};
  auto b = a;
  b.name = "b.c3d";
  EXPECT_TRUE(a.same_bytes(b));
  b.bytes = 6;
  EXPECT_FALSE(a.same_bytes(b));
}

}  // namespace
}  // namespace kinemark::data

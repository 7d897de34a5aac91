// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/edits/edit_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace kinemark::io {
namespace {

using data::Edit;
using data::EditKind;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<Edit> one_of_each() {
  return {
      {.kind = EditKind::relabel, .marker = "*12", .other = "LASI", .id = "1"},
      {.kind = EditKind::swap,
       .marker = "A",
       .other = "B",
       .first_frame = -3,
       .id = "2",
       .author = "Größe \"q\""},
      {.kind = EditKind::cut, .marker = "A\\B", .first_frame = 1, .last_frame = 2},
      {.kind = EditKind::fill, .marker = "A", .method = "pchip", .made = "2026-11-24T09:30:00Z"},
      {.kind = EditKind::unfill, .marker = "A", .last_frame = 7},
      {.kind = EditKind::crop, .first_frame = 10},
      {.kind = EditKind::mark_event, .label = "Foot Off", .context = "Left", .time_s = 0.1 + 0.2},
      {.kind = EditKind::move_event, .label = "Foot Off", .time_s = 1e-7, .to_s = -1.0 / 3.0},
      {.kind = EditKind::delete_event, .label = "</script>", .time_s = 0.0},
      {.kind = EditKind::region, .first_frame = 5, .last_frame = 5, .name = "gait"},
      {.kind = EditKind::undo, .count = 3},
      {.kind = EditKind::redo},
  };
}

std::string refused(std::string_view line) {
  const auto edit = parse_edit(line);
  EXPECT_FALSE(edit) << line;
  if (edit) return "";
  EXPECT_EQ(edit.error().code, Code::bad_input);
  EXPECT_THAT(edit.error().message, Not(HasSubstr("\n")));
  return edit.error().message;
}

TEST(EditLine, WhatIsWrittenIsRead) {
  for (const Edit& edit : one_of_each()) {
    const auto line = format_edit(edit);
    EXPECT_THAT(line, Not(HasSubstr("\n")));
    for (const auto& text : {line, with_sum(line)}) {
      const auto back = parse_edit(text);
      ASSERT_TRUE(back) << text << ": " << back.error().message;
      EXPECT_TRUE(back->same_as(edit)) << text;
      EXPECT_EQ(back->id, edit.id);
      EXPECT_EQ(back->made, edit.made);
      EXPECT_EQ(back->author, edit.author);
    }
  }
}

TEST(EditLine, ReadsAsItIsDocumented) {
  EXPECT_EQ(format_edit({.kind = EditKind::swap, .marker = "A", .other = "B", .first_frame = 120, .id = "3"}),
            R"({"id":"3","do":"swap","marker":"A","with":"B","first":120})");
  const auto typed = parse_edit(R"( { "do" : "fill", "marker" : "LASI", "last" : 20 } )");
  ASSERT_TRUE(typed) << typed.error().message;
  EXPECT_TRUE(typed->same_as({.kind = EditKind::fill, .marker = "LASI", .last_frame = 20}));
}

TEST(EditLine, AChangedLineIsFoundByItsSum) {
  const auto line = with_sum(R"({"do":"cut","marker":"A"})");
  ASSERT_TRUE(parse_edit(line));
  for (std::size_t i = 0; i < line.size(); ++i)
    for (const char other : {'B', '0', ' ', '"', '\x7f'}) {
      if (line[i] == other) continue;
      auto changed = line;
      changed[i] = other;
      EXPECT_FALSE(parse_edit(changed)) << changed;
    }
  auto letter = line;
  letter[letter.find("\"A\"") + 1] = 'C';
  EXPECT_THAT(refused(letter), HasSubstr("the line was changed"));
}

TEST(EditLine, SaysWhatIsWrong) {
  EXPECT_THAT(refused(""), HasSubstr("no JSON object"));
  EXPECT_THAT(refused("[1]"), HasSubstr("no JSON object"));
  EXPECT_THAT(refused("{"), HasSubstr("no JSON object"));
  EXPECT_THAT(refused(std::string(50'000, '[')), HasSubstr("no JSON object"));
  EXPECT_THAT(refused("{}"), HasSubstr("needs \"do\""));
  EXPECT_THAT(refused(R"({"do":7})"), HasSubstr("operation ''"));
  EXPECT_THAT(refused(R"({"do":"erase"})"), HasSubstr("operation 'erase'"));
  EXPECT_THAT(refused(R"({"do":"cut"})"), HasSubstr("cut needs a marker"));
  EXPECT_THAT(refused(R"({"do":"cut","marker":5})"), HasSubstr("\"marker\" is 5; need text"));
  const std::string deep = std::string(30'000, '[') + std::string(30'000, ']');
  EXPECT_THAT(refused(R"({"do":"cut","marker":)" + deep + "}"), HasSubstr("\"marker\" is array; need text"));
  EXPECT_THAT(
      refused(R"({"do":"cut","marker":"A","frst":1})"),
      HasSubstr("\"frst\" is none of its values, which are do, id, made, author, marker, first, last"));
  EXPECT_THAT(refused(R"({"do":"cut","marker":"A","first":1.5})"), HasSubstr("need a whole number"));
  EXPECT_THAT(refused(R"({"do":"cut","marker":"A","first":18446744073709551615})"),
              HasSubstr("need a whole number"));
  EXPECT_THAT(refused(R"({"do":"cut","marker":"A","first":9000000000})"), HasSubstr("none of a recording"));
  EXPECT_THAT(refused(R"({"do":"mark","label":"x"})"), HasSubstr("needs \"time_s\""));
  EXPECT_THAT(refused(R"({"do":"mark","label":"x","time_s":1e999})"), HasSubstr("no JSON object"));
  EXPECT_THAT(refused(R"({"do":"undo","count":0})"), HasSubstr("need 1 to 1000000"));
  EXPECT_THAT(refused(R"({"do":"undo","count":4294967297})"), HasSubstr("need 1 to 1000000"));
  EXPECT_THAT(refused(R"({"sum":"12","do":"cut","marker":"A"})"), HasSubstr("is not the last value"));
}

TEST(EditLine, NamesTheRecording) {
  const data::EditedRecording recording{.name = "walk \xff.c3d", .bytes = 12, .hash = "0123456789abcdef"};
  const auto back = parse_recording(with_sum(format_recording(recording)));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->same_bytes(recording));
  EXPECT_EQ(back->name, "walk ÿ.c3d");
  const auto why = [](std::string_view line) { return parse_recording(line).error().message; };
  EXPECT_THAT(why(R"({"do":"cut","marker":"A"})"), HasSubstr("as the first line"));
  EXPECT_THAT(why(R"({"kinemark_edits":2,"recording":{}})"), HasSubstr("edits of version 2"));
  EXPECT_THAT(why(R"({"kinemark_edits":1})"), HasSubstr("needs the \"recording\""));
  EXPECT_THAT(
      why(R"({"kinemark_edits":1,"recording":{"name":"a","bytes":1,"hash":"x","hash_kind":"XXH3-64"}})"),
      HasSubstr("hash of 16 digits"));
  EXPECT_THAT(why(R"({"kinemark_edits":1,"recording":{"bytes":-1}})"), HasSubstr("needs its bytes"));
}

TEST(EditLine, TheDigestTellsWhatIsDoneAndNotByWhom) {
  auto edits = one_of_each();
  const auto before = digest_of(edits);
  EXPECT_EQ(before.size(), 16U);
  for (auto& edit : edits) edit.id += "x", edit.made = "now", edit.author = "me";
  EXPECT_EQ(digest_of(edits), before);
  std::swap(edits[0], edits[1]);
  EXPECT_NE(digest_of(edits), before) << "order counts";
}

}  // namespace
}  // namespace kinemark::io

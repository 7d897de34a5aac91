// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/edited_page.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/motion/markers_page.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::EditKind;
using ::testing::HasSubstr;
using ::testing::Not;

class EditedPage : public ::testing::Test {
 protected:
  void SetUp() override {
    auto trial = trajectory::testing::moving_trial();
    trial.markers.names[4] = kHostile;
    ASSERT_TRUE(io::write_markers(recording_, trial, false));
  }
  static nlohmann::json data_of(const std::string& html) {
    const std::string begin = "id=\"kinemark-data\">";
    const auto first = html.find(begin) + begin.size();
    return nlohmann::json::parse(html.substr(first, html.find("</script>", first) - first));
  }

  static constexpr const char* kHostile = "</script><img onerror=x>";
  testing_support::ScratchFolder scratch_;
  std::filesystem::path recording_ = scratch_ / "walk.c3d";
};

TEST_F(EditedPage, WithoutEditsIsThePageOfTheRecordingThatCanBeEdited) {
  auto data = data_of(edited_page(recording_).value());
  EXPECT_EQ(data["editing"]["edits"].size(), 0U);
  EXPECT_EQ(data["editing"]["journal"], "walk_edits.jsonl");
  EXPECT_TRUE(data["scene"]["before"].is_null());
  data.erase("editing");
  EXPECT_EQ(data, data_of(markers_page(recording_).value()));
}

TEST_F(EditedPage, ShowsWhatEditsMakeOfItBesideWhatWasRecorded) {
  const auto plain = data_of(markers_page(recording_).value());
  auto session = EditSession::open(recording_).value();
  ASSERT_TRUE(session.append({.kind = EditKind::swap, .marker = "S:LASI", .other = "S:RASI"}, 0).value());
  ASSERT_TRUE(
      session.append({.kind = EditKind::cut, .marker = kHostile, .first_frame = 511, .last_frame = 530}, 1)
          .value());
  const auto data = data_of(edited_page(recording_).value());
  EXPECT_EQ(data["summary"]["markers"][4]["states"]["rejected"], 20);
  EXPECT_EQ(data["scene"]["before"], plain["scene"]["markers"]);
  EXPECT_NE(data["scene"]["markers"], plain["scene"]["markers"]);
  EXPECT_EQ(data["editing"]["undo"], 2);
  EXPECT_EQ(data["editing"]["changes"]["all"].size(), 3U);
  const auto now = nlohmann::json(edited_page_json(session));
  EXPECT_EQ(now["summary"], data["summary"]);
  EXPECT_EQ(now["scene"], data["scene"]);
  const auto& last = now["editing"]["changes"]["last"];
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(last[0]["marker"], kHostile);
  EXPECT_EQ(last[0]["went"], 20);
  EXPECT_EQ(last[0]["first"], 511);
  EXPECT_THAT(edited_page(recording_).value(), Not(HasSubstr("<img onerror")));
}

TEST_F(EditedPage, ACropShowsTheFramesThatAreLeft) {
  auto session = EditSession::open(recording_).value();
  ASSERT_TRUE(session.append({.kind = EditKind::crop, .first_frame = 520, .last_frame = 640}, 0).value());
  const auto json = edited_page_json(session);
  EXPECT_EQ(json["summary"]["frames"], 121);
  EXPECT_EQ(json["summary"]["first_frame"], 520);
  EXPECT_EQ(json["scene"]["before"], json["scene"]["markers"]) << "no sample of them changed";
}

TEST_F(EditedPage, WhatCannotBeEditedIsShownAsItIsWithTheReason) {
  ASSERT_TRUE(io::write_text(scratch_ / "walk_edits.jsonl", "nonsense\n", false));
  const auto data = data_of(edited_page(recording_).value());
  EXPECT_EQ(data["summary"]["frames"], 200);
  EXPECT_THAT(data["editing"]["refused"].get<std::string>(), HasSubstr("walk_edits.jsonl: line 1"));
  EXPECT_FALSE(edited_page(scratch_ / "absent.c3d"));
}

}  // namespace
}  // namespace kinemark::pipeline

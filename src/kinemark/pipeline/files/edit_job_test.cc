// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/edit_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::Edit;
using data::EditKind;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class EditJobTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_markers(job_.input, trajectory::testing::moving_trial(), false));
  }
  /// The job with an edit.
  [[nodiscard]] EditJob job(const Edit& edit, const std::string& from = "", const std::string& to = "",
                            const std::string& at = "") const {
    auto out = job_;
    out.edit = edit;
    out.from = from, out.to = to, out.at = at;
    return out;
  }
  static EditOutcome good(const EditJob& job) {
    auto out = run_edit(job);
    EXPECT_TRUE(out) << out.error().message;
    return std::move(*out);
  }
  /// The failure, which leaves the journal as it was.
  Error refused(const EditJob& job) const {
    const auto before = io::read_text(journal_);
    const auto out = run_edit(job);
    EXPECT_FALSE(out);
    const auto after = io::read_text(journal_);
    EXPECT_EQ(before.has_value(), after.has_value()) << "a refusal makes no journal";
    if (before && after) {
      EXPECT_EQ(*before, *after);
    }
    return out ? Error{} : out.error();
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path journal_ = scratch_ / "walk_edits.jsonl";
  EditJob job_ = [this] {
    EditJob job;
    job.input = scratch_ / "walk.c3d";
    return job;
  }();
};

TEST_F(EditJobTest, AppendsOneOperation) {
  const auto bytes = io::read_text(job_.input).value();
  const auto out =
      good(job({.kind = EditKind::swap, .marker = "LKNE", .other = "RKNE", .author = "me"}, "570"));
  EXPECT_EQ(out.journal, journal_);
  EXPECT_THAT(out.written, ElementsAre(journal_));
  ASSERT_EQ(out.in_force.size(), 1U);
  EXPECT_EQ(out.in_force[0].first_frame, 570);
  EXPECT_EQ(out.in_force[0].id, "1");
  const auto read = io::read_edits(journal_).value();
  EXPECT_TRUE(read.list.edits[0].same_as(out.in_force[0]));
  EXPECT_EQ(read.list.recording.name, "walk.c3d");
  EXPECT_EQ(io::read_text(job_.input).value(), bytes) << "the recording is only read";
}

TEST_F(EditJobTest, TimesBecomeTheFramesWithin) {
  // 100 Hz from 5 s on, where frame 501 is.
  const auto range = [&](const std::string& from, const std::string& to) {
    const auto out = good(job({.kind = EditKind::region, .name = "r" + from + to}, from, to));
    return std::pair(*out.in_force.back().first_frame, *out.in_force.back().last_frame);
  };
  EXPECT_EQ(range("5.1s", "5.2s"), std::pair(std::int64_t{511}, std::int64_t{521}));
  EXPECT_EQ(range("5.101s", "5.209s"), std::pair(std::int64_t{512}, std::int64_t{521}));
  EXPECT_EQ(range("520", "5.3s"), std::pair(std::int64_t{520}, std::int64_t{531}));
}

TEST_F(EditJobTest, EventsHaveTimes) {
  const auto marked = good(job({.kind = EditKind::mark_event, .label = "Turn"}, "", "", "601"));
  EXPECT_DOUBLE_EQ(marked.in_force[0].time_s, 6.0);
  const auto moved = good(job({.kind = EditKind::move_event, .label = "Turn"}, "", "6.25s", "6s"));
  EXPECT_EQ(moved.in_force[1].to_s, 6.25);
  EXPECT_EQ(refused(job({.kind = EditKind::move_event, .label = "Turn"}, "", "", "6.25s")).code, Code::usage);
  EXPECT_THAT(refused(job({.kind = EditKind::delete_event, .label = "Turn"})).message,
              HasSubstr("needs its time"));
  EXPECT_EQ(refused(job({.kind = EditKind::delete_event, .label = "Turn"}, "", "", "6s")).code,
            Code::bad_input);
}

TEST_F(EditJobTest, WhatCannotBeDoneIsRefusedAndNothingWritten) {
  EXPECT_EQ(refused(job({.kind = EditKind::cut, .marker = "LKNN"})).message,
            journal_.string() + ": new edit: cut: no marker is named 'LKNN'; nearest: LKNE");
  EXPECT_EQ(refused(job({.kind = EditKind::undo})).code, Code::bad_input);
  for (const char* wrong : {"x", "1.5", "1e99", "s", "nans", "1,5s", "--2"})
    EXPECT_THAT(refused(job({.kind = EditKind::cut, .marker = "LKNE"}, wrong)).message,
                HasSubstr("is no moment"))
        << wrong;
  EXPECT_EQ(refused(job({.kind = EditKind::crop})).code, Code::usage);
  good(job({.kind = EditKind::cut, .marker = "LKNE"}));
  EXPECT_THAT(refused(job({.kind = EditKind::cut, .marker = "LKNE"})).message, HasSubstr("has no sample"));
  EXPECT_THAT(refused(job({.kind = EditKind::cut, .marker = "RKNE"}, "5000")).message,
              HasSubstr("frame 5000 is not there"));
}

TEST_F(EditJobTest, ExchangesThatAreSureAreAppendedOnceAndCanBeUndone) {
  auto spoilt = trajectory::testing::moving_trial();
  const auto clean = spoilt.markers.x_in_world;
  for (std::int64_t f = 100; f < 120; ++f) {
    const Eigen::Vector3d x = spoilt.markers.x(f, 0);
    spoilt.markers.x(f, 0) = spoilt.markers.x(f, 2);
    spoilt.markers.x(f, 2) = x;
  }
  ASSERT_TRUE(io::write_markers(job_.input, spoilt, true));
  auto search = job({.kind = EditKind::swap, .made = "2026-11-24T09:30:00Z", .author = "me"});
  search.exchanges = true;
  const auto found = good(search);
  EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("no two markers surely carry each other's label"))));
  EXPECT_THAT(found.written, ElementsAre(journal_));
  ASSERT_EQ(found.in_force.size(), 1U);
  const auto& edit = found.in_force.front();
  EXPECT_EQ(edit.kind, EditKind::swap);
  EXPECT_EQ(edit.marker, "S:LASI");
  EXPECT_EQ(edit.other, "S:SACR");
  EXPECT_EQ(edit.first_frame, 601);
  EXPECT_EQ(edit.last_frame, 620);
  EXPECT_EQ(edit.author, "me");
  EXPECT_EQ(edit.made, "2026-11-24T09:30:00Z");
  const auto again = good(search);
  EXPECT_THAT(again.warnings,
              Contains(HasSubstr("no two markers surely carry each other's label: nothing was "
                                 "appended")));
  EXPECT_EQ(found.appended, 1U);
  EXPECT_EQ(again.appended, 0U);
  EXPECT_EQ(again.list.edits.size(), 1U) << "with the first in force nothing is left to exchange";
  EXPECT_TRUE(good(job({.kind = EditKind::undo})).in_force.empty());
  EXPECT_EQ(good(search).in_force.size(), 1U) << "refused once, it can be asked for again";
}

TEST_F(EditJobTest, OfACleanRecordingNoExchangeIsAppended) {
  auto search = job_;
  search.exchanges = true;
  const auto out = good(search);
  EXPECT_THAT(out.warnings, Contains(HasSubstr("nothing was appended")));
  EXPECT_TRUE(out.written.empty());
  EXPECT_FALSE(std::filesystem::exists(journal_));
}

TEST_F(EditJobTest, ExchangesThatFlickerAreOneEditOfListedFrames) {
  auto spoilt = trajectory::testing::moving_trial();
  for (std::int64_t f = 62; f < 140; f += 3) {
    const Eigen::Vector3d x = spoilt.markers.x(f, 0);
    spoilt.markers.x(f, 0) = spoilt.markers.x(f, 2);
    spoilt.markers.x(f, 2) = x;
  }
  ASSERT_TRUE(io::write_markers(job_.input, spoilt, true));
  auto search = job_;
  search.exchanges = true;
  const auto out = good(search);
  ASSERT_EQ(out.in_force.size(), 1U);
  EXPECT_EQ(out.in_force[0].frames, "563-638/3");
  EXPECT_FALSE(out.in_force[0].first_frame);
}

TEST_F(EditJobTest, UndoAndRedoAreOperations) {
  const auto before = good(job({.kind = EditKind::cut, .marker = "LKNE"}));
  const auto undone = good(job({.kind = EditKind::undo}));
  EXPECT_EQ(undone.list.depth().redo, 1U);
  EXPECT_EQ(undone.digest, io::digest_of({}));
  EXPECT_EQ(good(job({.kind = EditKind::redo})).digest, before.digest);
  auto look = job_;
  const auto shown = good(look);
  EXPECT_EQ(shown.list.edits.size(), 3U);
  EXPECT_TRUE(shown.written.empty());
  const auto json = edit_json(shown);
  EXPECT_EQ(json["edits"].size(), 3U);
  EXPECT_EQ(json["edits"][0]["in_force"], true);
  EXPECT_EQ(json["edits"][0]["words"], "cut of 'LKNE'");
  EXPECT_FALSE(json["edits"][1].contains("in_force"));
  EXPECT_EQ(json["undo"], 1);
  EXPECT_EQ(json["digest"], before.digest);
}

TEST_F(EditJobTest, AJournalOfItsOwnNameAndAForeignOne) {
  auto own = job({.kind = EditKind::cut, .marker = "LKNE"});
  own.edits = scratch_ / "mine.jsonl";
  EXPECT_EQ(good(own).journal, own.edits);
  auto other = io::read_markers(job_.input).value();
  other.markers.x(0, 0).x() += 1.0;
  auto foreign = own;
  foreign.input = scratch_ / "run.c3d";
  ASSERT_TRUE(io::write_markers(foreign.input, other, false));
  foreign.edit->marker = "RKNE";
  EXPECT_THAT(run_edit(foreign).error().message, HasSubstr("these edits are of 'walk.c3d'"));
  foreign.force = true;
  EXPECT_EQ(good(foreign).in_force.size(), 2U);
}

TEST_F(EditJobTest, ATornLineIsSaidAndGone) {
  good(job({.kind = EditKind::cut, .marker = "LKNE"}));
  ASSERT_TRUE(io::write_text(journal_, io::read_text(journal_).value() + R"({"do":"cu)", true));
  EXPECT_THAT(good(job_).warnings, Contains(HasSubstr("line 3 was not written to its end")));
  EXPECT_EQ(good(job({.kind = EditKind::cut, .marker = "RKNE"})).list.edits.size(), 2U);
  EXPECT_THAT(good(job_).warnings, ::testing::IsEmpty());
}

}  // namespace
}  // namespace kinemark::pipeline

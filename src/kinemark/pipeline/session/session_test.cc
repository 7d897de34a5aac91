// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/session/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class SessionFolder : public ::testing::Test {
 protected:
  [[nodiscard]] Session open(const SessionAbout& about = {}) const {
    return Session::open(folder_, about).value();
  }
  [[nodiscard]] std::string refused(const SessionAbout& about = {}) const {
    const auto session = Session::open(folder_, about);
    return session ? "opened" : session.error().message;
  }
  [[nodiscard]] fs::path raw(const std::string& name) const { return folder_ / "raw" / name; }

  /// A closed recording of ten frames, of which two were lost.
  void record(const std::string& name, std::int16_t light = 100) const {
    data::Counts counts =
        data::Counts::zeros({"hand"}, {"A", "B"}, {.rate_hz = 60.0, .t0_s = 0.0, .frames = 8}, false);
    counts.counts[0] = light;
    const std::vector<io::RecordingMetadata> metadata = {
        {"acquisition", {{"source", "sim:rig"}, {"started", "2026-05-04T09:12:45Z"}, {"rate_hz", "60"}}},
        {"acquisition_end",
         {{"frames", "10"},
          {"dropped_by_device", "2"},
          {"dropped_here", "0"},
          {"clock_fast_ppm", "1.5"},
          {"clock_fast_sd_ppm", "0.25"}}}};
    ASSERT_TRUE(io::write_counts(raw(name), counts, metadata, false));
  }
  /// One that its program did not close.
  void leave_open(const std::string& name) const {
    const data::Counts like =
        data::Counts::zeros({"hand"}, {"A", "B"}, {.rate_hz = 60.0, .t0_s = 0.0, .frames = 0}, false);
    ASSERT_TRUE(io::CountsWriter::create(raw(name), like));
  }

  testing_support::ScratchFolder scratch_;
  fs::path folder_ = scratch_ / "day 1";
};

TEST_F(SessionFolder, IsMadeAndContinued) {
  EXPECT_FALSE(is_session(folder_));
  Session session = open({.subject = "S01", .rig = {}});
  EXPECT_TRUE(is_session(folder_));
  EXPECT_THAT(session.trials(), IsEmpty());
  record("01.mcap");
  ASSERT_TRUE(session.add(raw("01.mcap")));
  const Session again = open();
  EXPECT_EQ(again.subject(), "S01");
  EXPECT_THAT(again.notes(), IsEmpty());
  EXPECT_EQ(again.rig(), "");
  const SessionTrial expected{.file = "raw/01.mcap",
                              .source = "sim:rig",
                              .started = "2026-05-04T09:12:45Z",
                              .rate_hz = 60.0,
                              .frames = 10,
                              .dropped_by_device = 2,
                              .dropped_here = 0,
                              .clock_fast_ppm = 1.5,
                              .clock_fast_sd_ppm = 0.25};
  EXPECT_THAT(again.trials(), ElementsAre(expected));
  EXPECT_TRUE(again.check());
  EXPECT_EQ(fs::status(raw("01.mcap")).permissions() & fs::perms::owner_write, fs::perms::none);
}

TEST_F(SessionFolder, AnotherProgramMayAddAtTheSameTime) {
  Session one = open(), other = open();
  record("01.mcap");
  record("02.mcap");
  ASSERT_TRUE(one.add(raw("01.mcap")));
  ASSERT_TRUE(other.add(raw("02.mcap")));
  EXPECT_EQ(open().trials().size(), 2U);
}

TEST_F(SessionFolder, WhatAKilledProgramLeftIsTakenInOrNamed) {
  ASSERT_TRUE(Session::open(folder_, {}));
  record("b.mcap");
  leave_open("a.mcap");
  ASSERT_TRUE(io::write_text(raw("notes.txt"), "x", false));
  ASSERT_TRUE(io::write_text(raw(".c.mcap"), "x", false));
  const Session session = open();
  ASSERT_EQ(session.notes().size(), 2U);
  EXPECT_THAT(session.notes()[0], HasSubstr("a.mcap: was not closed"));
  EXPECT_THAT(session.notes()[0], HasSubstr("kinemark recover"));
  EXPECT_THAT(session.notes()[1], HasSubstr("b.mcap: was not in the session yet; it is taken in"));
  ASSERT_EQ(session.trials().size(), 1U);
  EXPECT_EQ(session.trials()[0].file, "raw/b.mcap");
  const Session again = open();
  ASSERT_EQ(again.notes().size(), 1U) << "the one that is not closed alone";
  EXPECT_THAT(again.notes(), Not(Contains(HasSubstr("was not in the session yet; it is taken in"))));
}

TEST_F(SessionFolder, AProgramThatIsKilledWhileItMakesOneLeavesNoHarm) {
  ASSERT_TRUE(Session::open(folder_, {}));
  fs::remove(folder_ / "MANIFEST");
  EXPECT_FALSE(Session::read(folder_)) << "nobody reads it without its checksums";
  ASSERT_TRUE(Session::open(folder_, {}));
  EXPECT_TRUE(Session::read(folder_));
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  ASSERT_TRUE(io::write_text(folder_ / ".kinemark-1-2", "half", false));
  EXPECT_TRUE(Session::open(folder_, {})) << "what is hidden does not count";
}

TEST_F(SessionFolder, ARecordingThatIsNotClosedIsNoTrialYet) {
  Session session = open();
  leave_open("a.mcap");
  const auto added = session.add(raw("a.mcap"));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, Code::bad_input);
  EXPECT_THAT(open().trials(), IsEmpty());
}

TEST_F(SessionFolder, AChangedOrMissingRecordingIsNamed) {
  Session session = open();
  record("a.mcap");
  ASSERT_TRUE(session.add(raw("a.mcap")));
  fs::remove(raw("a.mcap"));
  const auto gone = session.check();
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Code::io);
  EXPECT_THAT(gone.error().message, HasSubstr("a.mcap: is in MANIFEST and not there"));
  record("a.mcap", 101);
  const auto changed = session.check();
  ASSERT_FALSE(changed);
  EXPECT_EQ(changed.error().code, Code::bad_input);
  EXPECT_THAT(changed.error().message, HasSubstr("a.mcap: was changed since it was recorded"));
  record("elsewhere.mcap");
  fs::remove(raw("a.mcap"));
  fs::create_symlink(raw("elsewhere.mcap"), raw("a.mcap"));
  EXPECT_THAT(session.check().error().message, HasSubstr("not there, or no file"))
      << "a link leads elsewhere";
}

TEST_F(SessionFolder, AFolderOfSomethingElseIsLeftAsItIs) {
  fs::create_directories(folder_);
  ASSERT_TRUE(Session::open(folder_, {})) << "an empty one is taken";
  fs::remove(folder_ / "session.toml");
  EXPECT_THAT(refused(), HasSubstr("is no session; need one, an empty folder, or a new name"));
  const fs::path file = scratch_ / "file";
  ASSERT_TRUE(io::write_text(file, "x", false));
  EXPECT_THAT(Session::open(file, {}).error().message, HasSubstr("is no session"));
}

TEST_F(SessionFolder, IsOfOneSubject) {
  ASSERT_TRUE(Session::open(folder_, {}));
  Session session = open({.subject = "S01", .rig = {}});
  EXPECT_EQ(session.subject(), "S01");
  EXPECT_THAT(refused({.subject = "S02", .rig = {}}), HasSubstr("of subject 'S01', not 'S02'"));
  EXPECT_TRUE(session.set_subject("S01"));
  EXPECT_EQ(session.set_subject("S02").error().code, Code::usage);
  EXPECT_TRUE(session.set_subject("")) << "nothing is said";
  EXPECT_EQ(open().subject(), "S01");
}

TEST_F(SessionFolder, IsOfOneRig) {
  const auto rig = simulation::draw_rig().value();
  ASSERT_TRUE(io::write_rig(scratch_ / "one.toml", rig.nominal, false));
  ASSERT_TRUE(io::write_rig(scratch_ / "other.toml", rig.rig, false));
  EXPECT_EQ(open({.subject = "", .rig = scratch_ / "one.toml"}).rig(), folder_ / "rig.toml");
  EXPECT_EQ(io::read_text(folder_ / "rig.toml").value(), io::read_text(scratch_ / "one.toml").value());
  EXPECT_EQ(open({.subject = "", .rig = scratch_ / "one.toml"}).rig(), folder_ / "rig.toml") << "the same";
  EXPECT_THAT(refused({.subject = "", .rig = scratch_ / "other.toml"}), HasSubstr("has another rig"));
  EXPECT_THAT(refused({.subject = "", .rig = scratch_ / "none.toml"}), HasSubstr("none.toml"));
}

TEST_F(SessionFolder, TextsThatMakeNoSenseAreNamedAndKept) {
  ASSERT_TRUE(Session::open(folder_, {}));
  ASSERT_TRUE(io::write_text(folder_ / "MANIFEST", "rubbish\n", true));
  EXPECT_THAT(refused(), HasSubstr("MANIFEST: line 1"));
  EXPECT_EQ(io::read_text(folder_ / "MANIFEST").value(), "rubbish\n");
  ASSERT_TRUE(io::write_text(folder_ / "MANIFEST", "", true));
  ASSERT_TRUE(io::write_text(folder_ / "session.toml", "format = 7\n", true));
  EXPECT_THAT(refused(), HasSubstr("session.toml: format"));
}

}  // namespace
}  // namespace kinemark::pipeline

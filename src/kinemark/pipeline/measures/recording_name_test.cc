// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/recording_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST(NameOfRecording, IsReadOfBids) {
  const auto name =
      name_of_recording("data/sub-01/ses-pre/motion/sub-01_ses-pre_task-walk_tracksys-omc_run-2_motion.tsv");
  EXPECT_EQ(name.file, "sub-01_ses-pre_task-walk_tracksys-omc_run-2_motion.tsv");
  EXPECT_EQ(name.participant, "sub-01");
  EXPECT_EQ(name.session, "ses-pre");
  EXPECT_EQ(name.trial, "task-walk_tracksys-omc_run-2");
  EXPECT_EQ(name_of_recording("sub-7_task-reach.c3d").trial, "task-reach");
  EXPECT_EQ(name_of_recording("sub-7_task-reach.c3d").session, "");
}

TEST(NameOfRecording, FoldersTellWhatTheNameDoesNot) {
  const auto name = name_of_recording("/data/sub-02/ses-1/walk_03.c3d");
  EXPECT_EQ(name.participant, "sub-02");
  EXPECT_EQ(name.session, "ses-1");
  EXPECT_EQ(name.trial, "walk_03");
  const auto plain = name_of_recording("sub-/S1 walk.c3d");
  EXPECT_EQ(plain.participant, "");
  EXPECT_EQ(plain.trial, "S1 walk");
}

class ParticipantsTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const auto path = scratch_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path;
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(ParticipantsTest, AreJoinedByTheirId) {
  const auto table = read_participants(
      write("participants.tsv", "participant_id\tage\tgroup\tunit\nsub-01\t34\told\tA\n02\tn/a\tyoung\tB\n"));
  ASSERT_TRUE(table) << table.error().message;
  auto one = name_of_recording("sub-01_task-walk.c3d"), two = name_of_recording("sub-02_task-walk.c3d"),
       other = name_of_recording("walk.c3d");
  EXPECT_TRUE(take_participant(*table, one));
  EXPECT_TRUE(take_participant(*table, two));
  EXPECT_FALSE(take_participant(*table, other));
  EXPECT_THAT(one.more, ElementsAre(Pair("age", "34"), Pair("group", "old"), Pair("participant_unit", "A")));
  EXPECT_THAT(two.more, ElementsAre(Pair("age", ""), Pair("group", "young"), Pair("participant_unit", "B")));
  EXPECT_EQ(more_columns(one), ",age,group,participant_unit");
  EXPECT_EQ(more_cells(one), ",34,old,A");
  EXPECT_EQ(more_cells(other), ",,,");
  EXPECT_EQ(name_cells(other), "walk.c3d,,,walk");
}

TEST_F(ParticipantsTest, ATableOfFilesNamesThem) {
  const auto table = read_participants(write(
      "files.csv", "file,participant,session,trial,group\nw1.c3d,Ann,before,slow,a\nw2,Ben,after,n/a,b\n"));
  ASSERT_TRUE(table) << table.error().message;
  auto one = name_of_recording("x/w1.c3d"), two = name_of_recording("x/w2.c3d");
  EXPECT_TRUE(take_participant(*table, one));
  EXPECT_TRUE(take_participant(*table, two));
  EXPECT_EQ(name_cells(one), "w1.c3d,Ann,before,slow");
  EXPECT_EQ(name_cells(two), "w2.c3d,Ben,after,");
  EXPECT_THAT(two.more, ElementsAre(Pair("group", "b")));
}

TEST_F(ParticipantsTest, WhatCannotBeJoinedIsSaid) {
  const auto none = read_participants(write("a.tsv", "id\tage\n1\t3\n"));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_THAT(none.error().message, HasSubstr("no column is called participant_id"));
  const auto twice = read_participants(write("b.tsv", "participant_id\tage\nsub-1\t3\nsub-1\t4\n"));
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message, HasSubstr("line 3: sub-1 "));
  EXPECT_FALSE(read_participants(scratch_ / "none.tsv"));
}

TEST_F(ParticipantsTest, ADataSetOfBidsIsSearchedBelowItsParticipants) {
  write("set/participants.tsv", "participant_id\nsub-1\n");
  write("set/code/walk.c3d", "");
  write("set/sub-2/motion/sub-2_task-w_tracksys-a_motion.tsv", "");
  write("set/sub-2/motion/sub-2_task-w_tracksys-a_channels.tsv", "");
  write("set/sub-1/ses-1/walk.c3d", "");
  write("set/sub-1/ses-2/walk.c3d", "");
  write("set/sub-1/ses-2/notes.txt", "");
  const auto found = list_recordings({scratch_ / "set"});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->files,
              ElementsAre(scratch_ / "set/sub-1/ses-1/walk.c3d", scratch_ / "set/sub-1/ses-2/walk.c3d",
                          scratch_ / "set/sub-2/motion/sub-2_task-w_tracksys-a_motion.tsv"));
  std::filesystem::create_directories(scratch_ / "empty/sub-1");
  EXPECT_EQ(list_recordings({scratch_ / "empty"}).error().code, Code::bad_input);
}

TEST_F(ParticipantsTest, RecordingsThatNothingTellsApartAreRefused) {
  const auto a = write("a/walk.c3d", ""), b = write("b/walk.c3d", "");
  const auto same = list_recordings({a, b});
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().code, Code::usage);
  EXPECT_THAT(same.error().message, HasSubstr("tells them apart"));
  EXPECT_TRUE(list_recordings({a, write("b/walk2.c3d", "")}));
  EXPECT_TRUE(list_recordings({scratch_ / "a"}));
}

}  // namespace
}  // namespace kinemark::pipeline

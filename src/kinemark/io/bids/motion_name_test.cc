// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/bids/motion_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

TEST(MotionName, TellsWhereARecordingLies) {
  const auto name = parse_motion_name("study/sub-01/motion/sub-01_task-walk_tracksys-omc_motion.tsv");
  ASSERT_TRUE(name) << name.error().message;
  EXPECT_EQ(name->top, "study");
  EXPECT_EQ(name->task, "walk");
  EXPECT_EQ(name->tracksys, "omc");
  EXPECT_EQ(name->file("channels.tsv"), "study/sub-01/motion/sub-01_task-walk_tracksys-omc_channels.tsv");
  const auto full =
      parse_motion_name("/d/sub-A1/ses-b/motion/sub-A1_ses-b_task-t_tracksys-imu_acq-x_run-02_motion.tsv");
  ASSERT_TRUE(full) << full.error().message;
  EXPECT_EQ(full->top, "/d");
  EXPECT_EQ(parse_motion_name("sub-01/motion/sub-01_task-w_tracksys-o_motion.tsv").value().top, "");
}

TEST(MotionName, AnyOtherPathIsAUsageErrorThatSaysThePattern) {
  const std::pair<const char*, const char*> cases[] = {
      {"walk.tsv", "does not end in _motion.tsv"},
      {"sub-01/motion/walk_motion.tsv", "not as BIDS has it"},
      {"sub-01/motion/sub-01_tracksys-omc_motion.tsv", "not as BIDS has it"},
      {"sub-01/motion/sub-01_task-walk_motion.tsv", "not as BIDS has it"},
      {"sub-01/motion/sub-01_tracksys-omc_task-walk_motion.tsv", "not as BIDS has it"},
      {"sub-01/motion/sub-01_task-w-x_tracksys-omc_motion.tsv", "not as BIDS has it"},
      {"sub-01/motion/sub-01_task-w_tracksys-omc_run-a_motion.tsv", "not as BIDS has it"},
      {"sub-01/motion/sub-01_task-w_tracksys-omc_rec-a_motion.tsv", "not as BIDS has it"},
      {"sub-01/sub-01_task-walk_tracksys-omc_motion.tsv", "no folder motion"},
      {"sub-02/motion/sub-01_task-walk_tracksys-omc_motion.tsv", "no folder sub-01"},
      {"sub-01/motion/sub-01_ses-1_task-walk_tracksys-omc_motion.tsv", "no folder ses-1"},
      {"sub-01_task-walk_tracksys-omc_motion.tsv", "no folder motion"},
  };
  for (const auto& [path, words] : cases) {
    const auto name = parse_motion_name(path);
    ASSERT_FALSE(name) << path;
    EXPECT_EQ(name.error().code, Code::usage) << path;
    EXPECT_THAT(name.error().message, HasSubstr(words)) << path;
    EXPECT_THAT(name.error().message, HasSubstr("sub-LABEL[_ses-LABEL]_task-LABEL_tracksys-LABEL"));
  }
}

TEST(MotionName, SidecarsAreInheritedFromAbove) {
  const testing_support::ScratchFolder scratch;
  const auto top = scratch.path() / "study", motion = top / "sub-01" / "motion";
  std::filesystem::create_directories(motion);
  const auto path = motion / "sub-01_task-walk_tracksys-omc_run-1_motion.tsv";
  EXPECT_FALSE(find_sidecar(path, "motion.json"));
  ASSERT_TRUE(write_text(scratch.path() / "task-walk_motion.json", "{}", false));
  EXPECT_FALSE(find_sidecar(path, "motion.json")) << "above the data set";
  ASSERT_TRUE(write_text(top / "motion.json", "{}", false));
  EXPECT_EQ(find_sidecar(path, "motion.json"), top / "motion.json");
  ASSERT_TRUE(write_text(top / "task-run_motion.json", "{}", false));
  EXPECT_EQ(find_sidecar(path, "motion.json"), top / "motion.json");
  ASSERT_TRUE(write_text(top / "task-walk_tracksys-omc_motion.json", "{}", false));
  EXPECT_EQ(find_sidecar(path, "motion.json"), top / "task-walk_tracksys-omc_motion.json");
  ASSERT_TRUE(write_text(motion / "sub-01_task-walk_motion.json", "{}", false));
  EXPECT_EQ(find_sidecar(path, "motion.json"), motion / "sub-01_task-walk_motion.json");
  ASSERT_TRUE(write_text(motion / "sub-01_task-walk_tracksys-omc_run-1_motion.json", "{}", false));
  EXPECT_EQ(find_sidecar(path, "motion.json"), motion / "sub-01_task-walk_tracksys-omc_run-1_motion.json");
}

TEST(MotionName, AFileOutsideADataSetHasTheSidecarsBesideIt) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a_motion.json", "{}", false));
  EXPECT_EQ(find_sidecar(scratch / "a_motion.tsv", "motion.json"), scratch / "a_motion.json");
  EXPECT_FALSE(find_sidecar(scratch / "b_motion.tsv", "motion.json"));
  EXPECT_FALSE(find_sidecar(scratch / "a.tsv", "motion.json"));
}

}  // namespace
}  // namespace kinemark::io

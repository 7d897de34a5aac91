// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/session/trial_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

TEST(NextTrial, CountsTheNumberAtTheEnd) {
  EXPECT_EQ(next_trial("01"), "02");
  EXPECT_EQ(next_trial("reach_09"), "reach_10");
  EXPECT_EQ(next_trial("99"), "100");
  EXPECT_EQ(next_trial("walk"), "walk_02");
}

TEST(FreeTrial, IsTheFirstOfWhichThereIsNoFile) {
  const testing_support::ScratchFolder scratch;
  EXPECT_EQ(free_trial(scratch.path(), "walk"), "walk");
  for (const char* name : {"walk.mcap", "walk_02.mcap"})
    ASSERT_TRUE(io::write_text(scratch / name, "", false));
  EXPECT_EQ(free_trial(scratch.path(), "walk"), "walk_03");
  std::filesystem::create_symlink("nowhere", scratch / "walk_03.mcap");
  EXPECT_EQ(free_trial(scratch.path(), "walk"), "walk_04") << "a link that leads nowhere is there too";
}

TEST(TrialName, CanBeAFilesName) {
  for (const char* name : {"01", "reach left (2)", "Größe", "a.b"})
    EXPECT_TRUE(check_trial_name(name)) << name;
  for (const std::string& name : {std::string(".hidden"), std::string("a/b"), std::string("a\\b"),
                                  std::string("a\nb"), std::string(201, 'x'), std::string("\xff\xfe")}) {
    const auto refused = check_trial_name(name);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message, HasSubstr("cannot name a file"));
  }
  EXPECT_THAT(check_trial_name("").error().message, HasSubstr("a name is missing"));
}

}  // namespace
}  // namespace kinemark::pipeline

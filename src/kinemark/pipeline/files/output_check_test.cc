// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/output_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(CheckApart, AnOutputIsNoInputUnderAnyName) {
  const testing_support::ScratchFolder scratch;
  const fs::path input = scratch / "in";
  ASSERT_TRUE(io::write_text(input, "x", false));
  fs::create_symlink("in", scratch / "link");
  fs::create_hard_link(input, scratch / "second");
  fs::create_directory(scratch / "folder");
  for (const char* name : {"in", "link", "second", "folder/../in"}) {
    const auto refused = check_apart({scratch / "other", scratch / name}, {scratch / "absent", input});
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message,
                HasSubstr((scratch / name).string() + ": is the file that is read as"));
  }
  EXPECT_TRUE(check_apart({scratch / "out", ""}, {input, "", scratch / "absent"}));
}

TEST(CheckBelow, ASetupWritesInItsOwnFolderAndBelow) {
  const testing_support::ScratchFolder scratch;
  fs::create_directories(scratch / "setups/sub");
  fs::create_directories(scratch / "elsewhere");
  fs::create_directory_symlink("../elsewhere", scratch / "setups/leads_out");
  fs::create_symlink("../elsewhere/q.mot", scratch / "setups/dangling.mot");
  const fs::path setup = scratch / "setups/setup.xml";
  for (const char* good : {"q.mot", "sub/q.mot", "new/deeper/q.mot", "sub/../q.mot"})
    EXPECT_TRUE(check_below(setup, scratch / "setups" / good, "output_motion_file")) << good;
  for (const char* bad :
       {"../q.mot", "/tmp/q.mot", "leads_out/q.mot", "dangling.mot", "sub/../../q.mot", "../setups2/q"}) {
    const auto refused = check_below(setup, scratch / "setups" / bad, "output_motion_file");
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message, HasSubstr("outside the setup's own folder; give --output"));
  }
}

}  // namespace
}  // namespace kinemark::pipeline

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_model.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;

class TrialModel : public ::testing::Test {
 protected:
  void put(const std::string& name) const { ASSERT_TRUE(io::write_text(scratch_ / name, "x", false)); }
  [[nodiscard]] Result<std::filesystem::path> find(const std::filesystem::path& given = {}) const {
    return find_model(scratch_ / "walk.c3d", given);
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(TrialModel, IsTheOneThatWasGivenWhateverLiesThere) {
  put("walk.osim");
  EXPECT_EQ(find("/elsewhere/a.osim").value(), "/elsewhere/a.osim");
}

TEST_F(TrialModel, IsTheOnlyOneBesideTheRecording) {
  put("walk.c3d");
  put("Subject.OSIM");
  EXPECT_EQ(find().value(), scratch_ / "Subject.OSIM");
}

TEST_F(TrialModel, IsTheOneOfItsNameAmongSeveral) {
  put("run.osim");
  put("walk.osim");
  EXPECT_EQ(find().value(), scratch_ / "walk.osim");
}

TEST_F(TrialModel, NoneAndSeveralAreSaidWithTheWayOut) {
  EXPECT_EQ(find().error().code, Code::not_supported);
  EXPECT_THAT(find().error().message, HasSubstr("No body model is known for walk.c3d: start 'kinemark serve' "
                                                "with --model FILE.osim"));
  put("a.osim");
  put("b.osim");
  EXPECT_THAT(find().error().message, HasSubstr("2 body models lie beside walk.c3d"));
  std::filesystem::create_directory(scratch_ / "empty");
  EXPECT_FALSE(find_model(scratch_ / "empty/walk.c3d", {}));
  EXPECT_FALSE(find_model(scratch_ / "absent/walk.c3d", {}));
}

TEST_F(TrialModel, AFolderOfThatNameIsNoModel) {
  std::filesystem::create_directory(scratch_ / "walk.osim");
  EXPECT_FALSE(find());
}

}  // namespace
}  // namespace kinemark::server

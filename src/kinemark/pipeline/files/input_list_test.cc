// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/input_list.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Paths = std::vector<std::filesystem::path>;

class ListInputs : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "inner.trc");  // a folder, whatever it is called
    for (const char* name : {"b.trc", "a.C3D", "c.mot", "notes.txt", ".hidden.trc", "inner.trc/d.trc"})
      ASSERT_TRUE(io::write_text(folder_ / name, "x", false));
  }
  testing_support::ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_ / "trials";
};

TEST_F(ListInputs, AFolderGivesItsFilesByNameAndSaysWhatItPassedOver) {
  const auto list = list_inputs({folder_}, known_endings()).value();
  EXPECT_EQ(list.files, (Paths{folder_ / "a.C3D", folder_ / "b.trc", folder_ / "c.mot"}));
  EXPECT_THAT(list.notes, ElementsAre(folder_.string() + ": 1 file with another ending passed over"));
  const auto markers = list_inputs({folder_}, marker_endings()).value();
  EXPECT_EQ(markers.files, (Paths{folder_ / "a.C3D", folder_ / "b.trc"}));
  EXPECT_THAT(markers.notes, ElementsAre(folder_.string() + ": 2 files with another ending passed over"));
}

TEST_F(ListInputs, FilesStayAsGivenAndInTheirOrder) {
  const Paths given{"z.c3d", folder_, "absent.txt", "a.c3d"};
  const auto list = list_inputs(given, marker_endings()).value();
  EXPECT_EQ(list.files, (Paths{"z.c3d", folder_ / "a.C3D", folder_ / "b.trc", "absent.txt", "a.c3d"}));
  EXPECT_THAT(list_inputs({}, known_endings()).value().files, IsEmpty());
}

TEST_F(ListInputs, AFolderWithNothingToReadIsRefused) {
  const auto list = list_inputs({folder_ / "inner.trc", scratch_.path()}, known_endings());
  ASSERT_FALSE(list);
  EXPECT_EQ(list.error().code, Code::bad_input);
  EXPECT_THAT(list.error().message, HasSubstr(scratch_.path().string() + ": the folder holds no file"));
  EXPECT_THAT(list.error().message, HasSubstr(".c3d, .trc"));
}

}  // namespace
}  // namespace kinemark::pipeline

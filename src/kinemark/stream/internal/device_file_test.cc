// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/internal/device_file.h"

#include <gmock/gmock.h>

#include <cerrno>
#include <fstream>

#include "support/scratch.h"

namespace kinemark::stream {
namespace {

using ::testing::HasSubstr;

TEST(DeviceFile, NamesTheGroupThatMayOpenIt) {
  EXPECT_THAT(cannot_open("/dev/null", EACCES), HasSubstr("of the group root: sudo usermod -aG root $USER"));
  EXPECT_THAT(cannot_open("/dev/null", EIO), HasSubstr("cannot be opened: "));
  EXPECT_THAT(cannot_open("/dev/null", ENXIO), HasSubstr("is it plugged in?"));
}

TEST(DeviceFile, IsHeldByWhoHasItOpen) {
  const testing_support::ScratchFolder scratch;
  const std::string path = (scratch / "file").string();
  std::ofstream open(path);
  EXPECT_EQ(who_has(path), "this program itself");
  EXPECT_THAT(cannot_open(path, EBUSY), HasSubstr(path + ": this program itself has it; end that first"));
  open.close();
  EXPECT_EQ(who_has(path), "another program");
}

}  // namespace
}  // namespace kinemark::stream

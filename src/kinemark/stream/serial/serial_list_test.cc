// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "kinemark/stream/serial/serial_device.h"
#include "kinemark/stream/serial/serial_port.h"
#include "kinemark/stream/serial/testing/pty_rig.h"
#include "support/scratch.h"

namespace kinemark::stream {
namespace {

using ::testing::HasSubstr;

TEST(ListSerial, NamesEachLineOnceByItsLastingName) {
  const testing_support::ScratchFolder scratch;
  const std::filesystem::path devices = scratch / "dev";
  std::filesystem::create_directories(devices / "serial/by-id");
  for (const auto* name : {"ttyACM0", "ttyUSB1", "ttyS0", "null"}) std::ofstream(devices / name) << "";
  std::filesystem::create_symlink("../../ttyACM0", devices / "serial/by-id/usb-Arduino_Nano-if00");
  const auto found = list_serial(devices);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].uri, "serial:" + (devices / "serial/by-id/usb-Arduino_Nano-if00").string());
  EXPECT_EQ(found[0].name, "usb-Arduino_Nano-if00");
  EXPECT_EQ(found[0].state, "");
  EXPECT_EQ(found[1].name, "ttyUSB1");
}

TEST(ListSerial, SaysWhoHasALine) {
  const testing_support::ScratchFolder scratch;
  testing::PtyRig rig(scratch / "ttyUSB0");
  const auto port = SerialPort::open(rig.path());
  ASSERT_TRUE(port);
  const auto found = list_serial(scratch / "");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].state, HasSubstr("this program itself has it"));
}

TEST(ListSerial, IsEmptyWithoutLinesOrFolder) {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(list_serial(scratch / "").empty());
  EXPECT_TRUE(list_serial(scratch / "none").empty());
}

}  // namespace
}  // namespace kinemark::stream

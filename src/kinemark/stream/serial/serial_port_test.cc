// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/serial_port.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "kinemark/stream/serial/serial_device.h"
#include "kinemark/stream/serial/testing/pty_rig.h"
#include "support/scratch.h"

namespace kinemark::stream {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

std::string refusal(const std::string& path) {
  const auto port = SerialPort::open(path);
  return port ? "opened" : port.error().message;
}

std::size_t open_handles() {
  std::size_t out = 0;
  for ([[maybe_unused]] const auto& one : std::filesystem::directory_iterator("/proc/self/fd")) ++out;
  return out;
}

TEST(SerialPort, SaysWhatIsNoLine) {
  const testing_support::ScratchFolder scratch;
  EXPECT_THAT(refusal((scratch / "none").string()), HasSubstr("no such device; is it plugged in?"));
  std::ofstream(scratch / "file") << "x";
  EXPECT_THAT(refusal((scratch / "file").string()), HasSubstr("is no serial line"));
}

TEST(SerialPort, CarriesBytesBothWaysAsTheyAre) {
  const testing_support::ScratchFolder scratch;
  testing::PtyRig rig(scratch / "line");
  auto port = SerialPort::open(rig.path()).value();
  testing::Bytes all(256);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
  rig.send(all);
  testing::Bytes come;
  std::array<std::uint8_t, 64> some{};
  while (come.size() < all.size()) {
    const auto got = port.read(some, milliseconds(5000));
    ASSERT_TRUE(got && *got > 0);
    come.insert(come.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  EXPECT_EQ(come, all);
  EXPECT_EQ(port.read(some, milliseconds(0)), 0U);
  ASSERT_TRUE(port.write("out 1 1\n"));
  rig.wait_for("out 1 1");
}

TEST(SerialPort, TellsASecondOpeningWhoHasIt) {
  const testing_support::ScratchFolder scratch;
  testing::PtyRig rig(scratch / "line");
  const auto first = SerialPort::open(rig.path());
  ASSERT_TRUE(first);
  EXPECT_THAT(refusal(rig.path()), HasSubstr("this program itself has it; end that first"));
}

TEST(SerialPort, TellsASecondProgramWhoHasIt) {
  const testing_support::ScratchFolder scratch;
  testing::PtyRig rig(scratch / "line");
  std::array<int, 2> ready{}, done{};
  ASSERT_EQ(pipe(ready.data()) | pipe(done.data()), 0);
  const std::string path = rig.path();
  const pid_t other = fork();
  if (other == 0) {
    close(done[1]);
    const auto port = SerialPort::open(path);
    char byte = port ? 'y' : 'n';
    (void)!write(ready[1], &byte, 1);
    (void)!read(done[0], &byte, 1);
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_EQ(byte, 'y');
  EXPECT_THAT(refusal(path), HasSubstr("(process " + std::to_string(other) + ") has it"));
  for (const int fd : {ready[0], ready[1], done[0], done[1]}) close(fd);
  waitpid(other, nullptr, 0);
  EXPECT_EQ(refusal(path), "opened");
}

/// A terminal that somebody else has open and that is no rig.
class Terminal {
 public:
  Terminal() {
    rig_.facts = "";
    termios line = now();
    line.c_lflag |= ICANON | ECHO;
    line.c_cflag |= HUPCL;
    cfsetspeed(&line, B9600);
    tcsetattr(fd_, TCSANOW, &line);
  }
  ~Terminal() { close(fd_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  [[nodiscard]] termios now() const {
    termios line{};
    EXPECT_EQ(tcgetattr(fd_, &line), 0);
    return line;
  }
  [[nodiscard]] bool is_exclusive() const {
    int out = 0;
    EXPECT_EQ(ioctl(fd_, TIOCGEXCL, &out), 0);
    return out != 0;
  }
  [[nodiscard]] std::string path() const { return rig_.path(); }

 private:
  testing_support::ScratchFolder scratch_;
  testing::PtyRig rig_{scratch_ / "line"};
  int fd_ = open(rig_.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
};

bool same(const termios& a, const termios& b) {
  return a.c_iflag == b.c_iflag && a.c_oflag == b.c_oflag && a.c_cflag == b.c_cflag &&
         a.c_lflag == b.c_lflag && std::equal(a.c_cc, a.c_cc + NCCS, b.c_cc) &&
         cfgetospeed(&a) == cfgetospeed(&b);
}

TEST(SerialPort, LeavesALineAsItWasFound) {
  const Terminal terminal;
  const auto before = terminal.now();
  {
    auto port = SerialPort::open(terminal.path()).value();
    const SerialPort moved = std::move(port);
    EXPECT_FALSE(same(terminal.now(), before));
    EXPECT_TRUE(terminal.is_exclusive());
  }
  EXPECT_TRUE(same(terminal.now(), before));
  EXPECT_FALSE(terminal.is_exclusive());
}

TEST(SerialPort, LeavesATerminalAsItWasWhereNoRigAnswers) {
  const Terminal terminal;
  const auto before = terminal.now();
  EXPECT_FALSE(open_serial(terminal.path()));
  EXPECT_TRUE(same(terminal.now(), before));
  EXPECT_FALSE(terminal.is_exclusive());
}

TEST(SerialPort, ASecondOpeningChangesNothingForTheFirst) {
  const Terminal terminal;
  const auto first = SerialPort::open(terminal.path()).value();
  const auto set = terminal.now();
  EXPECT_NE(refusal(terminal.path()), "opened");
  EXPECT_TRUE(same(terminal.now(), set));
  EXPECT_TRUE(terminal.is_exclusive());
}

TEST(SerialPort, KeepsTheSettingOfALineThatHasARig) {
  const Terminal terminal;
  termios set{};
  {
    auto port = SerialPort::open(terminal.path()).value();
    port.keep_setting();
    set = terminal.now();
  }
  EXPECT_TRUE(same(terminal.now(), set));
  EXPECT_FALSE(terminal.is_exclusive());
}

TEST(SerialPort, SaysThatThePlugWasPulled) {
  const testing_support::ScratchFolder scratch;
  testing::PtyRig rig(scratch / "line");
  auto port = SerialPort::open(rig.path()).value();
  rig.unplug();
  std::array<std::uint8_t, 8> some{};
  const auto got = port.read(some, milliseconds(5000));
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, Code::device);
  EXPECT_THAT(got.error().message, HasSubstr("the rig is gone; plug it in again"));
  EXPECT_FALSE(port.write("?\n"));
}

TEST(SerialPort, LeavesNoHandleAfterAThousandOpenings) {
  const testing_support::ScratchFolder scratch;
  testing::PtyRig rig(scratch / "line");
  const auto before = open_handles();
  for (int i = 0; i < 1000; ++i) {
    auto port = SerialPort::open(rig.path());
    ASSERT_TRUE(port) << i << ": " << port.error().message;
    const SerialPort moved = std::move(*port);
  }
  for (int i = 0; i < 1000; ++i) ASSERT_NE(refusal((scratch / "none").string()), "opened");
  EXPECT_EQ(open_handles(), before);
}

}  // namespace
}  // namespace kinemark::stream

// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A board of a few lines stands in for libcomedi: its functions are defined here, and go before the
// library's.
#include <comedilib.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "kinemark/stream/comedi/comedi_device.h"

namespace {

/// What the board gives from one command to the next, after which it stops by itself.
struct FakeBoard {
  int fd = -1, commands = 0;
  std::function<int(int)> frames_of = [](int) { return 0; };  ///< of the nth command, from 0
  comedi_range range{.min = -10.0, .max = 10.0, .unit = UNIT_volt};

  void give(int frames) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC), 0);
    const std::vector<sampl_t> samples(static_cast<std::size_t>(frames) * 4, 100);
    const auto bytes = samples.size() * sizeof(sampl_t);
    ASSERT_EQ(write(ends[1], samples.data(), bytes), static_cast<ssize_t>(bytes));
    close(ends[1]);
    dup2(ends[0], fd);
    close(ends[0]);
  }
};

FakeBoard* board = nullptr;

}  // namespace

extern "C" {
comedi_t* comedi_open(const char* /*path*/) {
  std::array<int, 2> ends{};  // any handle of its own, until the first command
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return nullptr;
  close(ends[1]);
  board->fd = ends[0];
  return reinterpret_cast<comedi_t*>(board);
}
int comedi_close(comedi_t* /*board*/) { return close(board->fd); }
int comedi_loglevel(int /*level*/) { return 0; }
int comedi_fileno(comedi_t* /*board*/) { return board->fd; }
const char* comedi_get_driver_name(comedi_t* /*board*/) { return "fake"; }
const char* comedi_get_board_name(comedi_t* /*board*/) { return "board"; }
int comedi_get_read_subdevice(comedi_t* /*board*/) { return 0; }
int comedi_get_subdevice_type(comedi_t* /*board*/, unsigned /*part*/) { return COMEDI_SUBD_AI; }
int comedi_find_subdevice_by_type(comedi_t* /*board*/, int /*type*/, unsigned /*from*/) { return -1; }
int comedi_get_subdevice_flags(comedi_t* /*board*/, unsigned /*part*/) { return 0; }
int comedi_get_n_channels(comedi_t* /*board*/, unsigned /*part*/) { return 4; }
lsampl_t comedi_get_maxdata(comedi_t* /*board*/, unsigned /*part*/, unsigned /*channel*/) { return 4095; }
int comedi_get_n_ranges(comedi_t* /*board*/, unsigned /*part*/, unsigned /*channel*/) { return 1; }
comedi_range* comedi_get_range(comedi_t* /*board*/, unsigned /*part*/, unsigned /*channel*/,
                               unsigned /*range*/) {
  return &board->range;
}
int comedi_get_max_buffer_size(comedi_t* /*board*/, unsigned /*part*/) { return 0; }
int comedi_cancel(comedi_t* /*board*/, unsigned /*part*/) { return 0; }
int comedi_command_test(comedi_t* /*board*/, comedi_cmd* command) {
  command->convert_arg = command->convert_arg < 1000 ? 1000 : command->convert_arg;
  return 0;
}
int comedi_command(comedi_t* /*board*/, comedi_cmd* /*command*/) {
  board->give(board->frames_of(board->commands++));
  return 0;
}
}

namespace kinemark::stream {
namespace {

using std::chrono::milliseconds;

constexpr double kRate_hz = 1000.0;

class ComediBoard : public ::testing::Test {
 protected:
  ComediBoard() { board = &fake_; }
  std::unique_ptr<Device> running() {
    auto device = open_comedi("fake").value();
    EXPECT_TRUE(device->configure({.leds = {"hand"}, .cameras = {"A"}, .rate_hz = kRate_hz}));
    EXPECT_TRUE(device->start());
    return device;
  }
  FakeBoard fake_;
  Block block_;
};

TEST_F(ComediBoard, ThatStopsAtOnceEachTimeHoldsNobody) {
  auto device = running();
  EXPECT_EQ(device->read(block_, milliseconds(20)), ReadResult::timeout);
  EXPECT_GT(fake_.commands, 1);
  EXPECT_EQ(device->read(block_, milliseconds(0)), ReadResult::timeout);
}

TEST_F(ComediBoard, NumbersOnByTheHostsClockFromTheLastFrameAndSaysSo) {
  fake_.frames_of = [](int command) { return command == 0 ? 2000 : 5; };  // 2 s by its clock, at once
  auto device = running();
  ASSERT_EQ(device->read(block_, milliseconds(1000)), ReadResult::block);
  EXPECT_EQ(block_.first_frame, 0);
  EXPECT_EQ(block_.frames, 2000);
  EXPECT_FALSE(block_.renumbered || block_.gap || block_.overflow);
  for (std::int64_t next = 2000; next < 2100; next = block_.first_frame + block_.frames) {
    const auto last_ns = block_.host_after_ns;
    ASSERT_EQ(device->read(block_, milliseconds(1000)), ReadResult::block);
    EXPECT_TRUE(block_.renumbered && block_.gap && block_.overflow);
    EXPECT_EQ(block_.frames, 5);
    EXPECT_GE(block_.first_frame, next + 1);
    EXPECT_LE(block_.first_frame,
              next + 1 + std::llround(1e-9 * kRate_hz * static_cast<double>(block_.host_after_ns - last_ns)));
  }
}

TEST_F(ComediBoard, StartsAgainWithFrameZero) {
  fake_.frames_of = [](int) { return 3; };
  auto device = running();
  for (int again = 0; again < 2; ++again) {
    ASSERT_EQ(device->read(block_, milliseconds(1000)), ReadResult::block);
    EXPECT_EQ(block_.first_frame, 0);
    EXPECT_FALSE(block_.renumbered);
    ASSERT_EQ(device->read(block_, milliseconds(1000)), ReadResult::block);
    EXPECT_TRUE(block_.renumbered);
    ASSERT_TRUE(device->stop());
    ASSERT_TRUE(device->start());
  }
}

}  // namespace
}  // namespace kinemark::stream
